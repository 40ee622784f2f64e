// SPDX-License-Identifier: Apache-2.0
// Published numbers of the sky model of Hosek and Wilkie; the table's file names their licence.
#pragma once

namespace woodcock::light::hosek_wilkie {

inline constexpr int turbidities = 10;   ///< 1 to 10
inline constexpr int controlPoints = 6;  ///< of a quintic over the cube root of the elevation
inline constexpr int sunKnots = 46;  ///< even in the cube root of the elevation, 0 to 90 degrees

// By channel (linear Rec.709), albedo of the ground (0, 1), turbidity and control point.
extern const float parameters[3][2][turbidities][controlPoints][9];  ///< A B C D E F G I H
extern const float radiances[3][2][turbidities][controlPoints];      ///< W / (m^2 sr)

/// The sun's light on a surface that faces it, W / m^2.
extern const float sunIrradiance[turbidities][sunKnots][3];

}  // namespace woodcock::light::hosek_wilkie
