// SPDX-License-Identifier: Apache-2.0
#include "woodcock/mesh/surface_mesh.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "woodcock/base/error.h"

namespace woodcock::mesh {

namespace {

std::array<Vec3d, 3> cornersOf(const TriangleMesh& mesh, std::size_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return {mesh.points[a].as<double>(), mesh.points[b].as<double>(), mesh.points[c].as<double>()};
}

/// Of twice the triangle's area.
Vec3d areaNormal(const std::array<Vec3d, 3>& p) { return cross(p[1] - p[0], p[2] - p[0]); }

double angleAt(const std::array<Vec3d, 3>& p, std::size_t i) {
    const Vec3d a = p[(i + 1) % 3] - p[i], b = p[(i + 2) % 3] - p[i];
    return std::atan2(length(cross(a, b)), dot(a, b));
}

/// The triangles at each point, one after the other.
struct Fans {
    std::vector<std::size_t> begins;
    std::vector<std::uint32_t> corners;  ///< 3 triangle + corner

    explicit Fans(const TriangleMesh& mesh) : begins(mesh.points.size() + 1) {
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t p : triangle) ++begins[p + 1];
        for (std::size_t p = 1; p < begins.size(); ++p) begins[p] += begins[p - 1];
        std::vector<std::size_t> next(begins.begin(), begins.end() - 1);
        corners.resize(3 * mesh.triangles.size());
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            for (std::size_t i = 0; i < 3; ++i)
                corners[next[mesh.triangles[t][i]]++] = static_cast<std::uint32_t>(3 * t + i);
    }
    std::span<const std::uint32_t> at(std::uint32_t point) const {
        return std::span(corners).subspan(begins[point], begins[point + 1] - begins[point]);
    }
};

}  // namespace

void smoothNormals(SurfaceMesh& mesh, double angle) {
    const TriangleMesh& m = mesh.mesh;
    std::vector<Vec3d> flat(m.triangles.size());
    std::vector<std::array<double, 3>> weight(m.triangles.size());
    for (std::size_t t = 0; t < m.triangles.size(); ++t) {
        const std::array<Vec3d, 3> p = cornersOf(m, t);
        const Vec3d n = areaNormal(p);
        const double twiceArea = length(n);
        flat[t] = twiceArea > 0 ? n / twiceArea : Vec3d{};
        for (std::size_t i = 0; i < 3; ++i) weight[t][i] = twiceArea * angleAt(p, i);
    }
    const double least = std::cos(std::clamp(angle, 0.0, 180.0) * pi / 180);
    constexpr std::size_t largestFan = 4096;  // the work is the square of it
    const Fans fans(m);
    mesh.normals.resize(m.triangles.size());
    for (std::size_t t = 0; t < m.triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) {
            Vec3d sum;
            const std::span<const std::uint32_t> fan = fans.at(m.triangles[t][i]);
            for (const std::uint32_t corner : fan.size() > largestFan ? fan.first(0) : fan) {
                const std::size_t other = corner / 3;
                if (other == t || dot(flat[t], flat[other]) > least)
                    sum += flat[other] * weight[other][corner % 3];
            }
            const double size = length(sum);
            mesh.normals[t][i] = (size > 0 ? sum / size : flat[t]).as<float>();
        }
}

namespace {

/// An edge, by its points in order, and whether a triangle runs along it in that order.
struct DirectedEdge {
    std::uint32_t low, high;
    bool forwards;
};

/// Faults at edges: everything other than two triangles that run along the edge in opposite
/// directions.
struct EdgeFaults {
    std::size_t open = 0, crowded = 0, inconsistent = 0;
    Vec3d firstOpen, firstCrowded, firstInconsistent;
};

EdgeFaults findEdgeFaults(const TriangleMesh& mesh) {
    std::vector<DirectedEdge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const auto& corner : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = corner[i], b = corner[(i + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), a < b});
        }
    std::sort(edges.begin(), edges.end(), [](const DirectedEdge& a, const DirectedEdge& b) {
        return std::pair(a.low, a.high) < std::pair(b.low, b.high);
    });
    EdgeFaults faults;
    const auto count = [&](std::size_t& faulty, Vec3d& first, const DirectedEdge& e) {
        if (faulty++ == 0)
            first = (mesh.points[e.low].as<double>() + mesh.points[e.high].as<double>()) * 0.5;
    };
    for (auto edge = edges.begin(); edge != edges.end();) {
        std::ptrdiff_t forwards = 0;
        auto next = edge;
        for (; next != edges.end() && next->low == edge->low && next->high == edge->high; ++next)
            forwards += next->forwards;
        const std::ptrdiff_t all = next - edge;
        if (all == 1)
            count(faults.open, faults.firstOpen, *edge);
        else if (2 * forwards != all && all == 2)
            count(faults.inconsistent, faults.firstInconsistent, *edge);
        else if (2 * forwards != all)
            count(faults.crowded, faults.firstCrowded, *edge);
        edge = next;
    }
    return faults;
}

double enclosedVolume(const TriangleMesh& mesh) {
    // Computed from its middle, so that a far position costs no digits.
    const Vec3d middle = boundsOf(mesh).centre();
    double six = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::array<Vec3d, 3> p = cornersOf(mesh, t);
        six += dot(p[0] - middle, cross(p[1] - middle, p[2] - middle));
    }
    return six / 6;
}

}  // namespace

Closedness checkClosed(const TriangleMesh& mesh) {
    const EdgeFaults faults = findEdgeFaults(mesh);
    Closedness result;
    std::vector<std::string> problems;
    const auto report = [&](std::size_t count, std::string_view what, Vec3d first) {
        first = first + mesh.origin;
        if (count > 0)
            problems.push_back(fmt::format("{} {}, the first one at ({:.6g}, {:.6g}, {:.6g})",
                                           count, what, first.x, first.y, first.z));
    };
    report(faults.open, "open edges", faults.firstOpen);
    report(faults.crowded, "edges of more than two triangles", faults.firstCrowded);
    report(faults.inconsistent, "edges between triangles that face opposite ways",
           faults.firstInconsistent);
    const double volume = enclosedVolume(mesh);
    if (problems.empty() && !(std::abs(volume) > 0)) problems.push_back("it encloses no volume");
    result.closed = problems.empty();
    result.inwards = result.closed && volume < 0;
    result.problem = fmt::format("{}", fmt::join(problems, "; "));
    return result;
}

void flip(SurfaceMesh& mesh) {
    for (auto& triangle : mesh.mesh.triangles) std::swap(triangle[1], triangle[2]);
    for (auto& uv : mesh.uvs) std::swap(uv[1], uv[2]);
    for (auto& normals : mesh.normals) {
        std::swap(normals[1], normals[2]);
        for (Vec3f& n : normals) n = -n;
    }
}

}  // namespace woodcock::mesh
