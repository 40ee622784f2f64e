// SPDX-License-Identifier: Apache-2.0
// The oracles themselves against numbers that others have published.
#include "woodcock/proof/oracles/published.h"

#include <gtest/gtest.h>

#include "woodcock/base/vec.h"
#include "woodcock/proof/oracles/adding_doubling.h"
#include "woodcock/proof/oracles/chandrasekhar.h"

namespace woodcock::oracle {

using namespace oracle;

namespace {

constexpr double sixDecimals = 0.5001e-6;  // the halves that were rounded to even included

TEST(Published, Slabs) {
    for (const PublishedSlab& p : publishedSlabs) {
        const Face f = solveSlab({{{p.opticalDepth, p.albedo, p.g}}, p.refractiveIndex}, {1}).above;
        const double value =
            p.quantity == PublishedSlab::Reflectance ? f.reflectance[0] : f.transmittance[0];
        EXPECT_NEAR(value, p.value, p.isMonteCarlo ? 3 * p.error : p.error) << p.source;
    }
}

TEST(Published, Disort) {
    for (const PublishedRadiance& p : disortRadiances)
        EXPECT_NEAR(solveSlab({{{32, 0.99, 0}}}, {p.mu}).above.reflectance[0], p.radiance,
                    sixDecimals)
            << p.mu;
    EXPECT_NEAR(pi * solveSlab({{{32, 0.99, 0}}}, {}).above.whiteSkyReflectance,
                disortReflectedFlux, 5e-6);
}

TEST(Published, ConservativeSlabs) {
    for (const PublishedTransmittance& p : conservativeSlabs)
        EXPECT_NEAR(solveSlab({{{p.opticalDepth, 1, 0}}}, {}).above.whiteSkyTransmittance,
                    p.whiteSkyTransmittance, sixDecimals)
            << p.opticalDepth;
}

TEST(Published, ComputedSlabs) {
    for (const ComputedSlab& p : computedSlabs) {
        SCOPED_TRACE(testing::Message() << p.g << ' ' << p.opticalDepth << ' ' << p.albedo);
        const Face f = solveSlab({{{p.opticalDepth, p.albedo, p.g}}}, {1}).above;
        EXPECT_NEAR(f.reflectance[0], p.reflectance, sixDecimals);
        EXPECT_NEAR(f.transmittance[0], p.transmittance, sixDecimals);
    }
}

TEST(Published, HFunctions) {
    for (const PublishedH& p : conservativeH)
        EXPECT_NEAR(chandrasekharH(p.albedo, p.mu), p.H, 5e-6) << p.mu;
    for (const PublishedH& p : absorbingH)
        EXPECT_NEAR(chandrasekharH(p.albedo, p.mu), p.H, 5e-8) << p.albedo;
    EXPECT_NEAR(hopfConstant(), publishedHopfConstant, 5e-11);
}

}  // namespace
}  // namespace woodcock::oracle
