// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "woodcock/base/vec.h"
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

/// The scattering of one point of a surface: for paths that come from the camera, so that crossing
/// into another index of refraction scales radiance by (n_from / n_to)^2 (Veach 1997, eq. 5.16).
class Bsdf {
public:
    /// What `materials[index]` does at a point. A dielectric between equal indices, and an
    /// interface, let light pass unchanged.
    Bsdf(std::span<const Material> materials, std::uint32_t index, const BsdfPoint& point);

    /// Nothing but light passing unchanged.
    bool passes() const;
    /// Has a part that next-event estimation can light: anything that is not delta.
    bool smooth() const;
    /// Some of it is a dielectric: shadow rays may be let through by a biased choice.
    bool transmits() const;

    /// `out`: towards where the path came from; u: three numbers in [0, 1).
    BsdfSample sample(Vec3d out, std::array<double, 3> u) const;
    /// f |cos(in)| of all parts that are not delta, and the density with which sample() draws `in`
    /// by them, per steradian.
    Rgb evaluate(Vec3d out, Vec3d in) const;
    double pdf(Vec3d out, Vec3d in) const;

    /// Radiance that the point sends out by itself.
    Rgb emitted(Vec3d out) const;
    /// Share of light that goes straight on through the dielectric for the biased choice of
    /// transparent shadows: the smooth Fresnel transmittance of a ray in this direction.
    Rgb straightTransmittance(Vec3d direction) const;
    /// Reflectance for layers: the diffuse colour, a metal's colour, one for glass.
    Rgb albedo() const;

private:
    // Up to two lobes of different kinds, with weights that sum to at most one.
    struct Lobe {
        enum class Kind { Diffuse, Conductor, Dielectric, Pass, Emissive } kind;
        double weight = 1;
        Rgb colour, eta, k;
        bool schlick = false, bothSides = false;
        double alpha = 0;
    };
    std::array<Lobe, 2> lobes_;
    int count_ = 0;
    BsdfPoint point_;
};

}  // namespace woodcock
