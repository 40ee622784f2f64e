// SPDX-License-Identifier: Apache-2.0
// Compiled once for each set of instructions: see trace_lanes.cpp.
#if defined(WOODCOCK_LANE_DEPTHS) == defined(HWY_TARGET_TOGGLE)
#ifdef WOODCOCK_LANE_DEPTHS
#undef WOODCOCK_LANE_DEPTHS
#else
#define WOODCOCK_LANE_DEPTHS
#endif

#include <algorithm>
#include <cmath>

#include "woodcock/render/camera_depths.h"
#include "woodcock/render/lanes/lane_rows-inl.h"
#include "woodcock/render/lanes/lane_scene.h"

HWY_BEFORE_NAMESPACE();
namespace woodcock::render::HWY_NAMESPACE {

/// The chance of a correction is this times how wrong the depth may be. With half or twice of it,
/// thin smoke and two overlapping volumes cost as much, within 3 %; with less, the alpha of pixels
/// of few samples is farther below 0.
inline constexpr float correctionsPerDepth = 0.7f;
/// A transmittance is estimated as no less than exp() of minus this, so that it can be corrected by
/// a factor.
inline constexpr float deepestCameraDepth = 30;

template <int N>
Spectrum<N> transmittanceOf(const Spectrum<N>& depth) {
    return Spectrum<N>::map(
        [&](int c) { return std::exp(-std::min(depth[c], deepestCameraDepth)); });
}

/// The optical depth of each channel along a camera ray, as CameraDepths has it.
template <int N>
class DepthsAhead {
public:
    DepthsAhead(const CameraDepths& depths, const CameraDepths::Ray& ray, const LanePart* parts)
        : depths_(&depths), ray_(ray), parts_(parts), whole_(atNode(depths.steps())) {}

    Spectrum<N> atNode(int node) const {
        Spectrum<N> depth;
        for (std::size_t k = 0; k < ray_.parts; ++k)
            depth += channels<N>(parts_[k].part->extinction()) * ray_.density(node, k);
        return depth;
    }
    const Spectrum<N>& whole() const { return whole_; }

    /// By how much the depth may be wrong, up to a node.
    float error(int node) const {
        float sum = 0;
        for (std::size_t k = 0; k < ray_.parts; ++k)
            sum += parts_[k].part->largestExtinction() * ray_.error(node, k);
        return sum;
    }

    /// The chance of corrections of a transmittance up to a node, and of the whole ray's: by how
    /// wrong they may be, and by how much passes in all.
    float correctionChance(int node) const {
        const float passes = transmittanceOf<N>(whole_).mean();
        return std::clamp(
            correctionsPerDepth * (error(node) * (1 - passes) + error(depths_->steps()) * passes),
            depths_->rarestCorrection(), 1.0f);
    }

    /// The distance at which a channel has this depth; less than in all.
    double find(int channel, float depth) const {
        int low = 0, high = depths_->steps();
        while (high - low > 1) {
            const int middle = (low + high) / 2;
            (atNode(middle)[channel] > depth ? high : low) = middle;
        }
        const float a = atNode(low)[channel], b = atNode(high)[channel];
        const double share = b > a ? std::clamp(double{(depth - a) / (b - a)}, 0.0, 1.0) : 0.5;
        return depths_->near() + (low + share) * depths_->spacing();
    }

    /// At a distance: the step there, the depth, and by how much it grows along the ray.
    struct Place {
        int step;
        Spectrum<N> depth, slope;
    };
    Place at(double t) const {
        const double inside = std::clamp((t - depths_->near()) / depths_->spacing(), 0.0,
                                         double{static_cast<float>(depths_->steps())});
        const int step = std::min(static_cast<int>(inside), depths_->steps() - 1);
        const Spectrum<N> a = atNode(step), more = atNode(step + 1) - a;
        return {step, a + more * static_cast<float>(inside - step),
                more * static_cast<float>(1 / depths_->spacing())};
    }

private:
    const CameraDepths* depths_;
    CameraDepths::Ray ray_;
    const LanePart* parts_;
    Spectrum<N> whole_;
};

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
