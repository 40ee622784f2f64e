// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/lanes/trace_lanes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "woodcock/medium/corrected_transmittance.h"
#include "woodcock/medium/optical_depth.h"
#include "woodcock/render/stages/camera_stops.h"
#include "woodcock/render/stages/event_numbers.h"
#include "woodcock/render/stages/light.h"
#include "woodcock/render/stages/roulette.h"
#include "woodcock/render/stages/several_events.h"
#include "woodcock/render/stages/shade_media.h"
#include "woodcock/render/stages/turn.h"

#undef HWY_TARGET_INCLUDE
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#define HWY_TARGET_INCLUDE "woodcock/render/lanes/trace_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "woodcock/render/lanes/lane_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace woodcock::render::HWY_NAMESPACE {

constexpr std::size_t laneCount = hn::MaxLanes(lanesF);
/// An inverse or a distance that no path has; finite, so that a product with 0 is a number.
constexpr float huge = 1e30f;
/// Cells are taken to be at most so wide, in voxels, that a float within one is exact enough.
constexpr int widestLog2 = 7;

/// A number of each lane, in memory.
template <class T>
struct alignas(64) Row {
    static constexpr hn::ScalableTag<T> tag{};
    T lane[laneCount];

    T& operator[](std::size_t i) { return lane[i]; }
    hn::Vec<hn::ScalableTag<T>> get() const { return hn::Load(tag, lane); }
    void set(hn::Vec<hn::ScalableTag<T>> v) { hn::Store(v, tag, lane); }
    template <class M>
    void set(M where, hn::Vec<hn::ScalableTag<T>> v) {
        set(hn::IfThenElse(where, v, get()));
    }
};
using Floats = Row<float>;

/// The lanes in which a mask is true, as bits.
template <class M>
std::uint32_t bitsOf(M mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(lanesF, mask, bytes);
    return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8;
}
template <class A>
HWY_INLINE void forEachLane(std::uint32_t bits, A&& act) {
    for (; bits; bits &= bits - 1) act(static_cast<std::size_t>(std::countr_zero(bits)));
}

/// What a lane does.
enum State : std::int32_t {
    Idle,      ///< there are no more paths
    Walking,   ///< from cell to cell
    Colliding, ///< a tentative collision is to be decided
    Arrived,   ///< it has scattered
    Departing, ///< a turn and a new flight are to be drawn
    Ended      ///< light has taken the path's end, or left the medium
};

/// The walk of one part's tentative collisions along a flight, where its lane does something else.
struct Process {
    std::array<float, 3> u, d, inverse;
    std::array<std::int32_t, 3> corner;
    float size, mu, perMu, depth, t, lower, upper;
    bool waits = false;  ///< at a collision, at `t`
    bool ended = false;
};

template <int N>
class LaneTracer {
public:
    LaneTracer(const LaneScene& scene, Batch<N, false>& batch)
        : scene_(scene), traced_(scene.traced), batch_(batch), several_(scene.parts.size() > 1) {
        if (scene.sunDepth) sunSample_ = traced_.scene.lights.sample(scene.sun, {}, 0, 0);
    }

    void run() {
        for (std::size_t lane = 0; lane < laneCount; ++lane) load(lane);
        while (true) {
            const auto state = state_.get();
            const auto walking = is(state, Walking);
            const std::size_t walkers = hn::CountTrue(lanesF, walking);
            const std::size_t waiting = hn::CountTrue(
                lanesF, hn::Or(is(state, Arrived), is(state, Departing)));
            if (waiting >= enough || (walkers == 0 && waiting > 0)) {
                handleEvents();
                continue;
            }
            if (walkers == 0) break;
            step(walking);
            decideCollisions();
        }
    }

private:
    /// So many lanes wait until what happens at a scattering is worth doing.
    static constexpr std::size_t enough = (laneCount + 1) / 2;

    /// Copies of a path that wait at a scattering until the one before them has ended.
    struct Branch {
        Process vertex;
        std::size_t part;
        std::array<float, 3> direction;
        Spectrum<N> throughput, predicted;
        std::int64_t scatterings;
        float share;
        int copies;
    };

    /// A lane's path, as it is not needed in vectors.
    struct Lane {
        std::uint32_t path;
        std::size_t part = 0;       ///< that walks now
        std::size_t nearest = none; ///< the part with the nearest collision so far
        // Of several flights in one direction:
        bool probe = false;         ///< this is one of them, and not the path's own
        int flights = 1, probesLeft = 0, ownStratum = 0;
        float ownDepth = 0;
        bool quasiRandom = false;   ///< the flight ahead has numbers_
        Process vertex;             ///< from which they start
        std::array<float, 3> direction;
        Spectrum<N> throughput, chance;
        std::size_t vertexPart = 0;
        Vec3d position;
        std::vector<Process> processes;  ///< of each part; only where there are several
        std::vector<Branch> branches;    ///< of the path that are still to be followed
        bool first = true;               ///< this is the branch with the quasi-random numbers
        float events = 0;                ///< of the branches so far, by their share
    };
    static constexpr std::size_t none = ~std::size_t{0};

    /// Beyond this optical depth the grid says that no light comes through; corrections are rare.
    static constexpr float deepest = 20;

    static auto maskOf(std::uint32_t bits) {
        Row<float> lanes;
        for (std::size_t i = 0; i < laneCount; ++i) lanes[i] = bits >> i & 1 ? 1.0f : 0.0f;
        return lanes.get() > hn::Zero(lanesF);
    }
    static auto is(hn::Vec<hn::ScalableTag<std::int32_t>> state, State s) {
        return hn::RebindMask(lanesF, state == hn::Set(lanesI, s));
    }
    PathState<N, false>& pathOf(std::size_t lane) { return batch_.paths[lanes_[lane].path]; }
    void setState(std::size_t lane, State s) { state_[lane] = s; }

    // ---- paths

    /// Gives a lane the next path.
    void load(std::size_t lane) {
        while (next_ < batch_.paths.size()) {
            Lane& l = lanes_[lane];
            l.path = static_cast<std::uint32_t>(next_++);
            l.probesLeft = 0, l.probe = false, l.first = true, l.events = 0;
            PathState<N, false>& p = pathOf(lane);
            p.medium = 0;
            for (int i = 0; i < 3; ++i)
                v_[i][lane] = static_cast<float>(p.direction[i]);
            for (int c = 0; c < N; ++c) w_[c][lane] = p.throughput[c];
            const std::uint64_t key = p.random.bits();
            key_[0][lane] = static_cast<std::uint32_t>(key);
            key_[1][lane] = static_cast<std::uint32_t>(key >> 32);
            count_[lane] = 0;
            branchShare_[lane] = 1;
            density_[lane] = 0, share_[lane] = 1, events_[lane] = 0;
            for (int c = 0; c < N; ++c) chance_[c][lane] = window_[c][lane] = control_[c][lane] = predicted_[c][lane] = 0;
            if (collisions(lane)) collisions(lane)->clear();
            if (begin(lane, p.origin, static_cast<float>(-std::log(p.flight)))) return;
            leave(lane);
        }
        setState(lane, Idle);
    }

    std::vector<medium::FlightCollision>* collisions(std::size_t lane) {
        return collisionsToNote(traced_, batch_, lanes_[lane].path);
    }

    /// The path has left the medium.
    void leave(std::size_t lane) {
        PathState<N, false>& p = pathOf(lane);
        takeThroughput(lane, p);
        if (seen(p)) {
            endCameraFlight(lane, false);
        } else {
            p.phasePdf = double{density_[lane]};
            p.direction = directionOf(lane);
        }
        escape(traced_, batch_, p);
    }

    /// A flight has ended without an event, or its light was taken.
    void end(std::size_t lane, bool lost) {
        if (lanes_[lane].probe) {
            endProbe(lane);
            return;
        }
        PathState<N, false>& p = pathOf(lane);
        if (lost) {
            takeThroughput(lane, p);
            if (seen(p)) endCameraFlight(lane, false);
        } else {
            leave(lane);
        }
        endBranch(lane);
    }

    /// Adds what the control variates have come to.
    void settleControls(std::size_t lane) {
        PathState<N, false>& p = pathOf(lane);
        const light::LightSet& lights = traced_.scene.lights;
        using image::LightKind;
        const auto of = [&](Floats* row) {
            return toRgb(Spectrum<N>::map([&](int c) { return row[c][lane]; }));
        };
        static const float we = getenv("WC") ? float(atof(getenv("WC"))) : 1;
        bring(batch_, p, of(window_) * (scene_.environment + sunSample_.weight * (we / (4 * 3.14159265f))) * -1.0f, LightKind::VolumeIndirect, 0);
        if (scene_.environmentLight >= 0)
            bring(batch_, p, of(chance_) * scene_.environment * -1.0f, LightKind::VolumeIndirect,
                  lights.group(scene_.environmentLight));
        if (scene_.sunDepth)
            bring(batch_, p, of(control_) * sunSample_.weight, LightKind::VolumeIndirect,
                  lights.group(scene_.sun));
    }

    void endCameraFlight(std::size_t lane, bool scattered) {
        PathState<N, false>& p = pathOf(lane);
        p.result->film.alpha = scattered ? 1 : opacityOf(p);
        if (!isToBeNoted(traced_, p)) return;
        noteStops(traced_, batch_, lanes_[lane].path);
        if (scattered) noteFirstScattering(traced_, p, double{t_[lane]});
    }

    void takeThroughput(std::size_t lane, PathState<N, false>& p) {
        p.throughput = Spectrum<N>::map([&](int c) { return w_[c][lane]; });
    }
    Vec3d directionOf(std::size_t lane) {
        return {double{v_[0][lane]}, double{v_[1][lane]}, double{v_[2][lane]}};
    }

    // ---- flights

    /// Begins a flight at a point of the world, in the lane's direction; false: it meets no part.
    bool begin(std::size_t lane, Vec3d origin, float depth) {
        Lane& l = lanes_[lane];
        const Vec3d direction = directionOf(lane);
        if (!several_) {
            Process process;
            enter(0, origin, direction, depth, process);
            if (process.ended) return false;
            put(lane, 0, process);
            limit_[lane] = huge;
            setState(lane, Walking);
            return true;
        }
        l.processes.resize(scene_.parts.size());
        for (std::size_t k = 0; k < scene_.parts.size(); ++k) {
            if (k > 0)
                depth = static_cast<float>(-std::log(pathOf(lane).random.uniformOpenLow()));
            enter(k, origin, direction, depth, l.processes[k]);
        }
        l.part = none;
        return findNearest(lane);
    }

    /// Puts a part's process to where the ray enters its support.
    void enter(std::size_t k, Vec3d origin, Vec3d direction, float depth, Process& process) {
        const LanePart& part = scene_.parts[k];
        const grid::IndexRay ray = part.part->indexRay(origin, direction);
        double t0 = 0, t1 = std::numeric_limits<double>::infinity();
        process.ended = !grid::clip(ray, part.part->support(), t0, t1), process.waits = false;
        if (process.ended) return;
        const Vec3d at = min(part.part->support().upper, max(part.part->support().lower, ray.at(t0)));
        Vec3i voxel;
        for (int i = 0; i < 3; ++i)
            voxel[i] = std::clamp(floorToInt(at[i]), part.low[i], part.high[i]);
        const grid::MajorantGrid::Cell cell = part.part->majorants().find(voxel);
        const int size = 1 << std::min(cell.log2Size, widestLog2);
        for (std::size_t i = 0; i < 3; ++i) {
            const int axis = static_cast<int>(i);
            process.corner[i] = voxel[axis] & -size;
            process.u[i] = std::clamp(static_cast<float>(at[axis] - process.corner[i]), 0.0f,
                                      static_cast<float>(size));
            process.d[i] = static_cast<float>(ray.direction[axis]);
            process.inverse[i] = 1 / std::max(std::abs(process.d[i]), 1 / huge);
        }
        process.size = static_cast<float>(size);
        process.lower = cell.range.min, process.upper = cell.range.max;
        process.mu = cell.range.max * part.part->largestExtinction();
        process.perMu = process.mu > 0 ? 1 / process.mu : huge;
        process.depth = depth, process.t = static_cast<float>(t0);
    }

    void put(std::size_t lane, std::size_t part, const Process& p) {
        for (std::size_t i = 0; i < 3; ++i) {
            u_[i][lane] = p.u[i], d_[i][lane] = p.d[i], inverse_[i][lane] = p.inverse[i];
            corner_[i][lane] = p.corner[i];
        }
        size_[lane] = p.size, mu_[lane] = p.mu, perMu_[lane] = p.perMu, depth_[lane] = p.depth;
        t_[lane] = p.t, lower_[lane] = p.lower, upper_[lane] = p.upper;
        if (lanes_[lane].part == part && ready_[lane]) return;
        lanes_[lane].part = part, ready_[lane] = true;
        const medium::MediumPart& medium = *scene_.parts[part].part;
        for (int c = 0; c < N; ++c) {
            absorption_[c][lane] = N == 1 ? channels<N>(medium.absorption())[0] : medium.absorption()[c];
            scattering_[c][lane] = N == 1 ? channels<N>(medium.scattering())[0] : medium.scattering()[c];
            channelWeight_[c][lane] = medium.channelWeight()[c];
        }
        for (int c = 0; c < N; ++c) {
            const float whole = absorption_[c][lane] + scattering_[c][lane];
            const float albedo = whole > 0 ? scattering_[c][lane] / whole : 0;
            albedo_[c][lane] = albedo;
            kappa_[c][lane] = std::sqrt(3 * (1 - albedo) * (1 - scene_.parts[part].g * albedo));
            static const float bb = getenv("BB") ? float(atof(getenv("BB"))) : 1;
            beta_[c][lane] = bb * (1 - std::sqrt((1 - albedo) / (1 - scene_.parts[part].g * albedo)));
        }
        g_[lane] = scene_.parts[part].g, extinction_[lane] = medium.largestExtinction();
        for (int i = 0; i < 3; ++i) {
            low_[i][lane] = scene_.parts[part].low[i], high_[i][lane] = scene_.parts[part].high[i];
            for (int k = 0; k < 4; ++k) lattice_[i][k][lane] = scene_.parts[part].latticeFromIndex[i][k];
        }
        const bool nearest = medium.field()->lookup() == grid::Lookup::Nearest;
        jitterUnit_[lane] = nearest ? 0 : 0x1p-21f;
        firstJitter_[lane] = nearest ? 0.5f : 0x1p-22f;
    }

    void take(std::size_t lane, Process& p) {
        for (std::size_t i = 0; i < 3; ++i) {
            p.u[i] = u_[i][lane], p.d[i] = d_[i][lane], p.inverse[i] = inverse_[i][lane];
            p.corner[i] = corner_[i][lane];
        }
        p.size = size_[lane], p.mu = mu_[lane], p.perMu = perMu_[lane], p.depth = depth_[lane];
        p.t = t_[lane], p.lower = lower_[lane], p.upper = upper_[lane];
    }

    /// Goes on with the parts behind l.part, none meaning all: the next one that may have a
    /// collision before the nearest so far; or decides that one. False: the flight meets nothing.
    bool findNearest(std::size_t lane) {
        Lane& l = lanes_[lane];
        if (l.part == none) l.nearest = none, limit_[lane] = huge;
        ready_[lane] = false;
        for (std::size_t k = l.part + 1; k < l.processes.size(); ++k) {
            Process& process = l.processes[k];
            if (process.ended) continue;
            if (process.waits) {
                if (process.t < limit_[lane]) limit_[lane] = process.t, l.nearest = k;
                continue;
            }
            put(lane, k, process);
            setState(lane, Walking);
            return true;
        }
        if (l.nearest == none) return false;
        put(lane, l.nearest, l.processes[l.nearest]);
        setState(lane, Colliding);
        return true;
    }

    /// All lanes that walk go on to the next face of their cell, or to a tentative collision.
    template <class M>
    HWY_INLINE void step(M walking) {
        const F size = size_.get(), zero = hn::Zero(lanesF);
        F face[3];
        for (int i = 0; i < 3; ++i) {
            const F u = u_[i].get();
            face[i] = hn::IfThenElse(d_[i].get() >= zero, size - u, u) * inverse_[i].get();
        }
        const F toFace = hn::Min(face[0], hn::Min(face[1], face[2]));
        const F toCollision = depth_.get() * perMu_.get();
        const F toLimit = limit_.get() - t_.get();
        const F length = hn::Max(zero, hn::Min(toFace, hn::Min(toCollision, toLimit)));
        const auto collides =
            hn::And(walking, hn::And(toCollision < toFace, toCollision < toLimit));
        const auto pauses = hn::AndNot(collides, hn::And(walking, toLimit <= toFace));
        for (int i = 0; i < 3; ++i)
            u_[i].set(walking, hn::Max(zero, hn::Min(size, u_[i].get() + d_[i].get() * length)));
        t_.set(walking, t_.get() + length);
        depth_.set(walking, hn::Max(zero, depth_.get() - length * mu_.get()));
        const std::uint32_t colliding = bitsOf(collides);
        counters_.collisions += static_cast<unsigned>(std::popcount(colliding));
        const M alongX = face[0] == toFace, alongY = hn::AndNot(alongX, face[1] == toFace);
        const M along[3] = {alongX, alongY, hn::Not(hn::Or(alongX, alongY))};
        if (!several_) {
            state_.set(hn::RebindMask(lanesI, collides), hn::Set(lanesI, Colliding));
            cross(hn::AndNot(collides, walking), along);
            return;
        }
        const std::uint32_t pausing = bitsOf(pauses);
        cross(hn::AndNot(hn::Or(collides, pauses), walking), along);
        forEachLane(colliding, [&](std::size_t i) {
            Lane& l = lanes_[i];
            Process& process = l.processes[l.part];
            take(i, process);
            process.waits = true, l.nearest = l.part, limit_[i] = process.t;
            nextPart(i);
        });
        forEachLane(pausing, [&](std::size_t i) {
            take(i, lanes_[i].processes[lanes_[i].part]);
            nextPart(i);
        });
    }

    void nextPart(std::size_t lane) {
        if (!findNearest(lane)) end(lane, false);
    }

    /// Lanes that have come to a face ahead enter the next cell, or leave the part's support. `along`:
    /// whether that face lies across each axis.
    template <class M>
    HWY_INLINE void cross(M crossing, const M along[3]) {
        const I one = hn::Set(lanesI, 1), width = hn::ConvertTo(lanesI, size_.get());
        Row<std::int32_t> voxel[3];
        I room = one;  // negative outside
        for (int i = 0; i < 3; ++i) {
            const I corner = corner_[i].get(), low = low_[i].get();
            const auto forward = hn::RebindMask(lanesI, d_[i].get() >= hn::Zero(lanesF));
            const I within =
                hn::Max(low, corner + hn::Min(hn::ConvertTo(lanesI, u_[i].get()), width - one));
            const I next = hn::IfThenElse(hn::RebindMask(lanesI, along[i]),
                                          corner + hn::IfThenElse(forward, width, hn::Zero(lanesI) - one),
                                          within);
            voxel[i].set(next);
            room = hn::Min(room, hn::Min(next - low, high_[i].get() - next));
        }
        const auto leaves = hn::And(crossing, hn::RebindMask(lanesF, room < hn::Zero(lanesI)));
        const std::uint32_t entering = bitsOf(hn::AndNot(leaves, crossing));
        counters_.segments += static_cast<unsigned>(std::popcount(entering));
        Row<std::int32_t> size;
        size.set(one);
        forEachLane(entering, [&](std::size_t i) {
            const grid::MajorantGrid::Cell cell = scene_.parts[lanes_[i].part].part->majorants().find(
                {voxel[0][i], voxel[1][i], voxel[2][i]});
            size[i] = 1 << std::min(cell.log2Size, widestLog2);
            lower_[i] = cell.range.min, upper_[i] = cell.range.max;
        });
        const auto enters = hn::AndNot(leaves, crossing);
        const F edge = hn::ConvertTo(lanesF, size.get()), zero = hn::Zero(lanesF);
        for (int i = 0; i < 3; ++i) {
            const I corner = hn::And(voxel[i].get(), hn::Zero(lanesI) - size.get());
            const F moved = hn::ConvertTo(lanesF, corner_[i].get() - corner) + u_[i].get();
            const I ahead = corner_[i].get() + hn::IfThenElseZero(hn::RebindMask(lanesI, d_[i].get() >= zero), width);
            const F face = hn::ConvertTo(lanesF, ahead - corner);
            u_[i].set(enters, hn::IfThenElse(along[i], face, hn::Max(zero, hn::Min(edge, moved))));
            corner_[i].set(hn::RebindMask(lanesI, enters), corner);
        }
        size_.set(enters, edge);
        const F mu = upper_.get() * extinction_.get();
        mu_.set(enters, mu);
        perMu_.set(enters, hn::IfThenElse(mu > zero, all(1) / mu, all(huge)));
        forEachLane(bitsOf(leaves), [&](std::size_t i) {
            if (several_) {
                lanes_[i].processes[lanes_[i].part].ended = true;
                nextPart(i);
            } else {
                end(i, false);
            }
        });
    }

    // ---- collisions

    /// Four words for each lane where `where` is true.
    template <class M>
    void draw(M where, U words[4]) {
        const U key[4] = {key_[0].get(), key_[1].get(), hn::Zero(lanesU), hn::Zero(lanesU)};
        const U count = count_.get();
        const U counter[4] = {count, hn::Zero(lanesU), hn::Zero(lanesU), hn::Zero(lanesU)};
        threefry(key, counter, words);
        count_.set(hn::RebindMask(lanesU, where), count + hn::Set(lanesU, 1));
    }

    /// Decides the tentative collisions: see collide() in tracking.cpp.
    HWY_INLINE void decideCollisions() {
        const auto colliding = is(state_.get(), Colliding);
        const std::uint32_t bits = bitsOf(colliding);
        if (!bits) return;
        U words[4];
        draw(colliding, words);
        F f[N];
        lookUp(bits, words, f);
        const F mu = mu_.get(), zero = hn::Zero(lanesF), one = all(1), random = uniform(words[2]);
        auto scatters = colliding;
        if constexpr (N == 1) {
            const F absorbed = absorption_[0].get() * f[0], left = mu - absorbed;
            w_[0].set(colliding, hn::IfThenElseZero(left > zero, w_[0].get() * (one - absorbed / mu)));
            scatters = random * left < scattering_[0].get() * f[0];
        } else {
            F scattering[N], null[N], weight = zero, all_ = zero;
            for (int c = 0; c < N; ++c) {
                scattering[c] = scattering_[c].get() * f[c];
                null[c] = hn::Max(zero, mu - absorption_[c].get() * f[c] - scattering[c]);
                const F both = scattering[c] + null[c], w = w_[c].get() * channelWeight_[c].get();
                weight = weight + hn::IfThenElseZero(both > zero, w * (scattering[c] / both));
                all_ = all_ + w;
            }
            const F p = hn::IfThenElseZero(all_ > zero, weight / all_);
            scatters = random < p;
            const F perSum = one / (mu * hn::IfThenElse(scatters, p, one - p));
            const auto counts = scene_.environmentSeen ? colliding : hn::And(colliding, all(0) < events_.get());
            for (int c = 0; c < N; ++c) {
                const F before = w_[c].get();
                const F after = before * hn::IfThenElse(scatters, scattering[c], null[c]) * perSum;
                const F expected = before * (one - absorption_[c].get() * f[c] / mu);
                chance_[c].set(counts, chance_[c].get() + beta_[c].get() * (after - expected));
                w_[c].set(colliding, after);
            }
        }
        F most = w_[0].get();
        for (int c = 1; c < N; ++c) most = hn::Max(most, w_[c].get());
        const auto alive = most > zero;
        const auto nulls = hn::AndNot(scatters, hn::And(colliding, alive));
        if (traced_.options.stoppedLight)
            forEachLane(bits, [&](std::size_t i) { note(i, bitsOf(hn::AndNot(nulls, colliding)) >> i & 1); });
        depth_.set(nulls, drawDepth(words[3]));
        state_.set(hn::RebindMask(lanesI, nulls), hn::Set(lanesI, Walking));
        state_.set(hn::RebindMask(lanesI, hn::And(colliding, hn::And(scatters, alive))),
                   hn::Set(lanesI, Arrived));
        if (several_)
            forEachLane(bitsOf(nulls), [&](std::size_t i) {
                Lane& l = lanes_[i];
                Process& process = l.processes[l.part];
                process.depth = depth_[i], process.waits = false;
                l.part = none;
                findNearest(i);
            });
        forEachLane(bitsOf(hn::AndNot(alive, colliding)), [&](std::size_t i) { end(i, true); });
    }

    /// The field's values at the lanes' positions, by one-tap interpolation.
    HWY_INLINE void lookUp(std::uint32_t bits, const U words[4], F f[N]) {
        // 21 bits for each axis of two words, as Field::stochasticVoxel() has them.
        const U parts[3] = {
            hn::ShiftRight<11>(words[0]), hn::ShiftRight<11>(words[1]),
            hn::Or(hn::ShiftLeft<10>(hn::And(words[0], hn::Set(lanesU, 0x7ffu))),
                   hn::And(words[1], hn::Set(lanesU, 0x3ffu)))};
        Row<std::int32_t> voxel[3];
        for (int i = 0; i < 3; ++i) {
            const F jitter = hn::ConvertTo(lanesF, hn::BitCast(lanesI, parts[i])) * jitterUnit_.get() + firstJitter_.get();
            voxel[i].set(corner_[i].get() + hn::ConvertTo(lanesI, u_[i].get() + jitter));
        }
        Floats values[N];
        for (int c = 0; c < N; ++c) values[c].set(upper_.get());
        forEachLane(bits, [&](std::size_t i) {
            if (lower_[i] == upper_[i]) return;
            const grid::Field& field = *scene_.parts[lanes_[i].part].part->field();
            const Vec3i v{voxel[0][i], voxel[1][i], voxel[2][i]};
            if (N == 1 || field.channels() == 1) {
                const float value = field.voxel(v);
                for (int c = 0; c < N; ++c) values[c][i] = value;
            } else {
                for (int c = 0; c < N; ++c) values[c][i] = field.voxel(v, c);
            }
        });
        for (int c = 0; c < N; ++c) f[c] = values[c].get();
    }

    void note(std::size_t lane, bool ends) {
        auto* noted = collisions(lane);
        if (!noted) return;
        float left = 0;
        for (int c = 0; c < N && !ends; ++c) left += w_[c][lane] / N;
        noted->push_back({double{t_[lane]}, static_cast<int>(lanes_[lane].part), left});
    }

    // ---- scattering

    void handleEvents() {
        if (const std::uint32_t arrived = bitsOf(is(state_.get(), Arrived))) arrive(arrived);
        const auto departing = is(state_.get(), Departing);
        if (bitsOf(departing)) depart(departing);
    }

    /// These paths have scattered: samples the lights there, and decides how they go on.
    void arrive(std::uint32_t arrived) {
        std::uint32_t lit = 0;
        forEachLane(arrived, [&](std::size_t i) { lit |= std::uint32_t{mayGoOn(i)} << i; });
        Floats depth;
        depth.set(hn::Zero(lanesF));
        if (scene_.sunDepth) {
            depth.set(addSunlight(lit));
        } else if (traced_.needs.lightSampling) {
            forEachLane(lit, [&](std::size_t i) {
                takeThroughput(i, pathOf(i));
                if (lanes_[i].probe)
                    render::addSunlight(traced_, batch_, lanes_[i].path, numbers_[i]);
                else
                    addNextEvent(traced_, batch_, lanes_[i].path, numbers_[i], FlightShare());
            });
        }
        forEachLane(lit, [&](std::size_t i) {
            if (lanes_[i].probe)
                endProbe(i);
            else
                goOn(i, depth[i]);
        });
    }

    /// False: the path ends here.
    bool mayGoOn(std::size_t lane) {
        Lane& l = lanes_[lane];
        PathState<N, false>& p = pathOf(lane);
        if (!l.probe) {
            if (seen(p)) endCameraFlight(lane, true);
            if (!traced_.mayScatter(p.scatterings)) {
                endBranch(lane);
                return false;
            }
            if (several_) l.position = positionOf(lane);
        }
        ++batch_.counters.scatterings;
        const bool sampledWell = !l.probe && p.scatterings < quasiRandomOrders;
        EventNumbers& u = numbers_[lane];
        if (sampledWell)
            u = drawNumbers(p);
        else if (!scene_.delta)
            u = drawNumbersLate(p);
        if (!scene_.delta)
            p.from = {positionOf(lane), directionOf(lane), &partOf(lane).phase(), p.time};
        return true;
    }

    const medium::MediumPart& partOf(std::size_t lane) {
        return *scene_.parts[lanes_[lane].part].part;
    }
    Vec3d positionOf(std::size_t lane) {
        return partOf(lane).description().worldFromIndex.point(
            {double{u_[0][lane]} + corner_[0][lane], double{u_[1][lane]} + corner_[1][lane],
             double{u_[2][lane]} + corner_[2][lane]});
    }

    /// Has a path that has scattered draw its next direction and flight.
    void goOn(std::size_t lane, float depth) {
        PathState<N, false>& p = pathOf(lane);
        lanes_[lane].quasiRandom = lanes_[lane].first && p.scatterings < quasiRandomOrders;
        ++p.scatterings;
        events_[lane] = 1;
        if (p.scatterings >= firstOrderRoulette) {
            takeThroughput(lane, p);
            if (!surviveOrder(p, false)) {
                endBranch(lane);
                return;
            }
            for (int c = 0; c < N; ++c) w_[c][lane] = p.throughput[c];
        }
        static const float ws = getenv("WS") ? float(atof(getenv("WS"))) : 0, we = getenv("WE") ? float(atof(getenv("WE"))) : .7f;
        if (ws > 0 && scene_.sunDepth && !keepWindow(lane, ws * std::pow(1 + depth / 4, we))) {
            endBranch(lane);
            return;
        }
        share_[lane] = 1;
        setState(lane, Departing);
    }

    /// Splits a path whose weight is above the window around `target`, or plays Russian roulette
    /// where it is below. False: it ends.
    bool keepWindow(std::size_t lane, float target) {
        constexpr float above = 1.6f, below = 0.6f;
        constexpr int most = 8;
        float weight = 0;
        for (int c = 0; c < N; ++c) weight = std::max(weight, w_[c][lane]);
        PathState<N, false>& p = pathOf(lane);
        Lane& l = lanes_[lane];
        float factor = 1;
        int copies = 1;
        if (weight > above * target) {
            copies = std::min(most, static_cast<int>(weight / target + 0.5f));
            factor = 1 / static_cast<float>(copies);
        } else if (weight < below * target) {
            const bool dies = static_cast<float>(p.random.uniform()) * target >= weight;
            factor = dies ? 0 : target / weight;
            for (int c = 0; c < N; ++c) window_[c][lane] += w_[c][lane] * (factor - 1) * beta_[c][lane] / (1 + kappa_[c][lane] * sunDepths_[c][lane]);
            if (dies) return false;
        } else {
            return true;
        }
        for (int c = 0; c < N; ++c) w_[c][lane] *= factor, predicted_[c][lane] *= factor;
        branchShare_[lane] *= factor;
        if (copies == 1) return true;
        Branch& b = l.branches.emplace_back();
        take(lane, b.vertex);
        b.part = l.part, b.scatterings = p.scatterings, b.share = branchShare_[lane], b.copies = copies - 1;
        for (std::size_t i = 0; i < 3; ++i) b.direction[i] = v_[i][lane];
        b.throughput = Spectrum<N>::map([&](int c) { return w_[c][lane]; });
        b.predicted = Spectrum<N>::map([&](int c) { return predicted_[c][lane]; });
        return true;
    }

    /// A branch of the path has ended: follows the next one, or gives the lane another path.
    void endBranch(std::size_t lane) {
        Lane& l = lanes_[lane];
        PathState<N, false>& p = pathOf(lane);
        l.events += branchShare_[lane] * static_cast<float>(p.scatterings);
        if (l.branches.empty()) {
            p.alive = false;
            settleControls(lane);
            load(lane);
            return;
        }
        Branch& b = l.branches.back();
        put(lane, b.part, b.vertex);
        for (std::size_t i = 0; i < 3; ++i) v_[i][lane] = b.direction[i];
        for (int c = 0; c < N; ++c) w_[c][lane] = b.throughput[c], predicted_[c][lane] = b.predicted[c];
        branchShare_[lane] = b.share, share_[lane] = 1;
        p.scatterings = b.scatterings, p.alive = true;
        l.first = l.quasiRandom = false;
        if (several_) l.position = positionOf(lane);
        if (--b.copies == 0) l.branches.pop_back();
        setState(lane, Departing);
    }

    // ---- the sun

    /// Optical depths of a lane's position to the sun: interpolated, and the extremes around it.
    struct SunDepths {
        F depth[N], least[N], most[N];
    };

    SunDepths readSunDepths(std::uint32_t bits) {
        const medium::DepthGrid& grid = *scene_.sunDepth;
        F at[3], cell[3];
        for (int i = 0; i < 3; ++i)
            at[i] = hn::ConvertTo(lanesF, corner_[i].get() - low_[i].get()) + u_[i].get();
        Row<std::int32_t> first[3];
        for (int i = 0; i < 3; ++i) {
            const F most = all(static_cast<float>(grid.cells()[i]));
            const F x = hn::Max(hn::Zero(lanesF),
                                hn::Min(most, at[0] * lattice_[i][0].get() + at[1] * lattice_[i][1].get() +
                                                  at[2] * lattice_[i][2].get() + lattice_[i][3].get()));
            const I whole = hn::Min(hn::ConvertTo(lanesI, x), hn::Set(lanesI, grid.cells()[i] - 1));
            first[i].set(whole);
            cell[i] = x - hn::ConvertTo(lanesF, whole);
        }
        SunDepths depths;
        const auto [alongU, alongV, alongW] = grid.strides();
        const int channels = grid.channels();
        for (int c = 0; c < (channels == 1 ? 1 : N); ++c) {
            Floats near[4], far[4];
            forEachLane(bits, [&](std::size_t i) {
                const float* n = grid.nodes(first[0][i], first[1][i], first[2][i]) + c;
                far[0][i] = n[0], near[0][i] = n[alongW];
                far[1][i] = n[alongU], near[1][i] = n[alongU + alongW];
                far[2][i] = n[alongV], near[2][i] = n[alongV + alongW];
                far[3][i] = n[alongU + alongV], near[3][i] = n[alongU + alongV + alongW];
            });
            F line[4];
            for (int k = 0; k < 4; ++k)
                line[k] = far[k].get() + cell[2] * (near[k].get() - far[k].get());
            const F low = line[0] + cell[0] * (line[1] - line[0]);
            const F high = line[2] + cell[0] * (line[3] - line[2]);
            depths.depth[c] = low + cell[1] * (high - low);
            // Depths fall towards the sun.
            depths.least[c] = hn::Min(hn::Min(near[0].get(), near[1].get()),
                                      hn::Min(near[2].get(), near[3].get()));
            depths.most[c] = hn::Max(hn::Max(far[0].get(), far[1].get()),
                                     hn::Max(far[2].get(), far[3].get()));
        }
        if (channels == 1)
            for (int c = N - 1; c >= 0; --c) {
                const F colour = all(grid.colour()[c]);
                depths.depth[c] = depths.depth[0] * colour, depths.least[c] = depths.least[0] * colour;
                depths.most[c] = depths.most[0] * colour;
            }
        return depths;
    }

    /// The phase function towards a delta sun, where it is Henyey-Greenstein's.
    F phaseTowardsSun(F g) {
        const Vec3d sun = sunSample_.direction;
        const F x = all(static_cast<float>(sun.x)), y = all(static_cast<float>(sun.y)), z = all(static_cast<float>(sun.z));
        const F one = all(1);
        const V3 minus = {v_[0].get() - x, v_[1].get() - y, v_[2].get() - z};
        const V3 plus = {v_[0].get() + x, v_[1].get() + y, v_[2].get() + z};
        // 2 (1 - cosine) and 2 (1 + cosine), without cancellation.
        const F denominator = hn::IfThenElse(g >= hn::Zero(lanesF), (one - g) * (one - g) + g * dot(minus, minus),
                                             (one + g) * (one + g) - g * dot(plus, plus));
        return (one - g) * (one + g) / (all(12.5663706f) * denominator * hn::Sqrt(denominator));
    }

    /// Next-event estimation of the sun, by correctedTransmittance().
    F addSunlight(std::uint32_t lit) {
        const SunDepths depths = readSunDepths(lit);
        F least = depths.least[0], depth = depths.depth[0];
        for (int c = 1; c < N; ++c)
            least = hn::Min(least, depths.least[c]), depth = hn::Min(depth, depths.depth[c]);
        const auto deep = least > all(deepest);
        const std::uint32_t shallow = lit & ~bitsOf(deep);
        // What a next event brings, times the phase function, where nothing is in its way.
        Floats light;
        if (scene_.delta) light.set(phaseTowardsSun(g_.get()) * all(sunSample_.weight.maximum()) * share_.get());
        forEachLane(shallow, [&](std::size_t i) {
            if (!scene_.delta || !scene_.parts[lanes_[i].part].henyeyGreenstein)
                light[i] = sampleSun(i).maximum();
        });
        F passes[N], probability = all(medium::rarestCorrection);
        for (int c = 0; c < N; ++c) {
            passes[c] = hn::IfThenZeroElse(deep, decay(depths.depth[c]));
            const F unsure = decay(depths.least[c]) * hn::Min(all(0.5f), all(0.5f) * (depths.most[c] - depths.least[c]));
            const F weight = w_[c].get() * light.get() * all(1 / traced_.typicalRadiance);
            probability = hn::Max(probability, hn::IfThenZeroElse(deep, weight * unsure));
        }
        predictNextEvent(lit, depths);
        for (int c = 0; c < N; ++c) sunDepths_[c].set(depths.depth[c]);
        U words[4];
        draw(maskOf(lit), words);
        const std::uint32_t corrected = lit & bitsOf(uniform(words[0]) < probability);
        Floats through[N], chance;
        for (int c = 0; c < N; ++c) through[c].set(passes[c]);
        chance.set(hn::Min(all(1), probability));
        batch_.counters.shadowRays += static_cast<unsigned>(std::popcount(lit));
        forEachLane(shallow | corrected, [&](std::size_t i) {
            PathState<N, false>& p = pathOf(i);
            const bool whole = scene_.delta && scene_.parts[lanes_[i].part].henyeyGreenstein;
            Rgb arrives = whole ? sunSample_.weight * (light[i] / sunSample_.weight.maximum())
                          : shallow >> i & 1 ? sunLight_[i]
                                             : sampleSun(i);
            if (!(arrives.maximum() > 0)) return;
            Spectrum<N> t = Spectrum<N>::map([&](int c) { return through[c][i]; });
            if (corrected >> i & 1) {
                medium::TrackingCounters counters;
                const Spectrum<N> exact = medium::exactTransmittance<N>(
                    traced_.scene.medium, positionOf(i), sunDirection(i), counters);
                batch_.counters.shadowSegments += counters.segments;
                t = t + (exact - t) * (1 / chance[i]);
            }
            const Spectrum<N> w = Spectrum<N>::map([&](int c) { return w_[c][i]; });
            bring(batch_, p, arrives * toRgb(w * t), kindOfLight(p, 1), traced_.scene.lights.group(scene_.sun));
        });
        return depth;
    }

    /// A control variate on the direction in which a path goes on.
    void predictNextEvent(std::uint32_t lit, const SunDepths& depths) {
        std::uint32_t bits = 0;
        forEachLane(lit, [&](std::size_t i) {
            if (lanes_[i].probe) return;
            const bool may = traced_.mayScatter(pathOf(i).scatterings + 1) && scene_.parts[lanes_[i].part].henyeyGreenstein;
            bits |= std::uint32_t{may} << i;
        });
        const auto main = maskOf(bits);
        const F phase = phaseTowardsSun(g_.get() * g_.get()), zero = hn::Zero(lanesF);
        static const float lambda = getenv("LA") ? float(atof(getenv("LA"))) : 1;
        for (int c = 0; c < N; ++c) {
            const F depth = depths.depth[c];
            const F expected = w_[c].get() * albedo_[c].get() * depth * decay(depth) * all(lambda);
            const auto near = hn::And(main, depth < all(8));
            predicted_[c].set(main, hn::IfThenElse(near, expected, zero));
            control_[c].set(near, control_[c].get() + expected * phase);
        }
    }

    Vec3d sunDirection(std::size_t lane) {
        return scene_.delta ? sunSample_.direction : sunDirections_[lane];
    }

    /// The sun's light at a lane, times its phase function and the weight of multiple importance
    /// sampling.
    Rgb sampleSun(std::size_t lane) {
        const std::array<double, 2> u = numbers_[lane].light;
        const light::LightSample s = scene_.delta ? sunSample_ : traced_.scene.lights.sample(
            scene_.sun, {}, u[0], u[1]);
        const medium::PhaseFunction& phase = partOf(lane).phase();
        const double cosine = dot(directionOf(lane), s.direction);
        Rgb light = s.weight;
        double density = phase.value(cosine);
        if constexpr (N == 3)
            if (phase.chromatic()) {
                const auto mixed = phase.mixed(cosine, Rgb::map([&](int c) { return w_[c][lane]; }));
                light = light * mixed.weight, density = mixed.density;
            }
        double weight = density;
        if (s.pdf > 0) weight *= powerHeuristic(s.pdf, density);
        sunDirections_[lane] = s.direction;
        return sunLight_[lane] = light * (static_cast<float>(weight) * share_[lane]);
    }

    /// A number in [0, 1), also as a float.
    static float belowOne(double u) { return std::min(static_cast<float>(u), 0x1.fffffep-1f); }

    static EventNumbers drawNumbersLate(PathState<N, false>& p) {
        EventNumbers u{};
        u.light = {p.random.uniform(), p.random.uniform()}, u.pick = p.random.uniform();
        return u;
    }

    /// A path has turned into a direction from which much sunlight may come: follows that direction
    /// several times for the light at the end of each flight, the path's own flight last. Their first
    /// optical depths are stratified.
    void fly(std::size_t lane, int more, float depth) {
        Lane& l = lanes_[lane];
        share_[lane] = 1.0f / static_cast<float>(more + 1);
        l.ownDepth = depth, l.flights = more + 1, l.probesLeft = more, l.probe = true;
        l.ownStratum = std::min(more, static_cast<int>(std::exp(-depth) * static_cast<float>(l.flights)));
        take(lane, l.vertex);
        l.vertexPart = l.part;
        for (std::size_t i = 0; i < 3; ++i) l.direction[i] = v_[i][lane];
        l.throughput = Spectrum<N>::map([&](int c) { return w_[c][lane]; });
        l.chance = Spectrum<N>::map([&](int c) { return chance_[c][lane]; });
        nextProbe(lane);
    }

    void nextProbe(std::size_t lane) {
        Lane& l = lanes_[lane];
        for (; l.probesLeft > 0; --l.probesLeft) {
            const int stratum = l.probesLeft - (l.probesLeft <= l.ownStratum);
            const double u = (stratum + pathOf(lane).random.uniformOpenLow()) / l.flights;
            if (takeOff(lane, static_cast<float>(-std::log(u)))) return;
        }
        l.probe = false;
        if (!takeOff(lane, l.ownDepth)) end(lane, false);
    }

    /// Begins a flight from where the lane's path turned; false: it leaves the medium at once.
    bool takeOff(std::size_t lane, float depth) {
        if (several_) return begin(lane, lanes_[lane].position, depth);
        depth_[lane] = depth;
        setState(lane, Walking);
        return true;
    }

    /// One of several flights is done: back to where they start.
    void endProbe(std::size_t lane) {
        Lane& l = lanes_[lane];
        put(lane, l.vertexPart, l.vertex);
        for (std::size_t i = 0; i < 3; ++i) v_[i][lane] = l.direction[i];
        for (int c = 0; c < N; ++c) w_[c][lane] = l.throughput[c], chance_[c][lane] = l.chance[c];
        --l.probesLeft;
        nextProbe(lane);
    }

    /// Draws the turns and the next flights.
    template <class M>
    void depart(M departing) {
        U words[4];
        draw(departing, words);
        F u[2] = {uniform(words[0]), uniform(words[1])};
        F depth = drawDepth(words[2]);
        const std::uint32_t bits = bitsOf(departing);
        Floats given[3];
        given[0].set(u[0]), given[1].set(u[1]), given[2].set(depth);
        forEachLane(bits, [&](std::size_t i) {
            const Lane& l = lanes_[i];
            if (!l.quasiRandom) return;
            const EventNumbers& n = numbers_[i];
            given[0][i] = belowOne(n.phase[0]), given[1][i] = belowOne(n.phase[1]);
            given[2][i] = static_cast<float>(-std::log(n.flight));
        });
        const V3 forward = {v_[0].get(), v_[1].get(), v_[2].get()};
        Floats other[4];
        std::uint32_t others = 0;
        forEachLane(bits, [&](std::size_t i) {
            if (scene_.parts[lanes_[i].part].henyeyGreenstein) return;
            others |= 1u << i;
            const medium::PhaseSample s = turnBy(i, given[0][i], given[1][i]);
            for (int k = 0; k < 3; ++k) other[k][i] = static_cast<float>(s.direction[k]);
            other[3][i] = static_cast<float>(s.pdf);
        });
        F density;
        const V3 turned = sampleHenyeyGreenstein(forward, g_.get(), given[0].get(), given[1].get(), density);
        v_[0].set(departing, turned.x), v_[1].set(departing, turned.y), v_[2].set(departing, turned.z);
        density_.set(departing, density);
        forEachLane(others, [&](std::size_t i) {
            for (int k = 0; k < 3; ++k) v_[k][i] = other[k][i];
            density_[i] = other[3][i];
        });
        // Russian roulette.
        F most = w_[0].get();
        for (int c = 1; c < N; ++c) most = hn::Max(most, w_[c].get());
        const F survival = most * all(1 / pathRoulette);
        const auto plays = hn::And(departing, survival < all(1));
        const auto dies = hn::And(plays, uniform(words[3]) >= survival);
        for (int c = 0; c < N; ++c) {
            const F before = w_[c].get(), after = hn::IfThenZeroElse(dies, before / survival);
            chance_[c].set(plays, chance_[c].get() + beta_[c].get() * (after - before));
            w_[c].set(plays, after);
        }
        Floats more;
        more.set(hn::Zero(lanesF));
        if (scene_.sunDepth) {
            const F phase = phaseTowardsSun(g_.get());
            F expected = hn::Zero(lanesF);
            for (int c = 0; c < N; ++c) {
                const F p = predicted_[c].get() * phase;
                control_[c].set(departing, control_[c].get() - p);
                expected = hn::Max(expected, p);
            }
            static const float thr = getenv("THR") ? float(atof(getenv("THR"))) : .1f;
            more.set(hn::IfThenElseZero(departing, hn::Floor(hn::Min(all(4), expected * all(sunSample_.weight.maximum() / (thr * traced_.typicalRadiance))))));
            static bool once = (fprintf(stderr, "typical %g sun %g opt %g\n", traced_.typicalRadiance, sunSample_.weight.maximum(), traced_.media[0].meanExtinction * woodcock::length(traced_.media[0].bounds.size())), true); (void)once;
        }
        const std::uint32_t dead = bitsOf(dies);
        if (!several_) {
            const LanePart& part = scene_.parts.front();
            const F x = v_[0].get(), y = v_[1].get(), z = v_[2].get();
            for (int i = 0; i < 3; ++i) {
                const float* row = part.indexFromWorld[i];
                const F d = x * all(row[0]) + y * all(row[1]) + z * all(row[2]);
                d_[i].set(departing, d);
                inverse_[i].set(departing, all(1) / hn::Max(hn::Abs(d), all(1 / huge)));
            }
            depth_.set(departing, given[2].get());
            t_.set(departing, hn::Zero(lanesF));
            state_.set(hn::RebindMask(lanesI, departing), hn::Set(lanesI, Walking));
        }
        forEachLane(bits, [&](std::size_t i) {
            if (dead >> i & 1) {
                endDead(i);
                return;
            }
            if (more[i] > 0)
                fly(i, static_cast<int>(more[i]), given[2][i]);
            else if (!takeOff(i, given[2][i]))
                end(i, false);
        });
    }

    void endDead(std::size_t lane) {
        endBranch(lane);
    }

    /// Turns by a phase function of another kind.
    medium::PhaseSample turnBy(std::size_t lane, float u0, float u1) {
        PathState<N, false>& p = pathOf(lane);
        takeThroughput(lane, p);
        p.direction = directionOf(lane);
        const medium::PhaseSample s = turn(p, scene_.parts[lanes_[lane].part].part->phase(),
                                           {double{u0}, double{u1}});
        for (int c = 0; c < N; ++c) w_[c][lane] = p.throughput[c];
        return s;
    }

    const LaneScene& scene_;
    const TracedScene& traced_;
    Batch<N, false>& batch_;
    const bool several_;
    std::size_t next_ = 0;
    medium::TrackingCounters counters_;
    std::array<Lane, laneCount> lanes_;
    std::array<bool, laneCount> ready_{};

    Row<std::int32_t> state_{}, corner_[3]{};
    Floats u_[3]{}, d_[3]{}, inverse_[3]{};  // in the cell, and of the ray, in voxels
    Floats size_{}, lower_{}, upper_{}, mu_{}, perMu_{};  // of the cell
    Floats depth_{}, t_{}, limit_{};  // what is left to the next collision; along the flight
    Floats w_[N]{}, v_[3]{}, density_{};
    Floats absorption_[N]{}, scattering_[N]{}, channelWeight_[N]{}, extinction_{}, g_{},
        jitterUnit_{}, firstJitter_{};
    Row<std::int32_t> low_[3]{}, high_[3]{};
    Floats lattice_[3][4]{};  // of the sun, from voxels
    Floats beta_[N]{}, albedo_[N]{}, chance_[N]{}, kappa_[N]{}, sunDepths_[N]{}, window_[N]{}, branchShare_{}, control_[N]{}, predicted_[N]{}, events_{};
    Floats share_{};         // see PathState::sunShare
    light::LightSample sunSample_;  // of a delta sun
    std::array<EventNumbers, laneCount> numbers_{};
    std::array<Rgb, laneCount> sunLight_{};
    std::array<Vec3d, laneCount> sunDirections_{};
    Row<std::uint32_t> key_[2]{}, count_{};

public:
    const medium::TrackingCounters& counters() const { return counters_; }
};

void traceGrey(const LaneScene& scene, Batch<1, false>& batch) {
    LaneTracer<1> tracer(scene, batch);
    tracer.run();
    batch.counters.distanceSegments += tracer.counters().segments;
    batch.counters.distanceCollisions += tracer.counters().collisions;
}
void traceChromatic(const LaneScene& scene, Batch<3, false>& batch) {
    LaneTracer<3> tracer(scene, batch);
    tracer.run();
    batch.counters.distanceSegments += tracer.counters().segments;
    batch.counters.distanceCollisions += tracer.counters().collisions;
}

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace woodcock::render {

HWY_EXPORT(traceGrey);
HWY_EXPORT(traceChromatic);

template <>
void traceLanes(const LaneScene& scene, Batch<1, false>& batch) {
    HWY_DYNAMIC_DISPATCH(traceGrey)(scene, batch);
}
template <>
void traceLanes(const LaneScene& scene, Batch<3, false>& batch) {
    HWY_DYNAMIC_DISPATCH(traceChromatic)(scene, batch);
}

}  // namespace woodcock::render
#endif
