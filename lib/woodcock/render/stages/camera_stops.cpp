// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/stages/camera_stops.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace woodcock::render {

namespace {

using Stop = image::StoppedLight::Stop;

double leftOf(const image::StoppedLight& stopped) {
    return stopped.stops.empty() ? 1 : stopped.stops.back().after;
}

std::uint32_t ownerOf(const Scene& scene, std::uint32_t medium, int part) {
    const auto p = static_cast<std::size_t>(part);
    if (medium >= scene.partOwners.size() || p >= scene.partOwners[medium].size()) return 0;
    return scene.partOwners[medium][p];
}

/// The optical depth of one part along a ray.
class DepthCurve {
public:
    void add(const medium::DepthNode& node) { nodes_.push_back(node); }
    bool empty() const { return nodes_.empty(); }
    const std::vector<medium::DepthNode>& nodes() const { return nodes_; }

    /// Over [0, t], before a jump at t or behind it. t must not fall from call to call.
    double at(double t, int channel, bool behind) {
        const auto passed = [&](const medium::DepthNode& n) { return behind ? n.t <= t : n.t < t; };
        if (next_ > 0 && !behind && nodes_[next_ - 1].t >= t) next_ = 0;
        while (next_ < nodes_.size() && passed(nodes_[next_])) ++next_;
        if (next_ == 0) return 0;
        const medium::DepthNode& a = nodes_[next_ - 1];
        const double from = a.depth[channel];
        if (next_ == nodes_.size() || !std::isfinite(from)) return from;
        const medium::DepthNode& b = nodes_[next_];
        return from + (t - a.t) / (b.t - a.t) * (double{b.depth[channel]} - from);
    }

private:
    std::vector<medium::DepthNode> nodes_;
    std::size_t next_ = 0;
};

/// What of a ray's light, by channel, is left where its parts have these depths.
using Light = std::array<double, 3>;
double meanOf(const Light& light) { return (light[0] + light[1] + light[2]) / 3; }

/// Stops of a flight through media that only absorb, from the optical depths of their parts.
class AbsorptionStops {
public:
    AbsorptionStops(Rgb throughput, const std::vector<medium::DepthNode>& nodes) {
        for (int c = 0; c < 3; ++c) light_[static_cast<std::size_t>(c)] = throughput[c];
        const double mean = meanOf(light_);
        for (double& c : light_) c = mean > 0 ? c / mean : 0;
        for (const medium::DepthNode& node : nodes) {
            const auto part = static_cast<std::size_t>(node.part);
            if (part >= curves_.size()) curves_.resize(part + 1);
            curves_[part].add(node);
            times_.push_back(node.t);
        }
        std::sort(times_.begin(), times_.end());
        times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
        depths_.resize(curves_.size());
    }

    /// Calls add(t0, t1, before, after, part, share) for pieces; `left`: of the light at the start.
    template <class F>
    void forEach(double left, F&& add) {
        double from = 0;
        for (const double t : times_) {
            piece(from, t, false, left, add);
            piece(t, t, true, left, add);
            from = t;
        }
    }

private:
    /// Light that `depths` of its parts have left.
    Light through(const std::vector<Light>& depths) const {
        Light passed = light_;
        for (std::size_t c = 0; c < 3; ++c) {
            double sum = 0;
            for (const Light& depth : depths) sum += depth[c];
            passed[c] *= std::exp(-sum);
        }
        return passed;
    }

    template <class F>
    void piece(double t0, double t1, bool behind, double left, F& add) {
        std::vector<Light> next(curves_.size(), Light{});
        for (std::size_t k = 0; k < curves_.size(); ++k)
            if (!curves_[k].empty())
                for (int c = 0; c < 3; ++c)
                    next[k][static_cast<std::size_t>(c)] = curves_[k].at(t1, c, behind);
        const Light before = through(depths_), after = through(next);
        if (meanOf(before) != meanOf(after)) {
            std::vector<double> shares(curves_.size());
            double sum = 0;
            for (std::size_t k = 0; k < curves_.size(); ++k) {
                for (std::size_t c = 0; c < 3; ++c) {
                    if (!(before[c] > 0)) continue;
                    const double more = next[k][c] - depths_[k][c];
                    shares[k] += before[c] * std::clamp(more, -1e3, 1e3);
                }
                sum += shares[k];
            }
            for (std::size_t k = 0; k < curves_.size(); ++k)
                if (shares[k] != 0 && sum != 0)
                    add(t0, t1, left * meanOf(before), left * meanOf(after), static_cast<int>(k),
                        shares[k] / sum);
        }
        depths_ = std::move(next);
    }

    Light light_;  // at the flight's start, of mean 1
    std::vector<DepthCurve> curves_;
    std::vector<double> times_;
    std::vector<Light> depths_;  // of the parts so far
};

}  // namespace

template <int N, bool Surfaces>
void noteStops(const TracedScene& traced, Batch<N, Surfaces>& batch, std::size_t i) {
    const PathState<N, Surfaces>& p = batch.paths[i];
    if (!isToBeNoted(traced, p)) return;
    image::StoppedLight& stopped = *p.result->stopped;
    std::uint32_t medium = 0;
    if constexpr (Surfaces) medium = traced.surfaces->medium(p.surfaces.way.inside());
    double left = leftOf(stopped);
    const PlanarDepth depth(traced, p);
    const auto add = [&](double t0, double t1, double before, double after, int part,
                         double share) {
        stopped.stops.push_back({.near = depth.at(t0),
                                 .far = depth.at(t1),
                                 .before = before,
                                 .after = after,
                                 .share = share,
                                 .owner = ownerOf(traced.scene, medium, part)});
    };
    for (const medium::FlightCollision& c : batch.collisions[i]) {
        if (double{c.left} != left) add(c.t, c.t, left, c.left, c.part, 1);
        left = c.left;
    }
    if (!batch.depths[i].empty())
        AbsorptionStops(toRgb(p.throughput), batch.depths[i]).forEach(left, add);
}

void addStop(const TracedScene& traced, image::StoppedLight& stopped, double depth,
             std::size_t part, double amount) {
    const double left = leftOf(stopped);
    stopped.stops.push_back({.near = depth,
                             .far = depth,
                             .before = left,
                             .after = left - amount,
                             .owner = ownerOf(traced.scene, 0, static_cast<int>(part))});
}

template <int N>
void noteFirstSurface(const TracedScene& traced, const PathState<N, true>& p) {
    image::StoppedLight& stopped = *p.result->stopped;
    const surface::SurfaceHit& hit = p.surfaces.way.hit();
    const surface::SurfaceObject& object = traced.surfaces->object(hit);
    const double depth = PlanarDepth(traced, p).at(0);  // the path stands at the hit
    const std::uint32_t owner = traced.scene.firstSurface + hit.object;
    stopped.firstEvent = {depth, {}, true, owner};
    stopped.stops.push_back({.near = depth,
                             .far = depth,
                             .before = leftOf(stopped),
                             .after = 0,
                             .owner = owner,
                             .kind = object.shadowCatcher && !object.matte
                                         ? Stop::Kind::ShadowCatcher
                                         : Stop::Kind::Surface});
}

void completeStops(PathResult& result) {
    image::StoppedLight& stopped = *result.stopped;
    double sum = 0;
    for (const Stop& stop : stopped.stops)
        if (stop.kind != Stop::Kind::ShadowCatcher) sum += stop.amount();
    // Floats have rounded the throughput, from which alpha follows.
    const double ratio = result.film.alpha / sum;
    const double exactly = ratio > 0.5 && ratio < 2 ? ratio : 1;
    Rgb radiance = result.film.radiance - result.film.background;
    for (Stop& stop : stopped.stops)
        if (stop.kind != Stop::Kind::ShadowCatcher) stop.share *= exactly;
    for (const image::StoppedLight::Arrival& arrival : stopped.arrivals)
        radiance = radiance - arrival.radiance;
    if (!stopped.firstEvent || radiance == Rgb()) return;
    stopped.arrivals.push_back(*stopped.firstEvent);
    stopped.arrivals.back().radiance = radiance;
}

template void noteStops(const TracedScene&, Batch<1, false>&, std::size_t);
template void noteStops(const TracedScene&, Batch<1, true>&, std::size_t);
template void noteStops(const TracedScene&, Batch<3, false>&, std::size_t);
template void noteStops(const TracedScene&, Batch<3, true>&, std::size_t);
template void noteFirstSurface(const TracedScene&, const PathState<1, true>&);
template void noteFirstSurface(const TracedScene&, const PathState<3, true>&);

}  // namespace woodcock::render
