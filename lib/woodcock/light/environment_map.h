// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "woodcock/base/spectrum.h"
#include "woodcock/base/vec.h"

namespace woodcock::light {

/// A lat-long image of radiance, interpolated bilinearly, and sampled in proportion to brightness.
/// In light space +y is up, the centre of the image looks along -z and +x lies to its right.
class EnvironmentMap {
public:
    EnvironmentMap() = default;
    /// `pixels`: width x height x RGB, top row first, finite and >= 0.
    EnvironmentMap(int width, int height, std::vector<float> pixels);

    bool empty() const { return width_ == 0; }
    Rgb radiance(Vec3d direction) const;
    Rgb meanRadiance() const { return mean_; }  ///< over the sphere

    struct Sample {
        Vec3d direction;
        double pdf;  ///< per steradian; 0: the image is black
    };
    Sample sample(double u0, double u1) const;
    double pdf(Vec3d direction) const;

    struct Sun;
    /// Takes a sun out of the image: what exceeds ten times the image's mean within two degrees of
    /// the brightest pixel, where that is a twentieth of all light or more. Both images together
    /// show what this one did. Nothing: there is no such place.
    std::optional<Sun> takeSun();

private:
    /// Of a whole image of such a size, the part `window`. Elsewhere it is black.
    struct Window {
        int x = 0, y = 0, width = 0, height = 0;
    };
    EnvironmentMap(int width, int height, const Window& window, std::vector<float> pixels);

    void tabulate();
    float* find(int x, int y);
    Rgb pixel(int x, int y) const;
    Vec3d direction(double x, double y) const;

    int width_ = 0, height_ = 0;
    Window window_;
    std::vector<float> pixels_;  // of the window
    // Of what is sampled, the window and a pixel around it: height + 1; height x (width + 1).
    Window sampled_;
    std::vector<double> rowCdf_, columnCdf_;
    Rgb mean_;
};

struct EnvironmentMap::Sun {
    EnvironmentMap map;
    Vec3d direction;  ///< of its middle
};

}  // namespace woodcock::light
