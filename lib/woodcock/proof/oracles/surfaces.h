// SPDX-License-Identifier: Apache-2.0
// Answers for scenes of surfaces that have a formula.
#pragma once

#include <vector>

#include "woodcock/base/vec.h"

namespace woodcock::oracle {

// ---- Irradiance, at a point of a plane, from a Lambertian surface of radiance 1 ----
// Divided by pi it is a form factor: Howell, A Catalog of Radiation Heat Transfer Configuration
// Factors. What is below the plane's horizon does not count.

/// A plane polygon, both sides shining. Lambert, Photometria (1760); Arvo 1994, eq. 1. The corners
/// run either way.
double polygonIrradiance(const std::vector<Vec3d>& corners, Vec3d point, Vec3d normal);

/// A disk in a parallel plane at distance `height` that is `offset` aside (Howell C-43).
double diskIrradiance(double radius, double height, double offset);

/// A sphere whose centre is at `distance` >= radius and at this cosine, in [-1, 1], from the
/// plane's normal (Howell C-84).
double sphereIrradiance(double radius, double distance, double cosine);

// ---- Enclosures ----

/// Radiance inside a body, of any shape, of clear dielectric of this index in an environment of
/// radiance 1, in directions from which light finds its way out, however late: index squared. What
/// total reflection keeps inside for ever is dark, but anything that scatters in there lights it.
double radianceInDielectric(double index);

/// Radiance everywhere in a closed cavity, of any shape, with walls that emit radiance `emitted`
/// and reflect diffusely with `albedo` < 1.
double cavityRadiance(double emitted, double albedo);

/// Radiance after `reflections` reflections at most: the first terms of the same.
double cavityRadiance(double emitted, double albedo, int reflections);

// ---- Scattering behind a refracting boundary ----

/// Of a beam that meets a half-space of this index at cosine `mu` in (0, 1] (outside): the part of
/// its power that comes back, what the boundary reflects at once included. Henyey-Greenstein
/// scattering, albedo < 1. By adding-doubling, with 1e-7 for |g| up to 0.75; slabs: solveSlab().
double refractiveHalfSpaceReflectance(double index, double albedo, double g, double mu);

}  // namespace woodcock::oracle
