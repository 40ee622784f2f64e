// SPDX-License-Identifier: Apache-2.0
#include "woodcock/mesh/closed_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>
#include <unordered_map>

#include "woodcock/base/error.h"
#include "woodcock/base/random.h"

namespace woodcock::mesh {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

class UnionFind {
public:
    explicit UnionFind(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    /// The lower number is kept.
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

/// An edge of a triangle, by its points in order.
struct Edge {
    std::uint32_t low, high, triangle;
    bool forwards;  ///< the triangle runs along it from low to high
};

std::vector<Edge> sortedEdges(const std::vector<Triangle>& triangles) {
    std::vector<Edge> edges;
    edges.reserve(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = triangles[t][i], b = triangles[t][(i + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), t, a < b});
        }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    return edges;
}

/// Calls `use(begin, end)` for the triangles of each edge.
template <class Use>
void forEachEdge(const std::vector<Edge>& edges, Use use) {
    for (auto edge = edges.begin(); edge != edges.end();) {
        auto next = edge;
        while (next != edges.end() && next->low == edge->low && next->high == edge->high) ++next;
        use(edge, next);
        edge = next;
    }
}

/// Labels 0, 1, .. of the sets, in the order of their first members.
std::vector<std::uint32_t> labels(UnionFind& sets, std::size_t count, std::size_t& number) {
    std::vector<std::uint32_t> label(count), labelOf(count, ~0u);
    number = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        std::uint32_t& known = labelOf[sets.find(i)];
        if (known == ~0u) known = static_cast<std::uint32_t>(number++);
        label[i] = known;
    }
    return label;
}

class Closer {
public:
    explicit Closer(const TriangleMesh& mesh) { result_.mesh = mesh; }

    ClosedMesh close() {
        if (mesh().triangles.empty()) throw inputError("the mesh has no triangles");
        requireArea();
        dropDuplicates();
        if (countOpen() > 0) joinAlongOpenEdges();
        requireClosed();
        turnAlike();
        joinCrowdedParts();
        measure();
        return std::move(result_);
    }

private:
    TriangleMesh& mesh() { return result_.mesh; }
    std::string placeOf(const Edge& e) {
        const Vec3d p =
            mesh().origin +
            (mesh().points[e.low].as<double>() + mesh().points[e.high].as<double>()) * 0.5;
        return fmt::format("{:.9g}, {:.9g}, {:.9g}", p.x, p.y, p.z);
    }
    static const char* s(std::size_t count) { return count == 1 ? "" : "s"; }

    void requireArea() {
        for (const auto& [a, b, c] : mesh().triangles) {
            const Vec3d p = mesh().points[a].as<double>();
            if (length(cross(mesh().points[b].as<double>() - p,
                             mesh().points[c].as<double>() - p)) > 0)
                return;
        }
        throw inputError("the mesh encloses nothing: all of its triangles have zero area");
    }

    void keep(const std::vector<bool>& kept) {
        std::size_t n = 0;
        for (std::size_t t = 0; t < kept.size(); ++t)
            if (kept[t]) mesh().triangles[n++] = mesh().triangles[t];
        mesh().triangles.resize(n);
    }

    /// Drops triangles of the same three points. Two that face the same way count once. Two that
    /// face opposite ways are a wall without thickness and are dropped, unless a whole piece is
    /// such: then it was drawn from both sides.
    void dropDuplicates() {
        const std::vector<Triangle>& triangles = mesh().triangles;
        std::vector<std::uint32_t> order(triangles.size());
        std::iota(order.begin(), order.end(), 0u);
        const auto sorted = [&](std::uint32_t t) {
            Triangle corners = triangles[t];
            std::sort(corners.begin(), corners.end());
            return corners;
        };
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(sorted(a), a) < std::pair(sorted(b), b);
        });
        const auto isEven = [&](std::uint32_t t) {
            const auto& [a, b, c] = triangles[t];
            return (a < b) == (b < c) ? a < b : c < a;
        };
        struct Group {
            std::size_t begin, end;
        };
        std::vector<Group> doubled;
        for (std::size_t i = 0, next = 0; i < order.size(); i = next) {
            for (next = i + 1; next < order.size() && sorted(order[next]) == sorted(order[i]);)
                ++next;
            if (next - i > 1) doubled.push_back({i, next});
        }
        if (doubled.empty()) return;

        const std::vector<Edge> edges = sortedEdges(triangles);
        UnionFind sets(triangles.size());
        forEachEdge(edges, [&](auto begin, auto end) {
            for (auto e = begin; e != end; ++e) sets.join(begin->triangle, e->triangle);
        });
        std::vector<std::size_t> single(triangles.size());
        for (std::uint32_t t = 0; t < triangles.size(); ++t) ++single[sets.find(t)];
        std::vector<bool> kept(triangles.size(), true);
        for (const Group& g : doubled) single[sets.find(order[g.begin])] -= g.end - g.begin;
        std::size_t dropped = 0;
        for (const auto& [begin, end] : doubled) {
            std::ptrdiff_t net = 0;
            for (std::size_t i = begin; i < end; ++i) net += isEven(order[i]) ? 1 : -1;
            const bool drawnTwice = single[sets.find(order[begin])] == 0;
            bool one = net != 0 || drawnTwice;
            const bool even = net != 0 ? net > 0 : isEven(order[begin]);
            for (std::size_t i = begin; i < end; ++i) {
                const bool keeps = one && isEven(order[i]) == even;
                if (keeps) one = false;
                kept[order[i]] = keeps;
                dropped += !keeps;
            }
        }
        keep(kept);
        result_.notes.push_back(fmt::format(
            "{} triangle{} of the mesh coincide{} with others, and {} left out", dropped,
            s(dropped), dropped == 1 ? "s" : "", dropped == 1 ? "was" : "were"));
    }

    std::size_t countOpen() {
        std::size_t open = 0;
        forEachEdge(sortedEdges(mesh().triangles),
                    [&](auto begin, auto end) { open += end - begin == 1; });
        return open;
    }

    /// Merges points at open edges that differ only by rounding.
    void joinAlongOpenEdges() {
        const Vec3d size = boundsOf(mesh()).size();
        const double reach = 1e-6 * std::max({size.x, size.y, size.z});
        if (!(reach > 0)) return;
        std::set<std::uint32_t> rim;
        forEachEdge(sortedEdges(mesh().triangles), [&](auto begin, auto end) {
            if (end - begin == 1) rim.insert(begin->low), rim.insert(begin->high);
        });
        using Cell = std::array<std::int64_t, 3>;
        const auto hash = [](const Cell& c) {
            const auto bits = [&](std::size_t i) { return static_cast<std::uint64_t>(c[i]); };
            return static_cast<std::size_t>(mixBits(mixBits(mixBits(bits(0)) ^ bits(1)) ^ bits(2)));
        };
        std::unordered_map<Cell, std::vector<std::uint32_t>, decltype(hash)> cells(rim.size(),
                                                                                   hash);
        UnionFind sets(mesh().points.size());
        std::size_t joined = 0;
        for (const std::uint32_t i : rim) {
            const Vec3d p = mesh().points[i].as<double>() / reach;
            const Cell at{std::llround(std::floor(p.x)), std::llround(std::floor(p.y)),
                          std::llround(std::floor(p.z))};
            for (int n = 0; n < 27; ++n) {
                const auto near =
                    cells.find({at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1});
                if (near == cells.end()) continue;
                for (const std::uint32_t other : near->second) {
                    const Vec3d q = mesh().points[other].as<double>() / reach;
                    if (length(p - q) > 1 || sets.find(i) == sets.find(other)) continue;
                    sets.join(i, other);
                    ++joined;
                }
            }
            cells[at].push_back(i);
        }
        if (joined == 0) return;
        std::vector<bool> kept;
        for (Triangle& corners : mesh().triangles) {
            for (std::uint32_t& i : corners) i = sets.find(i);
            kept.push_back(corners[0] != corners[1] && corners[1] != corners[2] &&
                           corners[2] != corners[0]);
        }
        keep(kept);
        result_.notes.push_back(
            fmt::format("{} point{} at open edges less than {:.3g} from another {} merged with it",
                        joined, s(joined), reach, joined == 1 ? "was" : "were"));
    }

    void requireClosed() {
        const std::vector<Edge> edges = sortedEdges(mesh().triangles);
        UnionFind sets(mesh().triangles.size());
        std::size_t open = 0, odd = 0;
        Edge firstOpen{}, firstOdd{};
        std::vector<std::uint32_t> openAt;
        forEachEdge(edges, [&](auto begin, auto end) {
            for (auto e = begin; e != end; ++e) sets.join(begin->triangle, e->triangle);
            const auto count = end - begin;
            if (count == 1) {
                openAt.push_back(begin->triangle);
                if (open++ == 0) firstOpen = *begin;
            } else if (count % 2 == 1 && odd++ == 0) {
                firstOdd = *begin;
            }
        });
        if (open > 0) {
            std::size_t pieces = 0;
            const auto label = labels(sets, mesh().triangles.size(), pieces);
            std::set<std::uint32_t> openPieces;
            for (const std::uint32_t t : openAt) openPieces.insert(label[t]);
            throw inputError(
                "the mesh is open: {} edge{} belong{} to one triangle only (first at {}){}", open,
                s(open), open == 1 ? "s" : "", placeOf(firstOpen),
                pieces == 1 ? ""
                            : fmt::format(", in {} of its {} pieces", openPieces.size(), pieces));
        }
        if (odd > 0)
            throw inputError(
                "the mesh does not divide space into inside and outside: {} edge{} belong{} to an "
                "odd number of triangles, as where a wall ends inside (first at {})",
                odd, s(odd), odd == 1 ? "s" : "", placeOf(firstOdd));
    }

    /// Flips triangles so that neighbours run along their common edge in opposite directions.
    void turnAlike() {
        std::vector<Triangle>& triangles = mesh().triangles;
        const std::vector<Edge> edges = sortedEdges(triangles);
        struct Neighbour {
            std::uint32_t triangle;
            bool same;  ///< of the same way as they are
        };
        struct Neighbours {
            std::array<Neighbour, 3> at;
            std::size_t count = 0;
        };
        std::vector<Neighbours> all(triangles.size());
        const auto add = [&](std::uint32_t to, Neighbour n) { all[to].at[all[to].count++] = n; };
        UnionFind sets(triangles.size());
        forEachEdge(edges, [&](auto begin, auto end) {
            if (end - begin != 2) return;
            const Edge &a = begin[0], &b = begin[1];
            const bool same = a.forwards != b.forwards;
            add(a.triangle, {b.triangle, same});
            add(b.triangle, {a.triangle, same});
            sets.join(a.triangle, b.triangle);
        });
        std::vector<signed char> way(triangles.size());
        std::vector<std::uint32_t> waiting, piece;
        std::size_t turned = 0;
        for (std::uint32_t first = 0; first < triangles.size(); ++first) {
            if (way[first] != 0) continue;
            way[first] = 1;
            waiting = piece = {first};
            std::size_t others = 0;
            while (!waiting.empty()) {
                const std::uint32_t t = waiting.back();
                waiting.pop_back();
                for (std::size_t n = 0; n < all[t].count; ++n) {
                    const auto [next, same] = all[t].at[n];
                    const auto wanted = static_cast<signed char>(same ? way[t] : -way[t]);
                    if (way[next] == 0) {
                        way[next] = wanted;
                        others += wanted < 0;
                        waiting.push_back(next), piece.push_back(next);
                    } else if (way[next] != wanted) {
                        const Vec3d p =
                            mesh().origin + mesh().points[triangles[next][0]].as<double>();
                        throw inputError(
                            "the mesh does not divide space into inside and outside: its triangles "
                            "cannot all face one way, as those of a Moebius strip (at {:.9g}, "
                            "{:.9g}, {:.9g})",
                            p.x, p.y, p.z);
                    }
                }
            }
            const signed char wrong = 2 * others > piece.size() ? 1 : -1;
            for (const std::uint32_t t : piece)
                if (way[t] == wrong) std::swap(triangles[t][1], triangles[t][2]), ++turned;
        }
        if (turned > 0)
            result_.notes.push_back(fmt::format(
                "{} triangle{} faced the other way than {} neighbours, and {} flipped", turned,
                s(turned), turned == 1 ? "its" : "their", turned == 1 ? "was" : "were"));
        std::size_t parts = 0;
        result_.partOf = labels(sets, triangles.size(), parts);
    }

    /// Where four or more triangles meet at an edge, each part must be closed by itself; parts that
    /// are not closed are joined.
    void joinCrowdedParts() {
        const std::vector<Edge> edges = sortedEdges(mesh().triangles);
        std::vector<std::uint32_t>& partOf = result_.partOf;
        UnionFind parts(partOf.size());
        std::size_t unpaired = 0;
        Edge first{};
        forEachEdge(edges, [&](auto begin, auto end) {
            if (end - begin == 2) return;
            std::vector<std::pair<std::uint32_t, int>> net;
            int all = 0;
            for (auto e = begin; e != end; ++e) {
                const std::uint32_t part = partOf[e->triangle];
                const int step = e->forwards ? 1 : -1;
                auto at = std::find_if(net.begin(), net.end(),
                                       [&](const auto& n) { return n.first == part; });
                if (at == net.end()) at = net.insert(at, {part, 0});
                at->second += step;
                all += step;
            }
            std::erase_if(net, [](const auto& n) { return n.second == 0; });
            for (const auto& n : net) parts.join(net.front().first, n.first);
            if (all != 0 && unpaired++ == 0) first = *begin;
        });
        if (unpaired > 0)
            throw inputError(
                "the mesh does not divide space into inside and outside: at {} edge{} more "
                "triangles face one way than the other (first at {})",
                unpaired, s(unpaired), placeOf(first));
        for (std::uint32_t& part : partOf) part = parts.find(part);
    }

    /// Numbers the parts from 0 on, and finds their volumes.
    void measure() {
        std::vector<std::uint32_t> number(result_.partOf.size(), ~0u);
        const Vec3d middle = boundsOf(mesh()).centre();
        for (std::size_t t = 0; t < mesh().triangles.size(); ++t) {
            std::uint32_t& part = number[result_.partOf[t]];
            if (part == ~0u) {
                part = static_cast<std::uint32_t>(result_.volumes.size());
                result_.volumes.push_back(0);
            }
            result_.partOf[t] = part;
            const auto corner = [&](std::size_t i) {
                return mesh().points[mesh().triangles[t][i]].as<double>() - middle;
            };
            result_.volumes[part] += dot(corner(0), cross(corner(1), corner(2))) / 6;
        }
    }

    ClosedMesh result_;
};

}  // namespace

ClosedMesh closedMesh(const TriangleMesh& mesh) { return Closer(mesh).close(); }

}  // namespace woodcock::mesh
