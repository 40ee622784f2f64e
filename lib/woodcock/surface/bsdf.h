// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "woodcock/base/vec.h"
#include "woodcock/surface/facet_energy.h"
#include "woodcock/surface/material.h"

namespace woodcock {

/// A surface's point, as its material sees it.
struct BsdfPoint {
    Vec3d normal;         ///< the surface's own, unit, outwards
    Vec3d shadingNormal;  ///< unit, on the same side
    double u = 0, v = 0;
    /// Indices of refraction on the side that the normal points to, and on the other. What is
    /// inside need not be the material's own: priorities decide.
    double iorOutside = 1, iorInside = 1;
};

struct BsdfSample {
    Vec3d direction;     ///< unit, away from the point
    Rgb weight;          ///< f |cos| / pdf, of radiance; zero: absorbed
    double pdf = 0;      ///< per steradian; 0 with `delta`
    bool delta = false;  ///< a direction that no other sampling can find
    bool transmitted = false;
};

struct BsdfValue {
    Rgb value;       ///< f |cos(in)|
    double pdf = 0;  ///< with which sample() draws `in`, per steradian
};

/// The scattering of one point of a surface: for paths that come from the camera, so that crossing
/// into another index of refraction scales radiance by (n_from / n_to)^2 (Veach 1997, eq. 5.16).
/// On what is rough, light that its first facet sends to others is not lost: it leaves as Kulla and
/// Conty have it (see FacetEnergy), so that white metal and glass absorb nothing. One scattering
/// alone would lose, of light along the normal on roughness 0.3, 0.5, 0.7 and 1: of white metal 1,
/// 9, 31 and 70 %, of glass of 1.5 that it enters 0.1, 0.8, 3 and 11 %, that it leaves 1, 7, 24 and
/// 59 %. How that part is spread over directions is a model, no theory; and metals dye it by the
/// mean of their Fresnel reflectance.
class Bsdf {
public:
    /// What `materials[index]` does at a point. A dielectric between equal indices, and an
    /// interface, let light pass unchanged; a mix within a mix is black.
    Bsdf(std::span<const Material> materials, std::uint32_t index, const BsdfPoint& point);

    /// Nothing but light passing unchanged.
    bool passes() const;
    /// Has a part that next-event estimation can light: anything that is not delta.
    bool smooth() const;
    /// Some of it is a dielectric, or lets light pass: shadow rays may be let through by a biased
    /// choice.
    bool transmits() const;

    /// `out`: towards where the path came from; u: three numbers in [0, 1).
    BsdfSample sample(Vec3d out, std::array<double, 3> u) const;
    /// Of all parts that are not delta.
    BsdfValue scatter(Vec3d out, Vec3d in) const;
    Rgb evaluate(Vec3d out, Vec3d in) const { return scatter(out, in).value; }
    double pdf(Vec3d out, Vec3d in) const { return scatter(out, in).pdf; }

    /// Radiance that the point sends out by itself.
    Rgb emitted(Vec3d out) const;
    /// Share of light that goes straight on through the dielectric for the biased choice of
    /// transparent shadows: the smooth Fresnel transmittance, of a ray in this direction on the
    /// side of the lower index. So a plate lets through what it does with the true, bent rays.
    Rgb straightTransmittance(Vec3d direction) const;
    /// Reflectance for layers: the diffuse colour, a metal's colour at normal incidence, one for
    /// what transmits.
    Rgb albedo() const;

    /// Facets below this roughness are taken for a plane.
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
    /// By weight, among lobes that scatter; `u` becomes the rest, in [0, 1) again.
    const Lobe& choose(double& u) const;
    static BsdfSample sampleFacet(const Lobe& lobe, const View& view, std::array<double, 3> u);
    /// What a facet sends to others.
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

}  // namespace woodcock
