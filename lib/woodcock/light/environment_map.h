// SPDX-License-Identifier: Apache-2.0
#pragma once

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

private:
    Rgb pixel(int x, int y) const;

    int width_ = 0, height_ = 0;
    std::vector<float> pixels_;
    std::vector<double> rowCdf_, columnCdf_;  // height + 1; height x (width + 1)
    Rgb mean_;
};

}  // namespace woodcock::light
