// SPDX-License-Identifier: Apache-2.0
// Noises, one octave or many.
#include <cmath>

#include "woodcock/bake/node_reader.h"
#include "woodcock/bake/noise.h"
#include "woodcock/base/random.h"

namespace woodcock::bake {

namespace {

enum class Basis { Perlin, Simplex, Worley };
enum class Fold { None, Billow, Ridged };  ///< n, |n|, (1 - |n|)^2
enum class CellValue { First, Second, Border };

struct Fractal {
    Basis basis = Basis::Perlin;
    Fold fold = Fold::None;
    CellValue cell = CellValue::First;
    Vec3d size{1, 1, 1}, offset;  ///< wavelengths of the first octave; shift, world units
    int octaves = 1;
    double lacunarity = 2, gain = 0.5, evolution = 0;
    std::uint64_t seed = 0;
};

double fold(Fold how, double n) {
    if (how == Fold::None) return n;
    const double v = std::abs(n);
    return how == Fold::Billow ? v : (1 - v) * (1 - v);
}
Interval fold(Fold how, Interval n) {
    if (how == Fold::None) return n;
    const Interval v = abs(n);
    if (how == Fold::Billow) return v;
    return {(1 - v.upper) * (1 - v.upper), (1 - v.lower) * (1 - v.lower)};
}

class FractalNode : public Node {
public:
    explicit FractalNode(const Fractal& fractal) : f_(fractal) {
        double frequency = 1, weight = 1, sum = 0;
        for (int i = 0; i < f_.octaves; ++i, frequency *= f_.lacunarity, weight *= f_.gain) {
            octaves_.push_back(
                {Vec3d{frequency / f_.size.x, frequency / f_.size.y, frequency / f_.size.z}, weight,
                 hashOf(f_.seed, i), f_.evolution * frequency});
            sum += weight;
        }
        for (Octave& octave : octaves_) octave.weight /= sum;
    }

    void evaluate(const Points& points, std::span<const Values>,
                  std::span<double* const> out) const override {
        std::fill_n(out[0], points.count, 0.0);
        for (const Octave& o : octaves_) {
            const auto add = [&](const auto& noiseAt) {
                for (std::size_t i = 0; i < points.count; ++i)
                    out[0][i] += o.weight * fold(f_.fold, noiseAt(scaled(points[i], o)));
            };
            if (f_.basis != Basis::Worley) {
                add([&](Vec3d p) { return noise(o, p); });
                continue;
            }
            Box3d box;
            box.add(scaled(points.box.lower, o)), box.add(scaled(points.box.upper, o));
            const CellCache cells(box, o.w, o.seed);
            if (f_.cell == CellValue::First)
                add([&](Vec3d p) { return 1 - cells.nearest(p); });
            else
                add([&](Vec3d p) { return cellValue(cells.distances(p)); });
        }
    }

    Bounds bound(const Box3d& box, std::span<const Bounds>) const override {
        Interval sum{0, 0};
        const Vec3d half = box.size() * 0.5;
        for (const Octave& o : octaves_) {
            const Vec3d reach{half.x * o.frequency.x, half.y * o.frequency.y,
                              half.z * o.frequency.z};
            sum = sum + fold(f_.fold, noiseIn(o, scaled(box.centre(), o), reach)) * o.weight;
        }
        sum = {sum.lower - 1e-9, sum.upper + 1e-9};  // rounding
        return {sum, sum, sum};
    }

private:
    struct Octave {
        Vec3d frequency;
        double weight;
        std::uint64_t seed;
        double w;
    };

    Vec3d scaled(Vec3d p, const Octave& o) const {
        const Vec3d q = p - f_.offset;
        return {q.x * o.frequency.x, q.y * o.frequency.y, q.z * o.frequency.z};
    }

    double noise(const Octave& o, Vec3d p) const {
        if (f_.basis == Basis::Perlin) return perlinNoise(p, o.w, o.seed);
        if (f_.basis == Basis::Simplex) return simplexNoise(p, o.seed);
        return cellValue(cellNoise(p, o.w, o.seed));
    }
    double cellValue(CellDistances d) const {
        if (f_.cell == CellValue::First) return 1 - d.first;
        return f_.cell == CellValue::Second ? 1 - d.second : d.second - d.first;
    }

    /// Of points within `reach` of p, by axis.
    Interval noiseIn(const Octave& o, Vec3d p, Vec3d reach) const {
        if (f_.basis == Basis::Simplex) return {-1, 1};
        if (f_.basis == Basis::Worley) {  // distances change by as much as the position
            const double slope = f_.cell == CellValue::Border ? 2 : 1;
            return intersect(Interval::around(noise(o, p), slope * length(reach)), {0, 1});
        }
        const double change = perlinSlope * (reach.x + reach.y + reach.z);
        if (change >= 2) return {-1, 1};
        return intersect(Interval::around(noise(o, p), change), {-1, 1});
    }

    Fractal f_;
    std::vector<Octave> octaves_;
};

/// The curl of three noises: a flow without divergence (Bridson et al. 2007), about 1 in length.
/// Each octave is clamped to a length of 1.5 (where it has divergence, in few places), so that
/// warps by it have narrow bounds.
class CurlNode : public Node {
public:
    explicit CurlNode(const Fractal& fractal) : f_(fractal) {}

    int channels() const override { return 3; }
    void evaluate(const Points& points, std::span<const Values>,
                  std::span<double* const> out) const override {
        for (std::size_t i = 0; i < points.count; ++i) {
            Vec3d sum;
            double frequency = 1, weight = 1;
            for (int octave = 0; octave < f_.octaves;
                 ++octave, frequency *= f_.lacunarity, weight *= f_.gain)
                sum += curl(points[i], frequency, octave) * weight;
            for (int c = 0; c < 3; ++c) out[static_cast<std::size_t>(c)][i] = sum[c];
        }
    }
    Bounds bound(const Box3d&, std::span<const Bounds>) const override {
        double most = 0, weight = 1;
        for (int octave = 0; octave < f_.octaves; ++octave, weight *= f_.gain)
            most += weight * longest;
        const Interval all{-most, most};
        return {all, all, all};
    }

private:
    static constexpr double scale = 0.6, longest = 1.5;

    Vec3d curl(Vec3d p, double frequency, int octave) const {
        const Vec3d q = p - f_.offset;
        const Vec3d at{q.x * frequency / f_.size.x, q.y * frequency / f_.size.y,
                       q.z * frequency / f_.size.z};
        Vec3d g[3];
        for (int c = 0; c < 3; ++c)
            g[c] =
                perlinGradient(at, f_.evolution * frequency, hashOf(f_.seed, octave, c)).gradient;
        const Vec3d v = Vec3d{g[2].y - g[1].z, g[0].z - g[2].x, g[1].x - g[0].y} * scale;
        const double square = dot(v, v);
        return square > longest * longest ? v * ((1 - 1e-12) * longest / std::sqrt(square)) : v;
    }

    Fractal f_;
};

Fractal readBasics(NodeReader& r) {
    Fractal f;
    f.size = r.extent("size", {}, positive);
    f.offset = r.vector("offset", {});
    f.seed = r.seed();
    return f;
}
void readOctaves(NodeReader& r, Fractal& f, int octaves) {
    f.octaves = r.integer("octaves", octaves, 1, 16);
    f.lacunarity = r.number("lacunarity", 2, {1, 8});
    f.gain = r.number("gain", 0.5, {0, 1});
}
void readCell(NodeReader& r, Fractal& f) {
    static const std::vector<std::string> names{"first", "second", "border"};
    f.cell = static_cast<CellValue>(r.choice("value", names, 0));
}

Graph::Entry fractal(NodeReader& r, Fold how) {
    static const std::vector<std::string> names{"perlin", "simplex", "worley"};
    Fractal f = readBasics(r);
    readOctaves(r, f, 5);
    f.fold = how;
    f.basis = static_cast<Basis>(r.choice("basis", names, 0));
    if (f.basis != Basis::Simplex) f.evolution = r.number("evolution", 0);
    if (f.basis == Basis::Worley) readCell(r, f);
    return {.node = std::make_unique<FractalNode>(f)};
}
Graph::Entry fbm(NodeReader& r) { return fractal(r, Fold::None); }
Graph::Entry billow(NodeReader& r) { return fractal(r, Fold::Billow); }
Graph::Entry ridged(NodeReader& r) { return fractal(r, Fold::Ridged); }

Graph::Entry perlin(NodeReader& r) {
    Fractal f = readBasics(r);
    f.evolution = r.number("evolution", 0);
    return {.node = std::make_unique<FractalNode>(f)};
}
Graph::Entry simplex(NodeReader& r) {
    Fractal f = readBasics(r);
    f.basis = Basis::Simplex;
    return {.node = std::make_unique<FractalNode>(f)};
}
Graph::Entry worley(NodeReader& r) {
    Fractal f = readBasics(r);
    f.basis = Basis::Worley;
    f.evolution = r.number("evolution", 0);
    readCell(r, f);
    return {.node = std::make_unique<FractalNode>(f)};
}
Graph::Entry curl(NodeReader& r) {
    Fractal f = readBasics(r);
    readOctaves(r, f, 1);
    f.evolution = r.number("evolution", 0);
    return {.node = std::make_unique<CurlNode>(f)};
}

constexpr NodeType noiseTypes[]{{"perlin", perlin}, {"simplex", simplex}, {"worley", worley},
                                {"fbm", fbm},       {"billow", billow},   {"ridged", ridged},
                                {"curl", curl}};

}  // namespace

std::span<const NodeType> noiseNodes() { return noiseTypes; }

}  // namespace woodcock::bake
