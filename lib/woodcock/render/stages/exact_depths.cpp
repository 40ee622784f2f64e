// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/stages/exact_depths.h"

#include <array>

#include "woodcock/medium/optical_depth.h"

namespace woodcock::render {

namespace {

/// Follows one ray, piece by piece, to where its mean transmittance falls to each of two values.
class DepthSearch {
public:
    bool done() const { return next_ == depths_.size(); }

    /// A straight piece through one medium.
    void goThrough(const medium::Medium& medium, Vec3d origin, Vec3d direction, float time,
                   double length) {
        medium::DepthAlong along{
            .medium = medium, .origin = origin, .direction = direction, .time = time};
        along.depth = depth_;
        for (; !done(); ++next_) {
            if (!medium::findTransmittance(along, length, transmittances[next_])) break;
            depths_[next_] = before_ + along.t;
        }
        depth_ = along.depth;
        before_ += length;
    }
    /// Something that lets nothing through.
    void stop() {
        for (; !done(); ++next_) depths_[next_] = before_;
    }

    image::StopSample sample() const {
        image::StopSample s;
        if (next_ > 0) s.firstDepth = static_cast<float>(depths_[0]), s.firstWeight = 1;
        if (next_ > 1) s.halfDepth = static_cast<float>(depths_[1]), s.halfWeight = 1;
        return s;
    }

private:
    static constexpr std::array<double, 2> transmittances{1 - image::firstStopped, 0.5};
    std::array<double, 2> depths_{};
    std::size_t next_ = 0;  ///< the first that was not found yet
    double before_ = 0;
    Vec3d depth_;  ///< optical depth so far, of each channel
};

}  // namespace

template <int N, bool Surfaces>
image::StopSample findExactDepths(const TracedScene& traced, const PathState<N, Surfaces>& p) {
    DepthSearch search;
    if constexpr (Surfaces) {
        const NestedMedia& media = *traced.surfaces;
        BoundaryWalk way = p.surfaces.way;
        Vec3d origin = p.origin;
        while (!search.done()) {
            const bool hits = way.next(
                media,
                {.origin = origin, .direction = p.direction, .time = p.time, .cameraRay = true});
            const std::uint32_t medium = media.medium(way.inside());
            search.goThrough(
                medium == 0 ? traced.scene.medium : traced.scene.interiorMedia[medium - 1], origin,
                p.direction, p.time, way.tMax());
            if (!hits || media.object(way.hit()).holdout) break;
            const Crossing crossing = way.crossing(media, p.direction);
            if (!crossing.passes) search.stop();
            origin = way.hit().position;
            way.pass(crossing);
        }
    } else {
        search.goThrough(traced.scene.medium, p.origin, p.direction, p.time,
                         std::numeric_limits<double>::infinity());
    }
    return search.sample();
}

template image::StopSample findExactDepths(const TracedScene&, const PathState<1, false>&);
template image::StopSample findExactDepths(const TracedScene&, const PathState<1, true>&);
template image::StopSample findExactDepths(const TracedScene&, const PathState<3, false>&);
template image::StopSample findExactDepths(const TracedScene&, const PathState<3, true>&);

}  // namespace woodcock::render
