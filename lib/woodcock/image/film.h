// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "woodcock/base/spectrum.h"
#include "woodcock/base/vec.h"
#include "woodcock/image/light_parts.h"

namespace woodcock::image {

/// The result of one camera path.
struct FilmSample {
    Rgb radiance;
    float alpha = 0;   ///< 1 - transmittance along the camera ray
    float events = 0;  ///< scatterings and bounces of the path
    Rgb background =
        {};          ///< the part of the radiance that comes straight from infinitely far lights
    float glow = 0;  ///< 1: the camera ray meets emission, which need not cover the background
};

/// Depth and transmittance of one camera ray; only for layers that need them.
struct DepthSample {
    Rgb transmittance;
    float weightedDepth = 0;  ///< sum over absorbed-or-scattered weight x distance, world units
    float weight = 0;
    Rgb weightedAlbedo =
        {};  ///< of what the ray meets first; this and the normal only for feature layers
    Vec3f weightedNormal = {};  ///< world space; see Film::normal()
};

/// Where the camera ray of a DepthSample meets what it meets first, times that sample's weight.
struct PlaceSample {
    Vec3d weightedPosition;  ///< world space
    /// Pixels, right and down, by which it moves in the picture until the next frame.
    std::array<float, 2> weightedMotion{};
};

/// Where a camera ray loses its light, without chance. Weights are 1 where it does so and 0 where
/// it keeps more, and distances are 0 there; world units.
struct StopSample {
    float firstDepth = 0, firstWeight = 0;  ///< the first hundredth: `firstStopped`
    float halfDepth = 0, halfWeight = 0;    ///< half of it
};
inline constexpr double firstStopped = 0.01;

/// What layers need of camera paths beside FilmSample.
struct LayerNeeds {
    bool depth = false;     ///< DepthSample, without albedo and normal
    bool features = false;  ///< DepthSample
    bool places = false;    ///< DepthSample and PlaceSample
    bool stops = false;     ///< StopSample
    LightParts parts = {};  ///< of FilmSample::radiance
    bool depthSamples() const { return depth || features || places; }
};

/// Light on a shadow catcher that a camera path met: with the scene's occlusion, and without.
struct CatcherSample {
    float lit = 0, unlit = 0;  ///< means of the channels
    float weight = 0;          ///< transmittance in front of it
};

/// Which sums a film keeps beside Film::Pixel.
struct KeptSums {
    bool surfaces, features, background = false;
    bool places = false, stops = false;
    LightParts parts = {};
};

/// Sums over samples, for each pixel, in double. So sample ranges can be merged: the sums of [0, n)
/// and of [n, 2n) add to those of [0, 2n), up to a float's last place.
class Film {
public:
    struct Pixel {
        double radiance[3] = {}, radianceSquared[3] = {};
        double alpha = 0, alphaSquared = 0, events = 0;
        double coverage = 0;  ///< of the larger of alpha and glow
        double transmittance[3] = {};
        double weightedDepth = 0, depthWeight = 0;
        std::uint64_t samples = 0;       ///< of radiance, alpha and events
        std::uint64_t depthSamples = 0;  ///< of transmittance and depth
        std::uint64_t nonFinite = 0;     ///< samples dropped because they were NaN or infinite
    };

    /// Sums that only scenes with surfaces need.
    struct SurfacePixel {
        double catcherLit = 0, catcherUnlit = 0, catcherWeight = 0;
    };

    /// Feature layers for denoisers.
    struct FeaturePixel {
        double albedo[3] = {}, normal[3] = {};
    };
    /// Radiance without infinitely far lights, where these are visible.
    struct ForegroundPixel {
        double radiance[3] = {}, radianceSquared[3] = {};
    };
    struct PlacePixel {
        double position[3] = {}, motion[2] = {};
    };
    struct StopPixel {
        double firstDepth = 0, firstDepthWeight = 0, halfDepth = 0, halfDepthWeight = 0;
    };
    using Kept = KeptSums;

    /// `width` x `height` is the whole image; samples may only fall into the crop
    /// [x0, x1) x [y0, y1), which becomes the EXR's data window.
    struct Window {
        int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
        int width() const { return x1 - x0; }
        int height() const { return y1 - y0; }
        bool operator==(const Window&) const = default;
    };

    /// Throws Error{Usage} on an empty image, and on a crop that is empty or reaches beyond the
    /// image.
    Film(int width, int height, Window crop, Kept kept = {false, false, false});

    int width() const { return width_; }
    int height() const { return height_; }
    Window crop() const { return crop_; }

    /// Pixels are image coordinates, y down, inside the crop.
    Pixel& at(int x, int y);
    const Pixel& at(int x, int y) const;

    /// A sample with anything NaN or infinite in it is dropped and counted.
    /// `parts` are those of its radiance, one for each of Kept::parts.
    void add(int x, int y, const FilmSample& sample, std::span<const Rgb> parts = {});
    void add(int x, int y, const DepthSample& sample);
    void add(int x, int y, const DepthSample& sample, const PlaceSample& place);
    void add(int x, int y, const StopSample& sample);     ///< only where stops are kept
    void add(int x, int y, const CatcherSample& sample);  ///< only where surfaces are kept
    /// Adds the sums of a film of the same size and crop; throws Error{Usage} on any other, and on
    /// one that keeps other sums.
    void merge(const Film& other);

    /// One of the sums that a film keeps, or one of its counts: `components` numbers for each pixel
    /// of the crop, row by row. Number c of a pixel stands at [pixel * stride + c], in `sums` or
    /// in `counts`; the other one is null.
    template <typename Sum, typename Count>
    struct PlaneOf {
        std::string name;  ///< as of the member: files that keep sums use it
        int components;
        std::size_t stride;
        Sum* sums = nullptr;
        Count* counts = nullptr;
    };
    using Plane = PlaneOf<double, std::uint64_t>;
    using ConstPlane = PlaneOf<const double, const std::uint64_t>;
    /// Everything that samples have added to, always in the same order. What adds films, keeps them
    /// in files or measures their memory goes through it, so it need not know what the sums mean.
    std::vector<Plane> planes();
    std::vector<ConstPlane> planes() const;
    /// Whether another film has planes of the same names, of the same size and crop.
    bool isLike(const Film& other) const;
    /// What a film keeps that has planes of these names.
    static Kept keptIn(const std::vector<std::string>& planes);
    std::size_t pixelCount() const { return pixels_.size(); }
    /// Memory of a pixel.
    static std::size_t bytesPerPixel(const Kept& kept);

    /// Means over samples; zero where there are none.
    Rgb radiance(int x, int y) const;
    /// On a shadow catcher, alpha includes the share of its light that the scene occludes.
    float alpha(int x, int y) const;
    Rgb transmittance(int x, int y) const;
    /// The standard error of the mean radiance; infinite (unknown) below two samples. It uses the
    /// variance of the samples, or the mean variance of the pixel and the eight around it, if that
    /// is larger: where rare bright samples make the noise, a pixel that missed them is dark and
    /// seems certain. So the truth lies within two standard errors in at least 95 % of pixels; by
    /// the pixel's own variance it may be 60 %.
    Rgb standardError(int x, int y) const;
    Rgb variance(int x, int y) const;  ///< of the mean radiance: the square of the standard error
    /// Mean distance to what the camera rays meet, world units; `noDepth` where they meet nothing.
    float depth(int x, int y) const;
    static constexpr float noDepth = 1e10f;
    /// Mean over camera rays of the albedo of what they meet first, in [0, 1]: sigma_s / sigma_t in
    /// media, Bsdf::albedo() of surfaces, 0 of nothing. 0 where no features are kept.
    Rgb albedo(int x, int y) const;
    /// Mean over camera rays of the world-space normal of what they meet first: surfaces', towards
    /// the camera; in media densityNormal(); 0 of nothing. 0 where no features are kept.
    Vec3f normal(int x, int y) const;
    /// The part of radiance() that came so, or from this group; 0 where it is not split so.
    Rgb light(LightKind kind, int x, int y) const;
    Rgb lightOfGroup(LightGroup group, int x, int y) const;
    /// Mean place, in world space, of what the camera rays meet first; 0 where they meet nothing,
    /// and where no places are kept.
    Vec3f position(int x, int y) const;
    /// Its mean motion until the next frame, in pixels, right and down; 0 as above.
    std::array<float, 2> motion(int x, int y) const;
    /// Mean distance at which camera rays have lost the first hundredth of their light, and half of
    /// it, of the rays that lose so much; `noDepth` where none does.
    float firstDepth(int x, int y) const;
    float halfDepth(int x, int y) const;

    std::uint64_t nonFiniteCount() const;
    /// Of a render that was stopped inside its first pass.
    std::uint64_t pixelsWithoutSamples() const;
    /// Of all pixels; above the fewest after a render was interrupted inside a pass.
    std::uint64_t mostSamples() const;
    double meanSamples() const;  ///< per pixel
    std::uint64_t fewestSamples() const;

    /// The scene in a pixel, without the background.
    struct Foreground {
        double radiance = 0;  ///< mean over samples and channels
        double variance = 0;  ///< of one sample, mean over channels; 0 of a single one
        double coverage = 0;  ///< share of the camera rays that meet something, 0 to 1
        double alpha = 0;     ///< of media and surfaces: shadow catchers add nothing
    };
    Foreground foreground(int x, int y) const;

    /// The noise of a picture in one number: the relative standard error of the scene without its
    /// background, as a root mean square over pixels.
    /// A pixel counts as much as it covers of the background; emission that covers nothing counts
    /// by its brightness, up to the mean. The error of a pixel is relative to the mean brightness
    /// of the nine pixels around it, before a background as bright as the scene itself; a tenth of
    /// the mean brightness is added to that in squares. So the result depends neither on the
    /// background's brightness nor on its share of the picture. Below 1 % one sees no grain.
    /// Where media only absorb, it is the error of alpha. It is 0 where only background was seen.
    /// It is infinite (unknown) where no pixel has two samples, or where the scene sends no light.
    double noise() const;

private:
    template <typename Planes, typename Self>
    static Planes planesOf(Self& film);
    std::size_t index(int x, int y) const;
    Rgb part(std::size_t place, int x, int y) const;

    int width_, height_;
    Window crop_;
    std::vector<Pixel> pixels_;
    std::vector<SurfacePixel> surfacePixels_;        // empty without surfaces
    std::vector<FeaturePixel> featurePixels_;        // empty where not asked for
    std::vector<ForegroundPixel> foregroundPixels_;  // empty where no background is visible
    std::vector<PlacePixel> placePixels_;            // these three: empty where not asked for
    std::vector<StopPixel> stopPixels_;
    LightParts parts_;
    std::vector<double> partSums_;  // of each pixel, of each part: red, green, blue
};

}  // namespace woodcock::image
