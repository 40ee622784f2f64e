// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/affine.h"
#include "woodcock/light/light_sample.h"
#include "woodcock/light/seen_rectangle.h"
#include "woodcock/light/spread.h"

namespace woodcock::light {

/// What rectangles and disks have in common: a flat shape that emits, and lets other light pass.
struct FlatLight {
    Vec3d centre;
    Vec3d x, y, normal;   ///< unit, perpendicular; it shines to where the normal points
    double halfX, halfY;  ///< half of its size along x and y
    Rgb radiance;         ///< power per area and pi, to each side that shines
    Spread spread = Spread();
    bool twoSided = false;
    bool visible = true;

    /// Of `worldFromLight`: the light lies in y = 0 of its own space around the origin, x and z are
    /// its sides, and it shines towards +y. Scales of the axes scale it; they must be
    /// perpendicular.
    static FlatLight placed(const Affine3d& worldFromLight, double sizeX, double sizeZ);

    LightForm form() const {
        return {halfX, halfY, spread.degrees(), radiance[0], radiance[1], radiance[2]};
    }
    FlatLight withForm(const LightForm& form) const;
};

/// A place in a flat light's own axes.
struct FlatPlace {
    double x, y;
    double height;  ///< above the plane, on the side that shines; NaN where it is dark: behind, in
                    ///< the plane itself, or closer to it than rounding can tell
    double side;    ///< 1 or -1: the side of the normal, or the other one
    bool lit() const { return height > 0; }
};
FlatPlace placeBefore(const FlatLight& light, Vec3d from);

/// The part of the light's bounding rectangle from which, by its spread, light can arrive.
SeenRectangle seenPart(const FlatLight& light, const FlatPlace& from);

/// The sample of the point (x, y) of the light, seen from a place that is lit, drawn with a density
/// per steradian.
LightSample sampleOf(const FlatLight& light, const FlatPlace& from, double x, double y, double pdf);

/// Where a ray from a place that is lit meets the light's plane.
struct FlatHit {
    double x = 0, y = 0;
    double distance = std::numeric_limits<double>::infinity();  ///< infinity: nowhere
    Rgb radiance;                                               ///< if the light is there
};
FlatHit meetPlane(const FlatLight& light, const FlatPlace& from, Vec3d direction);

/// The importance of a light of such area.
double importanceOf(const FlatLight& light, double area, const ScatterPoint& at);

/// Narrows [t0, t1] to the part of the ray on the side that shines.
void narrowTo(const FlatLight& light, Vec3d origin, Vec3d direction, double& t0, double& t1);

}  // namespace woodcock::light
