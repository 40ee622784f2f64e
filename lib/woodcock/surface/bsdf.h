// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "woodcock/base/vec.h"
#include "woodcock/surface/facet_energy.h"
#include "woodcock/surface/material.h"

namespace woodcock::surface {

/// A point of a surface, as its material needs it.
struct BsdfPoint {
    Vec3d normal;         ///< the surface's own, unit, outwards
    Vec3d shadingNormal;  ///< unit, on the same side
    double u = 0, v = 0;
    /// Indices of refraction on the side that the normal points to, and on the other. The inner one
    /// need not be the material's own: priorities of nested surfaces decide.
    double iorOutside = 1, iorInside = 1;
};

struct BsdfSample {
    Vec3d direction;     ///< unit, away from the point
    Rgb weight;          ///< f |cos| / pdf, of radiance; zero: absorbed
    double pdf = 0;      ///< per steradian; 0 with `delta`
    bool delta = false;  ///< no other sampling can find this direction
    bool transmitted = false;
};

struct BsdfValue {
    Rgb value;       ///< f |cos(in)|
    double pdf = 0;  ///< of sample() drawing `in`, per steradian
};

/// The scattering at one point of a surface, for paths that come from the camera: crossing into
/// another index of refraction scales radiance by (n_from / n_to)^2 (Veach 1997, eq. 5.16).
/// On rough surfaces, light that meets more than one facet is not lost: it leaves by the model of
/// Kulla and Conty (see FacetEnergy), so that white metal and glass absorb nothing. Single
/// scattering alone would lose, of light along the normal at roughness 0.3, 0.5, 0.7 and 1: 1, 9,
/// 31 and 70 % on white metal; 0.1, 0.8, 3 and 11 % entering glass of index 1.5; 1, 7, 24 and 59 %
/// leaving it. How this light is spread over directions is a model. Metals tint it by their mean
/// Fresnel reflectance.
class Bsdf {
public:
    /// The scattering of `materials[index]` at a point. A dielectric between equal indices, and an
    /// interface, let light pass unchanged. A mix within a mix is black.
    Bsdf(std::span<const Material> materials, std::uint32_t index, const BsdfPoint& point);

    /// True where all light passes unchanged.
    bool passes() const;
    /// True where a part is not delta, so that next-event estimation can light it.
    bool smooth() const;
    /// True where a part is a dielectric or lets light pass, so that transparent shadows (a biased
    /// choice) may let shadow rays through.
    bool transmits() const;

    /// Draws a direction. `out`: unit, towards where the path came from; u: three numbers in [0,
    /// 1).
    BsdfSample sample(Vec3d out, std::array<double, 3> u) const;
    /// f |cos(in)| and its density, of all parts that are not delta. `out`, `in`: unit, away from
    /// the point.
    BsdfValue scatter(Vec3d out, Vec3d in) const;
    Rgb evaluate(Vec3d out, Vec3d in) const { return scatter(out, in).value; }
    double pdf(Vec3d out, Vec3d in) const { return scatter(out, in).pdf; }

    /// Radiance that the point emits towards `out`.
    Rgb emitted(Vec3d out) const;
    /// Share of light that goes straight on through the dielectric, for transparent shadows (a
    /// biased choice): the smooth Fresnel transmittance of a ray in this direction on the side of
    /// the lower index. So a plate transmits as much as with the true, refracted rays.
    Rgb straightTransmittance(Vec3d direction) const;
    /// Reflectance for the albedo layer: the diffuse colour, a metal's colour at normal incidence,
    /// 1 for what transmits.
    Rgb albedo() const;

    /// Below this roughness a surface is taken as smooth.
    static constexpr double leastRoughness = 0.02;

private:
    /// Up to two lobes of different kinds, with weights that sum to at most one.
    struct Lobe {
        enum class Kind { Diffuse, Conductor, Dielectric, Pass, Emissive } kind = Kind::Pass;
        double weight = 1;
        Rgb colour{1.0f}, eta, k;  ///< reflectance, or radiance
        bool schlick = false, bothSides = false;
        double alpha = 0;                     ///< of GGX; 0: smooth
        const FacetEnergy* energy = nullptr;  ///< of what is rough
        Rgb again{1.0f};                      ///< colour of what metal scatters more than once

        bool scatters() const { return kind != Kind::Emissive; }
        bool delta() const {
            return kind == Kind::Pass ||
                   ((kind == Kind::Conductor || kind == Kind::Dielectric) && alpha == 0);
        }
    };
    struct View;
    struct Density;

    void add(const Material& material, double weight);
    std::span<const Lobe> lobes() const {
        return {lobes_.data(), static_cast<std::size_t>(count_)};
    }
    View viewFrom(Vec3d out) const;
    static Rgb fresnel(const Lobe& lobe, double cosine, double ior);
    Density density(const View& view, Vec3d in) const;  ///< of all lobes that are not delta
    /// A lobe that scatters, drawn by weight. `u` is rescaled to [0, 1) for further use.
    const Lobe& choose(double& u) const;
    static BsdfSample sampleFacet(const Lobe& lobe, const View& view, std::array<double, 3> u);
    /// Draws a direction of light that meets more than one facet.
    static BsdfSample sampleAgain(const Lobe& lobe, const View& view, std::array<double, 3> u);
    static Density again(const Lobe& lobe, const View& view, Vec3d in);
    static Rgb meanFresnel(const Lobe& lobe, double ior);
    static Density density(const Lobe& lobe, const View& view, Vec3d in);
    static Density diffuse(const Lobe& lobe, const View& view, Vec3d in);
    static Density conductor(const Lobe& lobe, const View& view, Vec3d in);
    static Density dielectric(const Lobe& lobe, const View& view, Vec3d in);

    std::array<Lobe, 2> lobes_;
    int count_ = 0;
    double scattering_ = 0;  ///< sum of the weights of lobes that scatter
    BsdfPoint point_;
};

}  // namespace woodcock::surface
