// SPDX-License-Identifier: Apache-2.0
#include "woodcock/mesh/triangle_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "woodcock/base/random.h"

namespace woodcock::mesh {

namespace {

struct HashOfPoint {
    std::size_t operator()(const Vec3f& p) const {
        // Zeros of either sign are equal, so they must have one hash.
        const auto bits = [](float v) {
            return std::uint64_t{std::bit_cast<std::uint32_t>(v + 0.0f)};
        };
        return mixBits(mixBits(bits(p.x) << 32 | bits(p.y)) ^ bits(p.z));
    }
};

}  // namespace

OpenEdges findOpenEdges(const TriangleMesh& mesh) {
    using Edge = std::pair<std::uint32_t, std::uint32_t>;
    std::vector<Edge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const auto& corner : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            edges.push_back(std::minmax({corner[i], corner[(i + 1) % 3]}));
    std::sort(edges.begin(), edges.end());
    OpenEdges open;
    for (auto edge = edges.begin(); edge != edges.end();) {
        const auto next =
            std::find_if(edge, edges.end(), [&](const Edge& e) { return e != *edge; });
        if (next - edge == 1 && open.count++ == 0)
            open.first = (mesh.points[edge->first] + mesh.points[edge->second]) * 0.5f;
        edge = next;
    }
    return open;
}

TriangleMesh weld(const TriangleMesh& mesh) {
    TriangleMesh welded{{}, {}, mesh.origin};
    std::unordered_map<Vec3f, std::uint32_t, HashOfPoint> indexOf;
    indexOf.reserve(mesh.points.size());
    const auto index = [&](const Vec3f& p) {
        const auto [found, isNew] =
            indexOf.try_emplace(p, static_cast<std::uint32_t>(welded.points.size()));
        if (isNew) welded.points.push_back(p);
        return found->second;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3f &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c];
        if (p == q || q == r || r == p) continue;
        const std::uint32_t i = index(p), j = index(q), k = index(r);
        welded.triangles.push_back({i, j, k});
    }
    return welded;
}

Box3d boundsOf(const TriangleMesh& mesh) {
    Box3d box;
    for (const Vec3f& p : mesh.points) box.add(p.as<double>());
    return box;
}

Vec3d originFor(const Box3d& bounds) {
    if (bounds.empty()) return {};
    const auto largest = [](Vec3d v) { return std::max({v.x, v.y, v.z}); };
    const double away = largest(max(-bounds.lower, bounds.upper)), extent = largest(bounds.size());
    constexpr double mostTimes = 16;  // floats then move points by 1e-6 of the extent
    if (!(away > mostTimes * extent) || !std::isfinite(away)) return {};
    // A short number, so that taking it off costs no digit: a power of two's multiple.
    const double unit = std::exp2(std::ceil(std::log2(std::max(extent, away * 1e-9))));
    const Vec3d middle = bounds.centre() / unit;
    return Vec3d{std::round(middle.x), std::round(middle.y), std::round(middle.z)} * unit;
}

}  // namespace woodcock::mesh
