// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/microfacet.h"

#include <gtest/gtest.h>

#include "woodcock/base/random.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::test {

using namespace surface;
using namespace proof;

namespace {

Vec3d at(double cosine, double phi) {
    const double sine = std::sqrt((1 - cosine) * (1 + cosine));
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

/// Walter et al. 2007, eq. 33 and 34, as they are printed.
double walterD(double alpha, double cosine) {
    const double tan2 = (1 - cosine * cosine) / (cosine * cosine);
    return alpha * alpha / (pi * std::pow(cosine, 4) * std::pow(alpha * alpha + tan2, 2));
}
double walterG1(double alpha, double cosine) {
    const double tan2 = (1 - cosine * cosine) / (cosine * cosine);
    return 2 / (1 + std::sqrt(1 + alpha * alpha * tan2));
}

TEST(Ggx, IsWalters) {
    RandomStream random(1);
    for (int i = 0; i < 10000; ++i) {
        const double alpha = 0.01 + 0.99 * random.uniform();
        const Vec3d out = at(random.uniformOpenLow(), 6 * random.uniform());
        const Vec3d facet = at(random.uniformOpenLow(), 6 * random.uniform());
        const double expected = walterG1(alpha, out.z) * walterD(alpha, facet.z) / out.z;
        EXPECT_NEAR(Ggx(alpha).visible(out, facet) / expected, 1, 1e-9);
        // Heitz 2014, eq. 99, with Lambda = 1 / G1 - 1.
        const double o = walterG1(alpha, out.z), f = walterG1(alpha, facet.z);
        EXPECT_NEAR(Ggx(alpha).shadowing(out, facet), 1 / (1 / o + 1 / f - 1) / o, 1e-12);
    }
}

/// Facets that are seen cover what they are seen on: Heitz 2014, eq. 14.
TEST(Ggx, VisibleFacetsFillTheirSurface) {
    for (const double alpha : {1.0, 0.3, 0.03, 4e-4})
        for (const double cosine : {1.0, 0.7, 0.1, 1e-3}) {
            const Vec3d out = at(cosine, 1);
            // In the angle's tangent over alpha, mapped to [0, 1), and by midpoints around.
            const double sum = proof::integrate(0, 1, 200, [&](double x) {
                const double tangent = alpha * x / (1 - x),
                             z = 1 / std::sqrt(1 + tangent * tangent);
                const double slope = alpha / ((1 - x) * (1 - x));
                const double solid = tangent * z * z * z * slope;  // sin dtheta / dx
                double ring = 0;
                constexpr int steps = 2000;
                for (int i = 0; i < steps; ++i) {
                    const Vec3d facet = at(z, 2 * pi * (i + 0.5) / steps);
                    ring += Ggx(alpha).visible(out, facet) * std::max(0.0, dot(out, facet));
                }
                return solid * ring * 2 * pi / steps;
            });
            EXPECT_NEAR(sum, 1, 2e-3) << alpha << " " << cosine;
        }
}

/// Cells by x = 1 - sqrt(1 - s), where s = tan^2 / (alpha^2 + tan^2) is even in the facets' own
/// distribution, D cos: the density of those that are seen is smooth in x.
TEST(Ggx, SamplesWhatIsVisible) {
    for (const double alpha : {1.0, 0.25, 4e-4})
        for (const double cosine : {1.0, 0.5, 0.05, 1e-6}) {
            const Vec3d out = at(cosine, 0.4);
            constexpr int rows = 16, columns = 16, fine = 40, n = 200000;
            std::vector<double> counts(rows * columns), expected(rows * columns);
            const auto facetAt = [&](double x, double turn) {
                const double share = x * (2 - x);
                const double tangent = alpha * std::sqrt(share / (1 - share));
                return at(1 / std::sqrt(1 + tangent * tangent), 2 * pi * turn);
            };
            for (int r = 0; r < rows * fine; ++r)
                for (int c = 0; c < columns * fine; ++c) {
                    const Vec3d facet =
                        facetAt((r + 0.5) / (rows * fine), (c + 0.5) / (columns * fine));
                    const double stretch = 2 * (1 - (r + 0.5) / (rows * fine));
                    const double density = Ggx(alpha).visible(out, facet) *
                                           std::max(0.0, dot(out, facet)) /
                                           (walterD(alpha, facet.z) * facet.z);
                    expected[static_cast<std::size_t>(r / fine * columns + c / fine)] +=
                        n * stretch * density / (rows * fine * columns * fine);
                }
            RandomStream random(hashOf(5, static_cast<std::uint64_t>(1e6 * alpha),
                                       static_cast<std::uint64_t>(1e6 * cosine)));
            for (int i = 0; i < n; ++i) {
                const Vec3d m = Ggx(alpha).sampleVisible(out, random.uniform(), random.uniform());
                ASSERT_GT(m.z, 0);
                const double tan2 = (m.x * m.x + m.y * m.y) / (m.z * m.z);
                const double x = 1 - alpha / std::sqrt(alpha * alpha + tan2);
                const double turn = std::atan2(m.y, m.x) / (2 * pi);
                const int r = std::min(rows - 1, static_cast<int>(x * rows));
                const int c =
                    std::min(columns - 1, static_cast<int>((turn < 0 ? turn + 1 : turn) * columns));
                ++counts[static_cast<std::size_t>(r * columns + c)];
            }
            EXPECT_GT(proof::chiSquareProbability(counts, expected), proof::leastProbability)
                << alpha << " " << cosine;
        }
}

TEST(Ggx, ShadowsAlikeBothWaysAndNeverLights) {
    RandomStream random(7);
    for (int i = 0; i < 10000; ++i) {
        const Ggx facets(random.uniformOpenLow());
        const Vec3d a = at(std::pow(10, -8 * random.uniform()), 1),
                    b = at(std::pow(10, -8 * random.uniform()), 2);
        const double there = facets.shadowing(a, b), back = facets.shadowing(b, a);
        EXPECT_GT(there, 0);
        EXPECT_LE(there, 1 + 1e-15);
        // G2 is symmetric: G2 / G1(out) differs by the maskings, which visible() tells.
        const Vec3d up{0, 0, 1};
        EXPECT_NEAR(there * facets.visible(a, up) * a.z, back * facets.visible(b, up) * b.z,
                    1e-12 * there * facets.visible(a, up) * a.z);
    }
}

TEST(Ggx, StandsTheEndsOfItsNumbers) {
    for (const double alpha : {1.0, 4e-4})
        for (const double cosine : {1.0, 1e-3, 1e-8, 1e-16})
            for (const double u : {0.0, 0.5, 1 - 0x1p-53})
                for (const double v : {0.0, 1e-300, 0.5, 1 - 0x1p-53}) {
                    const Vec3d out = at(cosine, 0);
                    const Vec3d m = Ggx(alpha).sampleVisible(out, u, v);
                    EXPECT_NEAR(length(m), 1, 1e-12);
                    EXPECT_GT(m.z, 0);
                    EXPECT_TRUE(std::isfinite(Ggx(alpha).visible(out, m)));
                }
}

}  // namespace
}  // namespace woodcock::test
