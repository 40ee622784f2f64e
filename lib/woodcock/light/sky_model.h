// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "woodcock/base/spectrum.h"
#include "woodcock/base/vec.h"

namespace woodcock::light {

/// The light of a clear sky and its sun, by Hosek and Wilkie: "An Analytic Model for Full Spectral
/// Sky-Dome Radiance" (2012), "Adding a Solar-Radiance Function to the Hosek-Wilkie Skylight Model"
/// (2013).
///
/// Colours are linear Rec.709. Radiances are W / (m^2 sr), and irradiances W / m^2, as the eye
/// weighs them: the integral of the spectrum with the colour matching functions of 1931. 683 lm / W
/// times their luminance, 0.2126 R + 0.7152 G + 0.0722 B, are cd / m^2 and lux.
///
/// In the sky's own space +y is up, and the sun stands towards -z.
class SkyModel {
public:
    struct Conditions {
        double sunElevation = 45;  ///< degrees above the horizon, 0 to 90
        double turbidity = 3;      ///< 1 (air alone) to 10 (dense haze)
        Rgb groundAlbedo{0.2f};    ///< 0 to 1: light from the ground brightens the sky
    };
    static constexpr double lowestTurbidity = 1, highestTurbidity = 10;

    /// Errors: Usage, where a number is out of its range.
    explicit SkyModel(const Conditions& conditions);

    /// Of the sky without the sun's disc; 0 from below the horizon.
    Rgb radiance(Vec3d direction) const;

    Vec3d towardsSun() const { return towardsSun_; }
    /// Of the sun alone, on a surface that faces it.
    Rgb sunIrradiance() const { return sunIrradiance_; }
    /// Of the sky alone, on the level ground.
    Rgb skyIrradiance() const { return skyIrradiance_; }

private:
    /// Of a channel: the names are those of the paper's eq. 8.
    struct Channel {
        double A, B, C, D, E, F, G, I, H, scale;
    };

    std::array<Channel, 3> channels_;
    Vec3d towardsSun_;
    Rgb sunIrradiance_, skyIrradiance_;
};

/// The sky as a lat-long image with an even `ground` below its horizon: `width` x `width` / 2 x
/// RGB, top row first, as EnvironmentMap takes it. The sun, without its disc, stands over the
/// middle. At a width of 1024, bilinear interpolation differs from the model by 0.1 % on average,
/// and by at most 2 %, which is half a degree above the horizon.
std::vector<float> skyImage(const SkyModel& sky, Rgb ground, int width);
inline constexpr int skyImageWidth = 1024;

/// What a level ground sends out that reflects, evenly in all directions, the light of the sky and
/// `sun` times that of the sun.
Rgb groundRadiance(const SkyModel& sky, Rgb albedo, double sun);

}  // namespace woodcock::light
