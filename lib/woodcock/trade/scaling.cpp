// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/scaling.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "woodcock/base/error.h"
#include "woodcock/base/parse.h"
#include "woodcock/trade/lookup_rate.h"
#include "woodcock/trade/scaling_cloud.h"
#include "woodcock/trade/scaling_runs.h"

namespace woodcock::trade {
namespace {

constexpr int sides[]{64, 128, 256, 512, 1024};
constexpr double bakeShare = 0.4;  ///< of the budget, at most, for bakes and loads
constexpr const char* microseconds = "microseconds per sample";

/// One line of a curve that is to be measured.
struct Line {
    std::string name;
    std::vector<TimedRender> renders;
};

class Scaling {
public:
    explicit Scaling(const ScalingOptions& options) : options_(options), start_(wallSeconds()) {}

    ScalingReport run() {
        bakeClouds();
        loading();
        lookups();
        renderCurves();
        return std::move(report_);
    }

private:
    double left() const { return start_ + options_.budget - wallSeconds(); }
    void tell(const std::string& what) const {
        if (options_.onProgress) options_.onProgress(what);
    }
    const ScalingCloud& usual() const { return clouds_.size() > 1 ? clouds_[1] : clouds_.front(); }

    /// As many as the budget and memory allow. Eight times the voxels take four to eight times as
    /// long, as only the cloud's skin has to be evaluated.
    void bakeClouds() {
        double last = 0;
        for (const int side : sides) {
            if (!clouds_.empty() &&
                8 * last > bakeShare * options_.budget - (wallSeconds() - start_)) {
                report_.notes.push_back(
                    fmt::format("the budget was too small to bake {}^3 voxels and more", side));
                break;
            }
            tell(fmt::format("baking {}^3 voxels", side));
            const double start = wallSeconds();
            clouds_.push_back(bakeScalingCloud(side, options_.scratch, side > 256 ? 3 : 5));
            last = wallSeconds() - start;
        }
    }

    void loading() {
        Curve time{"load time",
                   "active voxels",
                   "seconds",
                   "wall clock, from a file in the system's cache to the field that is rendered",
                   {{"woodcock", {}}, {"OpenVDB's own read", {}}}};
        Curve memory{"memory",
                     "active voxels",
                     "megabytes",
                     "",
                     {{"woodcock: field", {}},
                      {"woodcock: field and majorants", {}},
                      {"OpenVDB's tree", {}}}};
        CurveTable table{"loading beside OpenVDB",
                         {"side", "active voxels", "load [s]", "OpenVDB [s]", "ratio", "field [MB]",
                          "majorants [MB]", "OpenVDB [MB]", "optical depth before equalising"},
                         {}};
        for (const ScalingCloud& c : clouds_) {
            const auto active = static_cast<double>(c.activeVoxels);
            const auto mb = [](std::uint64_t bytes) { return static_cast<double>(bytes) / 1e6; };
            time.series[0].points.push_back({active, c.load.value, c.load.se});
            time.series[1].points.push_back({active, c.peer.value, c.peer.se});
            memory.series[0].points.push_back({active, mb(c.fieldBytes), 0});
            memory.series[1].points.push_back({active, mb(c.fieldBytes + c.majorantBytes), 0});
            memory.series[2].points.push_back({active, mb(c.peerBytes), 0});
            table.rows.push_back({double(c.side), active, c.load.value, c.peer.value,
                                  c.load.value / c.peer.value, mb(c.fieldBytes),
                                  mb(c.majorantBytes), mb(c.peerBytes), c.unitDepth});
        }
        report_.curves.push_back(time), report_.curves.push_back(memory);
        report_.tables.push_back(table);
    }

    /// Random lookups by one thread, alternately in all fields.
    void lookups() {
        tell("random lookups");
        Curve curve{"random lookups",
                    "voxels",
                    "million lookups per second",
                    "one thread, fields without empty space, of the same size; dependent: a lookup "
                    "ends before the next begins",
                    {{"independent", {}}, {"dependent", {}}}};
        constexpr std::uint64_t count = 1 << 18;
        const int rounds = options_.budget > 60 ? 9 : 3;
        std::vector<std::array<std::vector<double>, 2>> rates(clouds_.size());
        std::vector<grid::Field> fields;
        for (const ScalingCloud& c : clouds_)
            fields.push_back(fieldOfBricks(c.field->brickCount()));
        for (int round = 0; round < rounds; ++round)
            for (std::size_t i = 0; i < clouds_.size(); ++i)
                for (const bool dependent : {false, true}) {
                    const auto seed = static_cast<std::uint64_t>(round) << 32;
                    const double start = processorSeconds();
                    sink_ += lookAtRandom(fields[i], count, dependent, seed);
                    rates[i][dependent].push_back(double{count} / 1e6 /
                                                  (processorSeconds() - start));
                }
        for (std::size_t i = 0; i < clouds_.size(); ++i)
            for (const std::size_t dependent : {0u, 1u}) {
                const Measured rate = medianOf(rates[i][dependent]);
                curve.series[dependent].points.push_back(
                    {clouds_[i].boxVoxels, rate.value, rate.se});
            }
        looks_ = curve;
        report_.curves.push_back(std::move(curve));
    }

    // ---- renders ------------------------------------------------------------------------------

    TimedRender timed(const ScalingCloud& cloud, const ScalingView& view, double x,
                      std::string name) const {
        return {scalingScene(cloud, view), std::move(name), x};
    }

    template <class Set>
    Line line(const std::string& name, const std::vector<double>& xs, const char* what,
              const Set& set) const {
        Line line{name, {}};
        for (const double x : xs) {
            ScalingView view;
            set(view, x);
            line.renders.push_back(
                timed(usual(), view, x, fmt::format("{} {:g} ({})", what, x, name)));
        }
        return line;
    }

    /// Measures the lines of a curve in its share of the budget, and adds it to the results.
    std::vector<Line> curve(Curve curve, std::vector<Line> lines) {
        tell(curve.name);
        std::vector<TimedRender> all;
        for (Line& l : lines)
            std::move(l.renders.begin(), l.renders.end(), std::back_inserter(all));
        // Curves that took too long must not leave the last one without time.
        const double share = std::max(left(), 0.05 * options_.budget) / curvesLeft_--;
        timeRenders(all, share, report_.notes);
        auto next = all.begin();
        for (Line& l : lines) {
            curve.series.push_back({l.name, {}});
            for (TimedRender& r : l.renders) {
                r = std::move(*next++);
                if (r.microseconds.value > 0)
                    curve.series.back().points.push_back(
                        {r.x, r.microseconds.value, r.microseconds.se});
            }
        }
        report_.curves.push_back(std::move(curve));
        return lines;
    }

    void renderCurves() {
        overVoxels();
        overOpticalDepth();
        const ScalingView usualView;
        const std::string cloud = fmt::format(
            "{}^3 voxels; unless said otherwise, optical depth {:g}, albedo {:g}, g {:g}",
            usual().side, usualView.opticalDepth, usualView.albedo, usualView.g);
        curve({"albedo", "albedo", microseconds, cloud, {}},
              {line("optical depth 10", {0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1}, "albedo",
                    [](ScalingView& v, double x) { v.albedo = x; })});
        curve({"forward scattering", "1 - g", microseconds, cloud, {}},
              {line("albedo 0.9", {1.9, 1.5, 1, 0.5, 0.2, 0.1, 0.05, 0.01}, "1 - g",
                    [](ScalingView& v, double x) { v.g = 1 - x; })});
        curve({"overlapping volumes",
               "volumes",
               microseconds,
               "in one place: all overlap and share the optical depth; apart: one in sight, the "
               "others far away",
               {}},
              {line("in one place", {1, 4, 16, 64, 256}, "volumes",
                    [](ScalingView& v, double x) { v.volumes = static_cast<int>(x); }),
               line("apart", {1, 4, 16, 64, 256}, "volumes", [](ScalingView& v, double x) {
                   v.volumes = static_cast<int>(x), v.apart = true;
               })});
        const auto cells = [](double depth) {
            return [depth](ScalingView& v, double x) {
                v.opticalDepth = depth, v.majorantSmallestLog2 = static_cast<int>(std::log2(x));
            };
        };
        curve({"majorant cells", "smallest cell, voxels", microseconds, cloud, {}},
              {line("optical depth 10", {2, 4, 8, 16, 32, 64, 128}, "cell", cells(10)),
               line("optical depth 1000", {2, 4, 8, 16, 32, 64, 128}, "cell", cells(1000))});
        overThreads();
    }

    void overVoxels() {
        std::vector<Line> lines;
        for (const double depth : {10.0, 100.0}) {
            Line l{fmt::format("optical depth {:g}", depth), {}};
            for (const ScalingCloud& c : clouds_)
                l.renders.push_back(timed(c, {.opticalDepth = depth}, c.boxVoxels,
                                          fmt::format("{}^3 voxels", c.side)));
            lines.push_back(std::move(l));
        }
        lines = curve({"voxels",
                       "voxels of the box",
                       microseconds,
                       "equal optical depth: the mean over the picture, by exact integration",
                       {}},
                      std::move(lines));
        CurveTable table{"the machine's limit: millions a second, one thread",
                         {"side", "optical depth", "collisions of a render", "dependent looks",
                          "share of them", "independent looks", "share of them"},
                         {}};
        for (const Line& l : lines)
            for (std::size_t i = 0; i < clouds_.size(); ++i) {
                const TimedRender& r = l.renders[i];
                if (!(r.microseconds.value > 0)) continue;
                const double rate = r.collisions() / r.seconds / 1e6;
                const double independent = looks_.series[0].points[i].y;
                const double dependent = looks_.series[1].points[i].y;
                table.rows.push_back({double(clouds_[i].side), &l == &lines[0] ? 10.0 : 100.0, rate,
                                      dependent, rate / dependent, independent,
                                      rate / independent});
            }
        report_.tables.push_back(std::move(table));
    }

    void overOpticalDepth() {
        const std::vector<double> depths{0.1, 1, 10, 100, 1e3, 1e4};
        const auto of = [&](double albedo) {
            return line(fmt::format("albedo {:g}", albedo), depths, "optical depth",
                        [=](ScalingView& v, double x) { v.opticalDepth = x, v.albedo = albedo; });
        };
        const std::vector<double> albedos{0.5, 0.9, 1};
        const std::vector<Line> lines = curve({"optical depth",
                                               "optical depth",
                                               microseconds,
                                               fmt::format("{}^3 voxels", usual().side),
                                               {}},
                                              {of(0.5), of(0.9), of(1)});
        CurveTable table{"what a sample does",
                         {"albedo", "optical depth", "microseconds", "scatterings",
                          "collisions of paths / scattering", "shadow rays",
                          "collisions / shadow ray", "cells / flight", "ns / cell or collision"},
                         {}};
        for (std::size_t i = 0; i < lines.size(); ++i)
            for (const TimedRender& r : lines[i].renders) {
                if (!(r.microseconds.value > 0)) continue;
                const render::RenderCounters& c = r.counters;
                const auto ratio = [](std::uint64_t a, std::uint64_t b) {
                    return b > 0 ? static_cast<double>(a) / static_cast<double>(b) : 0;
                };
                table.rows.push_back(
                    {albedos[i], r.x, r.microseconds.value, r.perSample(c.scatterings),
                     ratio(c.distanceCollisions, c.scatterings), r.perSample(c.shadowRays),
                     ratio(c.shadowCollisions, c.shadowRays),
                     ratio(c.distanceSegments, c.scatterings + c.paths),
                     1e9 * r.seconds /
                         (r.collisions() +
                          static_cast<double>(c.distanceSegments + c.shadowSegments))});
            }
        report_.tables.push_back(std::move(table));
    }

    void overThreads() {
        const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
        Line l{"wall clock", {}};
        for (int threads = 1;; threads = std::min(2 * threads, cores)) {
            l.renders.push_back(timed(usual(), {}, threads, fmt::format("{} threads", threads)));
            l.renders.back().threads = threads, l.renders.back().wallClock = true;
            if (threads == cores) break;
        }
        curve({"threads",
               "threads",
               microseconds,
               "wall clock: only meaningful where no other program runs",
               {}},
              {std::move(l)});
    }

    const ScalingOptions options_;
    const double start_;
    ScalingReport report_;
    std::vector<ScalingCloud> clouds_;
    Curve looks_;
    int curvesLeft_ = 7;
    double sink_ = 0;
};

}  // namespace

ScalingReport measureScaling(const ScalingOptions& options) {
    if (options.budget < leastScalingBudget)
        throw usageError("a budget of {} is too small to measure how cost grows; give at least {}",
                         formatDuration(options.budget), formatDuration(leastScalingBudget));
    return Scaling(options).run();
}

}  // namespace woodcock::trade
