// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/deep_bins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace woodcock::render {

namespace {

constexpr double mostOfBin = 0.1;       // of the light, that a bin stops
constexpr double mostOfNode = 0.05;     // and a piece between two nodes
constexpr double opaque = 1e-4;         // of the light; what lies behind needs no bins
constexpr double nothing = 1e-6;        // of the light
constexpr double leastRatio = 0x1p-24;  // that a sample of a float's alpha can let through
constexpr int mostSteps = 16;           // through one cell
constexpr float middleOfShutter = 0.5f;

/// Of the channels that are not 0.
double smallestOf(Rgb extinction) {
    float smallest = extinction.maximum();
    for (const float c : extinction.c)
        if (c > 0) smallest = std::min(smallest, c);
    return smallest;
}

/// Distances between which a medium's coefficients are even enough, in order: extinctions within
/// `error` over the length of a piece, as far as their bounds tell.
std::vector<double> distancesThrough(const MediumSummary& medium, Vec3d origin, Vec3d direction,
                                     float time, double tMax, double error) {
    std::vector<double> all;
    const auto add = [&](double t0, double t1, double steps) {
        const double n = std::clamp(std::ceil(steps), 1.0, double{mostSteps});
        for (double i = 0; i <= n; ++i) all.push_back(t0 + (t1 - t0) * (i / n));
    };
    for (const medium::MediumPart& part : medium.medium->parts) {
        medium::PartWalk walk(part, part.indexRay(origin, direction, time), tMax);
        const double extinction = part.extinction().maximum();
        for (grid::Segment s{0, 0, {}}; walk.next(s);) {
            if (!(s.range.max * extinction > 0)) continue;
            if (!std::isfinite(s.t1))
                s.t1 = s.t0 - std::log(opaque) / (s.range.max * smallestOf(part.extinction()));
            add(s.t0, s.t1, (s.range.max - s.range.min) * extinction * (s.t1 - s.t0) / error);
        }
    }
    for (const medium::EmissionPart& part : medium.emission)
        part.walk(origin, direction, time, tMax,
                  [&](double t0, double t1, double) { add(t0, t1, 2); });
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

PathTracer::Options optionsFor(int width, int height) {
    PathTracer::Options options;
    options.width = width, options.height = height;
    return options;
}

/// How light fares through a medium, by channel.
struct Passage {
    std::array<double, 3> depth{};
    double left() const {
        return (std::exp(-depth[0]) + std::exp(-depth[1]) + std::exp(-depth[2])) / 3;
    }
    Passage operator+(const std::array<double, 3>& more) const {
        return {{depth[0] + more[0], depth[1] + more[1], depth[2] + more[2]}};
    }
};

}  // namespace

DeepBins::DeepBins(const Scene& scene, const Needs& needs, int width, int height, double error)
    : traced_(scene, needs, optionsFor(width, height)), error_(error) {}

DeepBins::Ray DeepBins::ray(double x, double y) const {
    const float time = traced_.needs.motion ? middleOfShutter : 0;
    const camera::Camera camera = traced_.scene.camera.at(time);
    const camera::CameraRay r =
        camera.ray(x, y, traced_.options.width, traced_.options.height, time);
    const Vec3d forward = normalize(camera.worldFromCamera.vector({0, 0, -1}));
    const double slope = dot(r.direction, forward);
    Ray ray;
    Passage passage;
    double emitted = 0;
    const auto add = [&](double depth) {
        if (ray.nodes.empty() || depth > ray.nodes.back().depth)
            ray.nodes.push_back({depth, 1 - passage.left(), emitted});
    };
    const auto pass = [&](const MediumSummary& medium, Vec3d origin, double tMax) {
        const double before = dot(origin - camera.worldFromCamera.translation, forward);
        const std::vector<double> distances =
            distancesThrough(medium, origin, r.direction, r.time, tMax, error_);
        for (std::size_t i = 0; i + 1 < distances.size(); ++i) {
            const double t0 = distances[i], t1 = distances[i + 1];
            const Vec3d middle = origin + r.direction * ((t0 + t1) / 2);
            std::array<double, 3> more{};
            Rgb glow;
            for (const medium::MediumPart& part : medium.medium->parts) {
                const Rgb sigma = part.sigmaT(middle, r.time);
                for (std::size_t c = 0; c < 3; ++c) more[c] += double{sigma.c[c]} * (t1 - t0);
            }
            for (const medium::EmissionPart& part : medium.emission)
                glow += part.value(middle, r.time);
            const double left = passage.left(), behind = (passage + more).left();
            if (behind == left && !(glow.maximum() > 0)) continue;
            const double pieces = std::max(1.0, std::ceil((left - behind) / mostOfNode));
            for (double k = 0; k < pieces; ++k) {
                add(std::max(0.0, before + slope * (t0 + (t1 - t0) * (k / pieces))));
                for (std::size_t c = 0; c < 3; ++c) passage.depth[c] += more[c] / pieces;
                emitted += double{glow.mean()} * (t1 - t0) / pieces * passage.left();
            }
            add(std::max(0.0, before + slope * t1));
            if (passage.left() < opaque) return;
        }
    };

    if (!traced_.surfaces) {
        pass(traced_.media[traced_.media.number(0, 0)], r.origin,
             std::numeric_limits<double>::infinity());
        return ray;
    }
    const NestedMedia& media = *traced_.surfaces;
    BoundaryWalk way(traced_.startOf(r.origin, r.direction, r.time));
    Vec3d origin = r.origin;
    while (passage.left() >= opaque) {
        const bool meets = way.next(
            media, {.origin = origin, .direction = r.direction, .time = r.time, .cameraRay = true});
        pass(traced_.media[traced_.mediumAround(0, way.inside())], origin, way.tMax());
        if (!meets) break;
        const Crossing crossing = way.crossing(media, r.direction);
        origin = way.hit().position;
        if (media.object(way.hit()).holdout || !crossing.passes) {
            ray.surface = dot(origin - camera.worldFromCamera.translation, forward);
            ray.surfaceStops = media.object(way.hit()).holdout ? 0 : passage.left();
            break;
        }
        way.pass(crossing);
    }
    return ray;
}

std::vector<float> DeepBins::edges(int x, int y) const {
    std::array<Ray, 4> rays;
    for (std::size_t i = 0; i < rays.size(); ++i)
        rays[i] = ray(x + (i % 2 == 0 ? 0.25 : 0.75), y + (i < 2 ? 0.25 : 0.75));

    // Their mean, at the nodes of all.
    struct MeanNode {
        double depth, stopped = 0, bySurfaces = 0, emitted = 0;
        bool edge = false;
    };
    std::vector<MeanNode> mean;
    for (const Ray& r : rays) {
        for (const Node& node : r.nodes) mean.push_back({node.depth});
        if (r.surface >= 0 && !r.nodes.empty()) mean.push_back({r.surface});
    }
    std::sort(mean.begin(), mean.end(),
              [](const MeanNode& a, const MeanNode& b) { return a.depth < b.depth; });
    mean.erase(std::unique(mean.begin(), mean.end(),
                           [](const MeanNode& a, const MeanNode& b) {
                               return static_cast<float>(a.depth) == static_cast<float>(b.depth);
                           }),
               mean.end());
    for (const Ray& r : rays) {
        std::size_t next = 0;
        for (MeanNode& m : mean) {
            while (next < r.nodes.size() && r.nodes[next].depth <= m.depth) ++next;
            if (next > 0) {
                const Node& a = r.nodes[next - 1];
                double stopped = a.stopped, emitted = a.emitted;
                if (next < r.nodes.size()) {
                    const Node& b = r.nodes[next];
                    const double share = (m.depth - a.depth) / (b.depth - a.depth);
                    stopped =
                        1 - (1 - a.stopped) * std::pow((1 - b.stopped) / (1 - a.stopped), share);
                    emitted += share * (b.emitted - a.emitted);
                }
                m.stopped += stopped / rays.size();
                m.emitted += emitted / rays.size();
            }
            if (r.surface >= 0 && r.surface <= m.depth)
                m.bySurfaces += r.surfaceStops / rays.size();
            m.edge |=
                r.surface >= 0 && static_cast<float>(r.surface) == static_cast<float>(m.depth);
        }
    }
    if (mean.size() < 2 || (mean.back().stopped < nothing && !(mean.back().emitted > 0))) return {};

    // Bins are cut where their error is largest, as long as it is too large.
    const double allEmitted = mean.back().emitted;
    std::vector<std::pair<std::size_t, std::size_t>> left;
    const auto cutAt = [&](std::size_t first, std::size_t last) -> std::size_t {
        const MeanNode &a = mean[first], &b = mean[last];
        const double inFront = std::max(1 - a.stopped - a.bySurfaces, nothing);
        const double stops = b.stopped - a.stopped;
        const double ratio = std::max(1 - stops / inFront, leastRatio);
        double worst = error_;
        std::size_t cut = 0;
        for (std::size_t k = first + 1; k < last; ++k) {
            const double at = (mean[k].depth - a.depth) / (b.depth - a.depth);
            const double passed = std::pow(ratio, at);
            const double stopped = inFront * (1 - passed);
            // A bin's colour is spread as its alpha.
            const double share = ratio < 1 - nothing ? (1 - passed) / (1 - ratio) : at;
            double error = std::abs(stopped - (mean[k].stopped - a.stopped));
            if (allEmitted > 0)
                error = std::max(
                    error, std::abs(mean[k].emitted - a.emitted - share * (b.emitted - a.emitted)) /
                               allEmitted);
            if (error > worst) worst = error, cut = k;
        }
        if (cut == 0 && stops > mostOfBin)
            for (std::size_t k = first + 1; k < last; ++k) {
                cut = k;
                if (mean[k].stopped - a.stopped >= stops / 2) break;
            }
        return cut;
    };
    mean.front().edge = mean.back().edge = true;
    std::size_t from = 0;
    for (std::size_t k = 1; k < mean.size(); ++k)
        if (mean[k].edge) left.emplace_back(from, k), from = k;
    while (!left.empty()) {
        const auto [first, last] = left.back();
        left.pop_back();
        if (last < first + 2) continue;
        const std::size_t cut = cutAt(first, last);
        if (cut == 0) continue;
        mean[cut].edge = true;
        left.emplace_back(first, cut), left.emplace_back(cut, last);
    }

    std::erase_if(mean, [](const MeanNode& m) { return !m.edge; });
    const auto empty = [&](const MeanNode& a, const MeanNode& b) {
        return b.stopped - a.stopped < nothing && !(b.emitted > a.emitted);
    };
    std::size_t first = 0, last = mean.size() - 1;
    while (first + 1 < last && empty(mean[first], mean[first + 1])) ++first;
    while (first + 1 < last && empty(mean[last - 1], mean[last])) --last;
    std::vector<float> edges;
    for (std::size_t k = first; k <= last; ++k) edges.push_back(static_cast<float>(mean[k].depth));
    return edges;
}

}  // namespace woodcock::render
