// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "woodcock/base/spectrum.h"
#include "woodcock/base/vec.h"

namespace woodcock {

/// One camera path's answer.
struct FilmSample {
    Rgb radiance;
    float alpha = 0;  ///< 1 - transmittance along the camera ray
};

/// Depth and transmittance of one camera ray, only where layers ask for them.
struct DepthSample {
    Rgb transmittance;
    float weightedDepth = 0;  ///< sum over absorbed-or-scattered weight x distance, world units
    float weight = 0;
    Vec3f weightedNormal = {};  ///< world space, towards the camera; only where it meets a surface
};

/// Light on a shadow catcher that one camera path met: with what is in the scene, and without.
struct CatcherSample {
    float lit = 0, unlit = 0;  ///< means of the channels
    float weight = 0;          ///< transmittance in front of it
};

/// Sums over samples, per pixel and in double, so that sample ranges merge: the sums of [0,n) and
/// of [n,2n) added give those of [0,2n) to a float's last place.
class Film {
public:
    struct Pixel {
        double radiance[3] = {}, radianceSquared[3] = {};
        double alpha = 0;
        double transmittance[3] = {};
        double weightedDepth = 0, depthWeight = 0;
        std::uint64_t samples = 0;       ///< of radiance and alpha
        std::uint64_t depthSamples = 0;  ///< of transmittance and depth
        std::uint64_t nonFinite = 0;     ///< samples dropped because they were NaN or infinite
    };

    /// What only scenes with surfaces need.
    struct SurfacePixel {
        double weightedNormal[3] = {};
        double catcherLit = 0, catcherUnlit = 0, catcherWeight = 0;
    };

    /// `width` x `height` is the whole image; samples may only fall into the crop
    /// [x0, x1) x [y0, y1), which becomes the EXR's data window.
    struct Window {
        int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
        int width() const { return x1 - x0; }
        int height() const { return y1 - y0; }
        bool operator==(const Window&) const = default;
    };

    /// Throws Error{Usage} on an empty image, and on a crop that is empty or leaves it.
    Film(int width, int height, Window crop, bool withSurfaces = false);

    int width() const { return width_; }
    int height() const { return height_; }
    Window crop() const { return crop_; }

    /// Pixels are image coordinates, y down, inside the crop.
    Pixel& at(int x, int y);
    const Pixel& at(int x, int y) const;

    /// A sample with anything NaN or infinite in it is dropped and counted.
    void add(int x, int y, const FilmSample& sample);
    void add(int x, int y, const DepthSample& sample);
    void add(int x, int y, const CatcherSample& sample);  ///< only withSurfaces
    /// Adds the sums of a film of the same size and crop; throws Error{Usage} on any other.
    void merge(const Film& other);

    /// Means over samples; zero where there is none.
    Rgb radiance(int x, int y) const;
    /// A shadow catcher adds the share of its light that the scene takes away.
    float alpha(int x, int y) const;
    Rgb transmittance(int x, int y) const;
    /// Of the mean radiance, from the samples' variance; infinite, as unknown, below two
    /// samples.
    Rgb standardError(int x, int y) const;
    /// Mean distance to what the camera ray meets, world units; `noDepth` where it meets nothing.
    float depth(int x, int y) const;
    static constexpr float noDepth = 1e10f;
    /// Mean world-space normal of the surfaces that camera rays meet, towards the camera, times the
    /// part of the rays that meet one; 0 without surfaces.
    Vec3f normal(int x, int y) const;

    std::uint64_t nonFiniteCount() const;
    /// Of all pixels; above the fewest after a render was interrupted inside a pass.
    std::uint64_t mostSamples() const;
    /// Mean over pixels of standard error / mean radiance (channels averaged first); pixels without
    /// light or with fewer than two samples are left out; infinite, as unknown, when none is left.
    double noise() const;

private:
    std::size_t index(int x, int y) const;

    int width_, height_;
    Window crop_;
    std::vector<Pixel> pixels_;
    std::vector<SurfacePixel> surfacePixels_;  // empty without surfaces
};

}  // namespace woodcock
