// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/mesh_inside.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>

namespace woodcock::convert {

namespace {

/// Surfaces closer to each other than this, in voxels, count as one.
constexpr double together = 1e-4;

}  // namespace

/// The parts around a point, each with its winding number.
class MeshInside::Around {
public:
    struct Part {
        std::uint32_t part;
        int winding;
    };
    void add(std::uint32_t part, int winding) {
        const auto at = std::find_if(parts_.begin(), parts_.end(),
                                     [&](const Part& p) { return p.part == part; });
        if (at == parts_.end())
            parts_.push_back({part, winding});
        else if ((at->winding += winding) == 0)
            parts_.erase(at);
    }
    const std::vector<Part>& parts() const { return parts_; }

private:
    std::vector<Part> parts_;
};

MeshInside::MeshInside(const mesh::ClosedMesh& mesh, std::vector<Vec3d> points)
    : mesh_(mesh),
      points_(std::move(points)),
      adds_(mesh.volumes.size(), 1),
      group_(mesh.volumes.size()) {
    std::iota(group_.begin(), group_.end(), 0u);
    makeSlabs();
    if (mesh.volumes.size() > 1) nest();
    findRuns();
}

void MeshInside::makeSlabs() {
    struct Reach {
        int lower, upper;
    };
    const auto& triangles = mesh_.mesh.triangles;
    std::vector<Reach> reaches;
    reaches.reserve(triangles.size());
    for (const auto& [a, b, c] : triangles) {
        const auto [low, high] = std::minmax({points_[a].x, points_[b].x, points_[c].x});
        reaches.push_back({floorToInt(low), floorToInt(high)});
    }
    // Only rows that are reached: parts may lie far apart.
    std::vector<Reach> ordered = reaches;
    std::sort(ordered.begin(), ordered.end(),
              [](const Reach& a, const Reach& b) { return a.lower < b.lower; });
    for (const Reach& reach : ordered)
        for (int x = slabs_.empty() ? reach.lower : std::max(reach.lower, slabs_.back().x + 1);
             x <= reach.upper; ++x)
            slabs_.push_back({x, {}, {}});
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = triangles[t];
        const auto [low, high] = std::minmax({points_[a].y, points_[b].y, points_[c].y});
        const auto first = std::lower_bound(slabs_.begin(), slabs_.end(), reaches[t].lower,
                                            [](const Slab& s, int x) { return s.x < x; });
        for (auto slab = first; slab != slabs_.end() && slab->x <= reaches[t].upper; ++slab)
            slab->entries.push_back({low, high, high, t});
    }
    tbb::parallel_for(std::size_t{0}, slabs_.size(), [&](std::size_t i) {
        std::vector<Entry>& entries = slabs_[i].entries;
        std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
            return std::tie(a.lower, a.triangle) < std::tie(b.lower, b.triangle);
        });
        for (std::size_t n = 1; n < entries.size(); ++n)
            entries[n].highest = std::max(entries[n].upper, entries[n - 1].highest);
    });
}

const MeshInside::Slab* MeshInside::slabAt(int x) const {
    const auto at = std::lower_bound(slabs_.begin(), slabs_.end(), x,
                                     [](const Slab& s, int to) { return s.x < to; });
    return at != slabs_.end() && at->x == x ? &*at : nullptr;
}

// Each edge decides on which side the line is, in the same way for both of its triangles. So a line
// that enters a closed part leaves it again, whatever the rounding.
int MeshInside::windsAround(std::uint32_t triangle, double x, double y, double& z) const {
    const auto& corners = mesh_.mesh.triangles[triangle];
    int winding = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d &from = points_[corners[i]], &to = points_[corners[(i + 1) % 3]];
        const bool upwards = to.y > y;
        if ((from.y > y) == upwards) continue;
        const Vec3d &low = upwards ? from : to, &high = upwards ? to : from;
        if ((high.x - low.x) * (y - low.y) - (high.y - low.y) * (x - low.x) > 0)
            winding += upwards ? 1 : -1;
    }
    if (winding == 0) return 0;
    const Vec3d &a = points_[corners[0]], &b = points_[corners[1]], &c = points_[corners[2]];
    const Vec3d n = cross(b - a, c - a);
    const auto [lowest, highest] = std::minmax({a.z, b.z, c.z});
    z = a.z - ((x - a.x) * n.x + (y - a.y) * n.y) / n.z;
    z = z > lowest ? std::min(z, highest) : lowest;  // nor a NaN of one that stands upright
    return winding;
}

std::vector<MeshInside::Crossing> MeshInside::crossingsOf(const Slab& slab) const {
    std::vector<Crossing> crossings;
    for (const Entry& entry : slab.entries) {
        // Where the triangle crosses the plane of the voxels' centres.
        const auto& corners = mesh_.mesh.triangles[entry.triangle];
        double lower = entry.upper, upper = entry.lower;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3d &a = points_[corners[i]], &b = points_[corners[(i + 1) % 3]];
            if (std::min(a.x, b.x) > slab.x || std::max(a.x, b.x) < slab.x) continue;
            const double t = a.x == b.x ? 0 : (slab.x - a.x) / (b.x - a.x);
            for (const double y : {a.y + t * (b.y - a.y), a.x == b.x ? b.y : a.y + t * (b.y - a.y)})
                lower = std::min(lower, y), upper = std::max(upper, y);
        }
        if (lower > upper) continue;
        for (int y = floorToInt(lower); y <= floorToInt(upper) + 1; ++y) {
            double z = 0;
            if (const int winding = windsAround(entry.triangle, slab.x, y, z); winding != 0)
                crossings.push_back({y, z, entry.triangle, -winding});
        }
    }
    std::sort(crossings.begin(), crossings.end());
    return crossings;
}

/// Calls `visit(before, after, crossings)` for the crossings at each point of a line, from below.
template <class Visit>
void MeshInside::sweep(const Slab& slab, Visit visit) const {
    const std::vector<Crossing> crossings = crossingsOf(slab);
    Around around;
    for (auto at = crossings.begin(); at != crossings.end();) {
        if (at != crossings.begin() && at->y != std::prev(at)->y) around = {};
        const Around before = around;
        auto end = at;
        for (; end != crossings.end() && end->y == at->y && end->z <= at->z + together; ++end)
            around.add(mesh_.partOf[end->triangle], end->into);
        visit(before, around, std::span(at, end));
        at = end;
    }
}

void MeshInside::nest() {
    using Parts = std::vector<std::uint32_t>;
    std::vector<std::optional<Parts>> containers(adds_.size());
    const auto restrict = [&](std::uint32_t part, Parts around) {
        std::sort(around.begin(), around.end());
        around.erase(std::unique(around.begin(), around.end()), around.end());
        std::erase(around, part);
        std::optional<Parts>& known = containers[part];
        if (known)
            std::erase_if(*known, [&](std::uint32_t p) {
                return !std::binary_search(around.begin(), around.end(), p);
            });
        else
            known = std::move(around);
    };
    std::mutex mutex;
    tbb::parallel_for(std::size_t{0}, slabs_.size(), [&](std::size_t i) {
        sweep(slabs_[i], [&](const Around& before, const Around& after, auto crossings) {
            Parts around;
            for (const Around* side : {&before, &after})
                for (const auto& p : side->parts()) around.push_back(p.part);
            const std::lock_guard lock(mutex);
            for (const Crossing& c : crossings) restrict(mesh_.partOf[c.triangle], around);
        });
    });
    for (std::uint32_t t = 0; t < mesh_.partOf.size(); ++t) {  // parts between all lines
        if (containers[mesh_.partOf[t]]) continue;
        const auto& [a, b, c] = mesh_.mesh.triangles[t];
        const Around here = aroundPlace((points_[a] + points_[b] + points_[c]) / 3.0);
        Parts around;
        for (const auto& p : here.parts()) around.push_back(p.part);
        restrict(mesh_.partOf[t], around);
    }
    std::vector<std::uint32_t> order(adds_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return containers[a]->size() < containers[b]->size();
    });
    for (const std::uint32_t part : order) {
        const Parts& around = *containers[part];
        if (around.empty()) continue;
        const auto outermost =
            std::min_element(around.begin(), around.end(), [&](std::uint32_t a, std::uint32_t b) {
                return containers[a]->size() < containers[b]->size();
            });
        group_[part] = group_[*outermost];
        int solid = 0;
        for (const std::uint32_t p : around)
            if (group_[p] == group_[part]) solid += adds_[p];
        if (solid <= 0) continue;
        if ((mesh_.volumes[part] < 0) != (mesh_.volumes[group_[part]] < 0))
            adds_[part] = -1, ++cavities_;
        else
            ++nestedSolids_;
    }
    // Surfaces along z cross no line along z, so parts that may lie inside are checked separately.
    innerSurfaces_ =
        nestedSolids_ > 0 || partsMeet([&](std::uint32_t inner, std::uint32_t outer) {
            return std::binary_search(containers[inner]->begin(), containers[inner]->end(), outer);
        });
}

/// Whether the boxes of two parts meet of which none lies in the other: `nested(a, b)`.
template <class Nested>
bool MeshInside::partsMeet(Nested nested) const {
    std::vector<Box3d> boxes(adds_.size());
    for (std::size_t t = 0; t < mesh_.partOf.size(); ++t)
        for (const std::uint32_t i : mesh_.mesh.triangles[t])
            boxes[mesh_.partOf[t]].add(points_[i]);
    std::vector<std::uint32_t> order(boxes.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return boxes[a].lower.x < boxes[b].lower.x;
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Box3d& a = boxes[order[i]];
        for (std::size_t k = i + 1; k < order.size(); ++k) {
            const Box3d& b = boxes[order[k]];
            if (b.lower.x > a.upper.x + together) break;
            const bool apart = b.lower.y > a.upper.y + together ||
                               a.lower.y > b.upper.y + together ||
                               b.lower.z > a.upper.z + together || a.lower.z > b.upper.z + together;
            if (!apart && !nested(order[i], order[k]) && !nested(order[k], order[i])) return true;
        }
    }
    return false;
}

bool MeshInside::isInside(const Around& around) const {
    for (const auto& one : around.parts()) {
        int sum = 0;
        for (const auto& other : around.parts())
            if (group_[other.part] == group_[one.part]) sum += adds_[other.part];
        if (sum > 0) return true;
    }
    return false;
}

void MeshInside::findRuns() {
    struct Counts {
        std::size_t voxels = 0, pieces = 0, missed = 0;
        bool innerSurfaces = false;
    };
    const Counts counts = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, slabs_.size()), Counts{},
        [&](const auto& range, Counts sum) {
            for (std::size_t i = range.begin(); i != range.end(); ++i) {
                double entered = 0;
                sweep(slabs_[i], [&](const Around& before, const Around& after, auto crossings) {
                    const bool was = isInside(before), is = isInside(after);
                    if (was && is) sum.innerSurfaces = true;
                    const Crossing& here = crossings.front();
                    if (!was && is) entered = here.z;
                    if (!was || is) return;
                    const Run run{here.y, static_cast<int>(std::ceil(entered)),
                                  static_cast<int>(std::floor(here.z))};
                    ++sum.pieces;
                    if (run.lower > run.upper) {
                        ++sum.missed;
                        return;
                    }
                    slabs_[i].runs.push_back(run);
                    sum.voxels += static_cast<std::size_t>(run.upper - run.lower) + 1;
                });
            }
            return sum;
        },
        [](Counts a, const Counts& b) {
            return Counts{a.voxels + b.voxels, a.pieces + b.pieces, a.missed + b.missed,
                          a.innerSurfaces || b.innerSurfaces};
        });
    voxels_ = counts.voxels;
    pieces_ = counts.pieces;
    missed_ = counts.missed;
    innerSurfaces_ |= counts.innerSurfaces;
    for (std::size_t t = 0; t < mesh_.partOf.size(); ++t) {
        const auto& [a, b, c] = mesh_.mesh.triangles[t];
        const std::uint32_t part = mesh_.partOf[t];
        const Vec3d from = points_[mesh_.mesh.triangles[0][0]];
        const double sixth =
            dot(points_[a] - from, cross(points_[b] - from, points_[c] - from)) / 6;
        volume_ += (mesh_.volumes[part] < 0 ? -1 : 1) * adds_[part] * sixth;
    }
}

bool MeshInside::contains(Vec3i voxel) const {
    const Slab* const slab = slabAt(voxel.x);
    if (!slab) return false;
    const auto after = std::upper_bound(
        slab->runs.begin(), slab->runs.end(), voxel,
        [](Vec3i v, const Run& r) { return std::tie(v.y, v.z) < std::tie(r.y, r.lower); });
    if (after == slab->runs.begin()) return false;
    const Run& run = *std::prev(after);
    return run.y == voxel.y && voxel.z <= run.upper;
}

double MeshInside::missedShare() const {
    return pieces_ == 0 ? 0 : static_cast<double>(missed_) / static_cast<double>(pieces_);
}

MeshInside::Around MeshInside::aroundPlace(Vec3d place) const {
    Around around;
    const Slab* const slab = slabAt(floorToInt(place.x));
    if (!slab) return around;
    auto entry = std::upper_bound(slab->entries.begin(), slab->entries.end(), place.y,
                                  [](double y, const Entry& e) { return y < e.lower; });
    while (entry != slab->entries.begin()) {
        --entry;
        if (entry->highest < place.y) break;
        double z = 0;
        if (const int winding = windsAround(entry->triangle, place.x, place.y, z);
            winding != 0 && z < place.z)
            around.add(mesh_.partOf[entry->triangle], -winding);
    }
    return around;
}

bool MeshInside::isBorder(const Corners& p) const {
    const Vec3d n = normalize(cross(p[1] - p[0], p[2] - p[0])) * (10 * together);
    if (!isFinite(n)) return false;
    const Vec3d middle = (p[0] + p[1] + p[2]) / 3.0;
    return isInside(aroundPlace(middle + n)) != isInside(aroundPlace(middle - n));
}

int MeshInside::cut(const Corners& p, std::vector<Corners>& kept) const {
    std::size_t i = 0;
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
        if (const double edge = length(p[(k + 1) % 3] - p[k]); edge > longest)
            longest = edge, i = k;
    const Vec3d half = (p[i] + p[(i + 1) % 3]) * 0.5;
    const Corners a{p[i], half, p[(i + 2) % 3]}, b{half, p[(i + 1) % 3], p[(i + 2) % 3]};
    if (longest <= 0.125) return isBorder(p);
    if (longest <= 1) {  // parts of one kind only
        const bool border = isBorder(p);
        const Vec3d middle = (p[0] + p[1] + p[2]) / 3.0;
        bool same = true;
        for (std::size_t k = 0; k < 3 && same; ++k)
            same = isBorder({p[k], p[k] + (p[(k + 1) % 3] - p[k]) * 0.1,
                             p[k] + (middle - p[k]) * 0.1}) == border;
        if (same) return border;
    }
    const int first = cut(a, kept), second = cut(b, kept);
    if (first == second && first >= 0) return first;
    if (first > 0) kept.push_back(a);
    if (second > 0) kept.push_back(b);
    return -1;
}

std::vector<MeshInside::Corners> MeshInside::border() const {
    const auto& triangles = mesh_.mesh.triangles;
    const auto corners = [&](std::size_t t) {
        return Corners{points_[triangles[t][0]], points_[triangles[t][1]],
                       points_[triangles[t][2]]};
    };
    if (!innerSurfaces_) {
        std::vector<Corners> all;
        for (std::size_t t = 0; t < triangles.size(); ++t) all.push_back(corners(t));
        return all;
    }
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, triangles.size()), std::vector<Corners>{},
        [&](const auto& range, std::vector<Corners> kept) {
            for (std::size_t t = range.begin(); t != range.end(); ++t)
                if (cut(corners(t), kept) > 0) kept.push_back(corners(t));
            return kept;
        },
        [](std::vector<Corners> a, const std::vector<Corners>& b) {
            a.insert(a.end(), b.begin(), b.end());
            return a;
        });
}

}  // namespace woodcock::convert
