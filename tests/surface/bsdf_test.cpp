// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/bsdf.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/surface/one_bsdf.h"
#include "woodcock/proof/oracles/quadrature.h"
#include "woodcock/proof/support/statistics.h"
#include "woodcock/surface/fresnel.h"

namespace woodcock::test {

using namespace surface;
using namespace proof;

namespace {

// ---- formulas as they are printed ---------------------------------------------------------------

double squareTangent(double cosine) { return (1 - cosine * cosine) / (cosine * cosine); }

/// Walter et al. 2007, eq. 33.
double distribution(double alpha, double cosine) {
    const double spread = alpha * alpha + squareTangent(cosine);
    return alpha * alpha / (pi * std::pow(cosine, 4) * spread * spread);
}

/// Heitz 2014, eq. 99.
double shadowing(double alpha, double out, double in) {
    const auto lambda = [&](double c) {
        return (std::sqrt(1 + alpha * alpha * squareTangent(c)) - 1) / 2;
    };
    return 1 / (1 + lambda(out) + lambda(in));
}

TEST(Bsdf, DiffuseIsLambertsOnBothSides) {
    const Bsdf bsdf = bsdfOf(DiffuseMaterial{Rgb(0.2f, 0.5f, 1)});
    for (const double side : {1.0, -1.0}) {
        const Vec3d out = at(0.3, 1) * side, in = at(0.7, 4) * side;
        EXPECT_NEAR(bsdf.evaluate(out, in)[1], 0.5 * 0.7 / pi, 1e-7);
        EXPECT_NEAR(bsdf.pdf(out, in), 0.7 / pi, 1e-15);
        EXPECT_EQ(bsdf.evaluate(out, -in), Rgb());
        EXPECT_EQ(bsdf.pdf(out, -in), 0);
    }
}

/// Walter et al. 2007, eq. 20.
TEST(Bsdf, RoughMetalIsTheFormula) {
    RandomStream random(1);
    ConductorMaterial metal;
    metal.schlick = false;
    metal.eta = Rgb(0.2f, 0.9f, 1.1f), metal.k = Rgb(3.9f, 2.4f, 2.1f);
    double ior = 1;
    for (int n = 0; n < 1000; ++n) {
        if (n % 50 == 0)  // each has tables of its own
            metal.roughness = 0.1 + 0.9 * random.uniform(), ior = 1 + random.uniform();
        const double alpha = metal.roughness * metal.roughness;
        const Bsdf bsdf = bsdfOf(metal, flatPoint(ior, 1));
        const Vec3d o = at(random.uniformOpenLow(), 6 * random.uniform()),
                    i = at(random.uniformOpenLow(), 6 * random.uniform());
        const Vec3d h = normalize(o + i);
        for (int c = 0; c < 3; ++c) {
            const double f = conductorReflectance(dot(o, h), double{metal.eta[c]} / ior,
                                                  double{metal.k[c]} / ior);
            const double once =
                f * distribution(alpha, h.z) * shadowing(alpha, o.z, i.z) / (4 * o.z);
            // Kulla and Conty 2017, with the mean reflectance over light from all around.
            const double mean = oracle::tanhSinh(
                [&](double cosine, double) {
                    return 2 * cosine *
                           conductorReflectance(cosine, double{metal.eta[c]} / ior,
                                                double{metal.k[c]} / ior);
                },
                0, 1);
            const FacetLosses& losses = facetEnergy(alpha, 0).outside;
            const double more = losses.lost(o.z) * losses.lost(i.z) * i.z / (pi * losses.mean()) *
                                mean * mean * (1 - losses.mean()) / (1 - mean * losses.mean());
            EXPECT_NEAR(double{bsdf.evaluate(o, i)[c]}, once + more, 1e-5 * once + 1e-3 * more);
        }
        EXPECT_EQ(bsdf.evaluate(o, -i), Rgb());
    }
}

/// Walter et al. 2007, eq. 20 and 21; the light comes from `in`, and is seen at `out`.
TEST(Bsdf, RoughGlassIsTheFormula) {
    RandomStream random(2);
    int seen = 0;
    double roughness = 0, above = 1, below = 1;
    for (int n = 0; n < 10000; ++n) {
        if (n % 500 == 0) {  // each has tables of its own
            roughness = 0.2 + 0.8 * random.uniform();
            above = 1 + random.uniform(), below = above * (1.01 + random.uniform());
        }
        const double alpha = roughness * roughness;
        const Bsdf bsdf = bsdfOf(glass(roughness), flatPoint(above, below));
        const double side = random.uniform() < 0.5 ? 1 : -1;
        const double here = side > 0 ? above : below, there = side > 0 ? below : above;
        const Vec3d o = at(random.uniformOpenLow(), 6 * random.uniform()),
                    i = at(random.uniformOpenLow(), 6 * random.uniform());

        const Vec3d mirror = normalize(o + i);
        const double reflected = refraction(dot(o, mirror), there / here).reflectance *
                                 distribution(alpha, mirror.z) * shadowing(alpha, o.z, i.z) /
                                 (4 * o.z);
        const FacetEnergy& energy = facetEnergy(alpha, below / above);
        const FacetLosses& near = side > 0 ? energy.outside : energy.inside;
        const FacetLosses& far = side > 0 ? energy.inside : energy.outside;
        const double back = side > 0 ? energy.backOutside : energy.backInside;
        const double again = back * near.lost(o.z) * near.lost(i.z) * i.z / (pi * near.mean());
        EXPECT_NEAR(double{bsdf.evaluate(o * side, i * side)[0]}, reflected + again,
                    1e-5 * (reflected + again));

        const Vec3d beyond = -i;
        Vec3d h = normalize(-(o * here + beyond * there));
        if (h.z < 0) h = -h;
        double transmitted = 0;
        if (dot(o, h) > 0 && dot(beyond, h) < 0) {
            const double f = refraction(dot(o, h), there / here).reflectance;
            const double sum = there * dot(beyond, h) + here * dot(o, h);
            transmitted = std::abs(dot(beyond, h)) * dot(o, h) / o.z * here * here * (1 - f) *
                          distribution(alpha, h.z) * shadowing(alpha, o.z, i.z) / (sum * sum);
            ++seen;
        }
        transmitted += (1 - back) * near.lost(o.z) * far.lost(i.z) * i.z / (pi * far.mean()) *
                       here * here / (there * there);
        EXPECT_NEAR(bsdf.evaluate(o * side, beyond * side)[0], transmitted, 1e-5 * transmitted);
    }
    EXPECT_GT(seen, 1000);
}

TEST(Bsdf, IsReciprocal) {
    RandomStream random(3);
    double roughness = 0, above = 1, below = 1;
    for (int n = 0; n < 10000; ++n) {
        if (n % 500 == 0) {  // each has tables of its own
            roughness = 0.1 + 0.9 * random.uniform();
            above = 1 + random.uniform(), below = 1 + random.uniform();
        }
        const Vec3d a = at(2 * random.uniform() - 1, 6 * random.uniform()),
                    b = at(2 * random.uniform() - 1, 6 * random.uniform());
        const auto index = [&](Vec3d v) { return v.z > 0 ? above : below; };
        for (const Material& material : {diffuse(0.5f), whiteMetal(roughness), glass(roughness)}) {
            const Bsdf bsdf = bsdfOf(material, flatPoint(above, below));
            // Veach 1997, eq. 5.14.
            const double there =
                double{bsdf.evaluate(a, b)[0]} / std::abs(b.z) / std::pow(index(a), 2);
            const double back =
                double{bsdf.evaluate(b, a)[0]} / std::abs(a.z) / std::pow(index(b), 2);
            EXPECT_NEAR(there, back, 1e-5 * there + 1e-30);
        }
    }
}

// ---- directions against densities ---------------------------------------------------------------

/// Cells over the sphere, around an axis and finer close to it: rows in the logarithm of the
/// distance from it.
class SphereCells {
public:
    static constexpr int rows = 20, columns = 12;

    SphereCells(Vec3d axis, double width)
        : axis_(axis), width_(width), range_(std::log((2 + width) / width)) {
        orthonormalBasis(axis, s_, t_);
    }

    std::size_t cellOf(Vec3d v) const {
        const Vec3d apart = v - axis_;
        const double row = std::log1p(dot(apart, apart) / 2 / width_) / range_;
        const double turn = std::atan2(dot(v, t_), dot(v, s_)) / (2 * pi);
        return static_cast<std::size_t>(
            std::min(rows - 1, static_cast<int>(row * rows)) * columns +
            std::min(columns - 1, static_cast<int>((turn < 0 ? turn + 1 : turn) * columns)));
    }

    /// Integrals over the cells, by midpoints.
    template <class F>
    std::vector<double> integrals(int fine, F&& f) const {
        std::vector<double> sums(rows * columns);
        for (int r = 0; r < rows * fine; ++r) {
            const double distance =
                width_ * std::expm1((r + 0.5) / (rows * fine) * range_);  // 1 - cos
            const double sine = std::sqrt(distance * (2 - distance));
            const double solid =
                (distance + width_) * range_ / (rows * fine) * 2 * pi / (columns * fine);
            for (int c = 0; c < columns * fine; ++c) {
                const double phi = 2 * pi * (c + 0.5) / (columns * fine);
                const Vec3d v = axis_ * (1 - distance) + s_ * (sine * std::cos(phi)) +
                                t_ * (sine * std::sin(phi));
                sums[static_cast<std::size_t>(r / fine * columns + c / fine)] +=
                    solid * f(normalize(v));
            }
        }
        return sums;
    }

private:
    Vec3d axis_, s_, t_;
    double width_, range_;
};

enum class Side { Reflected, Transmitted };

/// Directions that sample() draws to one side are spread as pdf() says, and weights are evaluate()
/// / pdf().
void expectSampling(const Bsdf& bsdf, Vec3d out, Side side, Vec3d axis, double width,
                    const std::string& what) {
    constexpr int n = 100000;
    const SphereCells cells(axis, width);
    const auto counted = [&](Vec3d in) { return (in.z * out.z > 0) == (side == Side::Reflected); };
    std::vector<double> expected =
        cells.integrals(24, [&](Vec3d in) { return counted(in) ? n * bsdf.pdf(out, in) : 0.0; });
    // Where a lobe ends within a cell, the midpoints may miss it; no sample lies where pdf() is 0.
    for (double& cell : expected) cell += 1e-2;
    std::vector<double> counts(expected.size());
    RandomStream random(hashOf(what.size(), what[0], what.back()));
    for (int i = 0; i < n; ++i) {
        const BsdfSample s = bsdf.sample(out, three(random));
        if (s.delta || s.pdf == 0 || !counted(s.direction)) continue;
        ++counts[cells.cellOf(s.direction)];
        ASSERT_EQ(s.transmitted, side == Side::Transmitted);
        const BsdfValue value = bsdf.scatter(out, s.direction);
        ASSERT_NEAR(s.pdf / value.pdf, 1, 1e-12) << what;
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(double{s.weight[c]} * s.pdf, double{value.value[c]}, 1e-5 * s.pdf) << what;
    }
    EXPECT_GT(proof::chiSquareProbability(counts, expected), proof::leastProbability) << what;
}

/// Even cells for what is as rough as can be, whose rows end at the horizon; else as narrow as the
/// lobe.
double cellWidth(double roughness) { return roughness == 1 ? 1e6 : std::pow(roughness, 4) / 4; }

TEST(BsdfSampling, FollowsTheDensityOfDiffuse) {
    for (const double cosine : {1.0, 0.6, -0.1})
        expectSampling(bsdfOf(diffuse(0.5f)), at(cosine, 0.3), Side::Reflected, {0, 0, 1}, 1e6,
                       fmt::format("diffuse at {}", cosine));
}

TEST(BsdfSampling, FollowsTheDensityOfMetal) {
    for (const double roughness : {1.0, 0.5, 0.1, 0.03})
        for (const double cosine : {1.0, 0.6, -0.1}) {
            const Vec3d out = at(cosine, 0.3);
            const Vec3d axis = roughness == 1 ? Vec3d{0, 0, 1} : Vec3d{-out.x, -out.y, out.z};
            expectSampling(bsdfOf(whiteMetal(roughness)), out, Side::Reflected, axis,
                           cellWidth(roughness), fmt::format("metal {} at {}", roughness, cosine));
        }
}

TEST(BsdfSampling, FollowsTheDensityOfGlass) {
    for (const double roughness : {1.0, 0.5, 0.1})
        for (const double eta : {1.5, 1 / 1.5})
            for (const double cosine : {1.0, 0.8, 0.2}) {
                const Vec3d out = at(cosine, 0.3);
                const Bsdf bsdf = bsdfOf(glass(roughness), flatPoint(1, eta));
                const Refraction r = refraction(cosine, eta);
                const bool broad = roughness == 1;
                const std::string what =
                    fmt::format("glass {} eta {} at {}", roughness, eta, cosine);
                expectSampling(bsdf, out, Side::Reflected,
                               broad ? Vec3d{0, 0, 1} : Vec3d{-out.x, -out.y, out.z},
                               cellWidth(roughness), what + ", reflected");
                if (r.reflectance < 1)
                    expectSampling(bsdf, out, Side::Transmitted,
                                   broad ? Vec3d{0, 0, -1}
                                         : normalize(Vec3d{-out.x / eta, -out.y / eta, -r.cosine}),
                                   cellWidth(roughness) / (broad ? 1 : 4), what + ", transmitted");
            }
}

TEST(BsdfSampling, FollowsTheDensityOfMixes) {
    const std::vector<Material> materials{diffuse(0.5f),
                                          whiteMetal(0.5),
                                          glass(0),
                                          EmissiveMaterial{},
                                          MixMaterial{0, 1, Rgb(0.3f)},
                                          MixMaterial{0, 2, Rgb(0.6f)},
                                          MixMaterial{3, 1, Rgb(0.4f)}};
    for (const std::uint32_t mix : {4u, 5u, 6u}) {
        const Bsdf bsdf(materials, mix, flatPoint(1, 1.5));
        const Vec3d out = at(0.6, 0.3);
        expectSampling(bsdf, out, Side::Reflected, {0, 0, 1}, 1e6, fmt::format("mix {}", mix));
    }
}

/// What one lobe draws to the wrong side of the surface is not what the other one would draw there.
TEST(BsdfSampling, FollowsTheDensityUnderShadingNormals) {
    const std::vector<Material> materials{diffuse(0.5f), glass(0.8), MixMaterial{0, 1, Rgb(0.5f)}};
    BsdfPoint point = flatPoint(1, 1.5);
    for (const double tilt : {1.0, 0.9, 0.4})
        for (const double cosine : {0.8, -0.5}) {
            point.shadingNormal = at(tilt, 2);
            const Bsdf bsdf(materials, 2, point);
            const std::string what = fmt::format("tilt {} at {}", tilt, cosine);
            for (const Side side : {Side::Reflected, Side::Transmitted})
                expectSampling(bsdf, at(cosine, 0.3), side, {0, 0, 1}, 1e6, what);
        }
}

}  // namespace
}  // namespace woodcock::test
