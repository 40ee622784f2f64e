// SPDX-License-Identifier: Apache-2.0
// Compiled once for each set of instructions: see trace_lanes.cpp.
#if defined(WOODCOCK_LANE_WALK) == defined(HWY_TARGET_TOGGLE)
#ifdef WOODCOCK_LANE_WALK
#undef WOODCOCK_LANE_WALK
#else
#define WOODCOCK_LANE_WALK
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "woodcock/render/lanes/lane_tracer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace woodcock::render::HWY_NAMESPACE {

/// Begins a flight at a point of the world, in the lane's direction, with this optical depth to the
/// first part's first collision. False: it meets nothing.
template <int N>
bool LaneTracer<N>::begin(std::size_t lane, Vec3d origin, float depth) {
    const Vec3d direction = directionOf(lane);
    Lane& l = lanes_[lane];
    l.processes.resize(scene_.partCount);
    for (std::size_t k = 0; k < scene_.partCount; ++k) {
        if (k > 0) depth = static_cast<float>(-std::log(pathOf(lane).random.uniformOpenLow()));
        enter(scene_.parts[numberOf(lane, k)], origin, direction, depth, l.processes[k]);
    }
    // Distances are from where the first part begins: floats would not tell them apart from afar.
    l.flightStart = std::numeric_limits<double>::infinity();
    for (const Process& p : l.processes)
        if (!p.ended) l.flightStart = std::min(l.flightStart, p.entry);
    for (Process& p : l.processes) p.t = static_cast<float>(p.entry - l.flightStart);
    l.part = none;
    return findNearest(lane);
}

/// Puts a part's process to where a ray enters its support.
template <int N>
void LaneTracer<N>::enter(const LanePart& lanePart, Vec3d origin, Vec3d direction, float depth,
                          Process& process) {
    const medium::MediumPart& part = *lanePart.part;
    const grid::IndexRay ray = part.indexRay(origin, direction);
    double t0 = 0, t1 = std::numeric_limits<double>::infinity();
    process.waits = false;
    process.ended = !grid::clip(ray, part.support(), t0, t1);
    if (process.ended) return;
    const Vec3d at = min(part.support().upper, max(part.support().lower, ray.at(t0)));
    Vec3i voxel;
    for (int i = 0; i < 3; ++i)
        voxel[i] = std::clamp(floorToInt(at[i]), lanePart.low[i], lanePart.high[i]);
    const grid::MajorantGrid::Cell cell = part.majorants().find(voxel);
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
    process.mu = cell.range.max * part.largestExtinction();
    process.perMu = process.mu > 0 ? 1 / process.mu : huge;
    process.depth = depth, process.entry = t0;
}

template <int N>
void LaneTracer<N>::put(std::size_t lane, const Process& p) {
    for (std::size_t i = 0; i < 3; ++i) {
        u_[i][lane] = p.u[i], d_[i][lane] = p.d[i], inverse_[i][lane] = p.inverse[i];
        corner_[i][lane] = p.corner[i];
    }
    size_[lane] = p.size, mu_[lane] = p.mu, perMu_[lane] = p.perMu, depth_[lane] = p.depth;
    t_[lane] = p.t, lower_[lane] = p.lower, upper_[lane] = p.upper;
    load(lane, numberOf(lane, lanes_[lane].part));
}

/// The part that walks is the one that collides, and may scatter.
template <int N>
void LaneTracer<N>::scatterIn(std::size_t lane) {
    const std::size_t number = numberOf(lane, lanes_[lane].part);
    loadMatter(lane, number);
    lanes_[lane].phase = number, g_[lane] = scene_.parts[number].g;
}

/// Loads what the walk needs of a part: its number in LaneScene.
template <int N>
void LaneTracer<N>::load(std::size_t lane, std::size_t number) {
    const LanePart& part = scene_.parts[number];
    for (int i = 0; i < 3; ++i) low_[i][lane] = part.low[i], high_[i][lane] = part.high[i];
    extinction_[lane] = part.part->largestExtinction();
}

/// Loads what collisions and scatterings need of a part.
template <int N>
void LaneTracer<N>::loadMatter(std::size_t lane, std::size_t number) {
    if (lanes_[lane].matter == number) return;
    lanes_[lane].matter = number;
    const LanePart& part = scene_.parts[number];
    const medium::MediumPart& medium = *part.part;
    setLane(absorption_, lane, channels<N>(medium.absorption()));
    setLane(scattering_, lane, channels<N>(medium.scattering()));
    setLane(channelWeight_, lane, channels<N>(medium.channelWeight()));
    setLane(albedo_, lane, channels<N>(part.albedo));
    const bool nearest = medium.field()->lookup() == grid::Lookup::Nearest;
    jitterUnit_[lane] = nearest ? 0 : 0x1p-21f, firstJitter_[lane] = nearest ? 0.5f : 0x1p-22f;
    if (scene_.radiance) {
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 4; ++k) cells_[i][k][lane] = part.cellsFromIndex[i][k];
    } else {
        setLane(expected_, lane, Spectrum<N>(1.0f));
    }
    const medium::DepthGrid* grid = scene_.sunDepths[lanes_[lane].set];
    if (!grid) return;
    setLane(sunColour_, lane,
            grid->channels() == 1 ? channels<N>(grid->colour()) : Spectrum<N>(1.0f));
    for (std::size_t i = 0; i < 2; ++i)
        perspective_[i][lane] = static_cast<float>(grid->perspective()[i]);
    beside_[lane] = (grid->blur() - 1) / 2;
    for (int i = 0; i < 3; ++i) {
        latticeCells_[i][lane] = grid->cells()[i];
        for (int k = 0; k < 4; ++k) lattice_[i][k][lane] = part.latticeFromIndex[i][k];
    }
}

template <int N>
void LaneTracer<N>::take(std::size_t lane, Process& p) {
    for (std::size_t i = 0; i < 3; ++i) {
        p.u[i] = u_[i][lane], p.d[i] = d_[i][lane], p.inverse[i] = inverse_[i][lane];
        p.corner[i] = corner_[i][lane];
    }
    p.size = size_[lane], p.mu = mu_[lane], p.perMu = perMu_[lane], p.depth = depth_[lane];
    p.t = t_[lane], p.lower = lower_[lane], p.upper = upper_[lane];
}

/// Goes on with the part behind Lane::part, of which `none` is before the first: one that may have
/// a collision before the nearest so far. Where there is no such part any more, the nearest
/// collision is the one that happens; see trackParts() in tracking.cpp. False: there is none.
template <int N>
bool LaneTracer<N>::findNearest(std::size_t lane) {
    Lane& l = lanes_[lane];
    if (l.part == none) l.nearest = none, limit_[lane] = huge;
    for (std::size_t k = l.part + 1; k < l.processes.size(); ++k) {
        const Process& process = l.processes[k];
        if (process.ended) continue;
        if (process.waits) {
            if (process.t < limit_[lane]) limit_[lane] = process.t, l.nearest = k;
            continue;
        }
        l.part = k;
        put(lane, process);
        if (!several_) scatterIn(lane);
        state_[lane] = Walking;
        return true;
    }
    if (l.nearest == none) {
        l.part = 0;
        return false;
    }
    l.part = l.nearest;
    put(lane, l.processes[l.part]);
    scatterIn(lane);
    state_[lane] = Colliding;
    return true;
}

template <int N>
void LaneTracer<N>::goOnWithNextPart(std::size_t lane) {
    if (!findNearest(lane)) end(lane, false);
}

/// Lanes that walk go on to the next face of their cell, or to a tentative collision.
template <int N>
HWY_INLINE void LaneTracer<N>::step(Mask walking) {
    const F size = size_.get(), zero = hn::Zero(lanesF);
    F face[3];
    for (int i = 0; i < 3; ++i) {
        const F u = u_[i].get();
        face[i] = hn::IfThenElse(d_[i].get() >= zero, size - u, u) * inverse_[i].get();
    }
    const F toFace = hn::Min(face[0], hn::Min(face[1], face[2]));
    // Nothing collides in empty cells, not even where no depth is left.
    const F toCollision = hn::IfThenElse(mu_.get() > zero, depth_.get() * perMu_.get(), all(huge));
    const F toLimit = limit_.get() - t_.get();
    const F length = hn::Max(zero, hn::Min(toFace, hn::Min(toCollision, toLimit)));
    const Mask collides = hn::And(walking, hn::And(toCollision < toFace, toCollision < toLimit));
    const Mask pauses = hn::AndNot(collides, hn::And(walking, toLimit <= toFace));
    for (int i = 0; i < 3; ++i)
        u_[i].set(walking, hn::Max(zero, hn::Min(size, u_[i].get() + d_[i].get() * length)));
    t_.set(walking, t_.get() + length);
    depth_.set(walking, hn::Max(zero, depth_.get() - length * mu_.get()));
    const std::uint32_t colliding = bitsOf(collides), pausing = bitsOf(pauses);
    counters_.collisions += static_cast<unsigned>(std::popcount(colliding));
    const Mask alongX = face[0] == toFace, alongY = hn::AndNot(alongX, face[1] == toFace);
    const Mask along[3] = {alongX, alongY, hn::Not(hn::Or(alongX, alongY))};
    if (!several_) {
        state_.set(ofInts(collides), hn::Set(lanesI, Colliding));
        cross(hn::AndNot(collides, walking), along);
        return;
    }
    cross(hn::AndNot(hn::Or(collides, pauses), walking), along);
    forEachLane(colliding | pausing, [&](std::size_t i) {
        Lane& l = lanes_[i];
        Process& process = l.processes[l.part];
        take(i, process);
        if (colliding >> i & 1) process.waits = true, l.nearest = l.part, limit_[i] = process.t;
        goOnWithNextPart(i);
    });
}

/// Lanes that have come to a face ahead enter the next cell, or leave the part's support. `along`:
/// whether that face lies across each axis. The next cell is chosen in integers, as CellWalk does
/// it, so no step can stall.
template <int N>
HWY_INLINE void LaneTracer<N>::cross(Mask crossing, const Mask along[3]) {
    const I zero = hn::Zero(lanesI), one = hn::Set(lanesI, 1);
    const I width = hn::ConvertTo(lanesI, size_.get());
    Ints voxel[3], faceAhead[3];
    I room = one;  // negative outside
    for (int i = 0; i < 3; ++i) {
        const I corner = corner_[i].get(), low = low_[i].get();
        const MaskI forward = ofInts(d_[i].get() >= hn::Zero(lanesF));
        const I face = corner + hn::IfThenElse(forward, width, zero);
        const I beyond = face - hn::IfThenElse(forward, zero, one);
        const I within =
            hn::Max(low, corner + hn::Min(hn::ConvertTo(lanesI, u_[i].get()), width - one));
        const I next = hn::IfThenElse(ofInts(along[i]), beyond, within);
        room = hn::Min(room, hn::Min(next - low, high_[i].get() - next));
        voxel[i].set(next), faceAhead[i].set(face);
    }
    const Mask leaves = hn::And(crossing, hn::RebindMask(lanesF, room < zero));
    const Mask enters = hn::AndNot(leaves, crossing);
    const std::uint32_t entering = bitsOf(enters);
    counters_.segments += static_cast<unsigned>(std::popcount(entering));
    Ints size;
    size.set(one);
    forEachLane(entering, [&](std::size_t i) {
        const grid::MajorantGrid::Cell cell =
            partOf(i).part->majorants().find({voxel[0][i], voxel[1][i], voxel[2][i]});
        size[i] = 1 << std::min(cell.log2Size, widestLog2);
        lower_[i] = cell.range.min, upper_[i] = cell.range.max;
    });
    const F edge = hn::ConvertTo(lanesF, size.get()), nothing = hn::Zero(lanesF);
    for (int i = 0; i < 3; ++i) {
        const I corner = hn::And(voxel[i].get(), zero - size.get());
        const F moved = hn::ConvertTo(lanesF, corner_[i].get() - corner) + u_[i].get();
        const F face = hn::ConvertTo(lanesF, faceAhead[i].get() - corner);
        u_[i].set(enters, hn::IfThenElse(along[i], face, hn::Max(nothing, hn::Min(edge, moved))));
        corner_[i].set(ofInts(enters), corner);
    }
    size_.set(enters, edge);
    const F mu = upper_.get() * extinction_.get();
    mu_.set(enters, mu);
    perMu_.set(enters, hn::IfThenElse(mu > nothing, all(1) / mu, all(huge)));
    forEachLane(bitsOf(leaves), [&](std::size_t i) {
        lanes_[i].processes[lanes_[i].part].ended = true;
        goOnWithNextPart(i);
    });
}

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
