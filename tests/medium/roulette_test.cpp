// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/estimate.h"
#include "woodcock/grid/field.h"
#include "woodcock/medium/medium.h"
#include "woodcock/medium/tracking.h"

namespace woodcock::test {
namespace {

/// A row of 8 voxels of value 1 (with linear ramps at both ends) of coloured coefficients, whose
/// majorants are twice too high: many null collisions.
Medium colouredRow(Rgb absorption, Rgb scattering) {
    FieldSource source;
    source.tiles = {{{0, 0, 0}, 8, {1}}};
    MediumPart::Description d;
    d.field = std::make_shared<Field>(buildField(source, Storage::Float));
    d.absorption = absorption, d.scattering = scattering;
    d.majorantScale = 2;
    Medium medium;
    medium.parts.emplace_back(d);
    return medium;
}

/// What scatters and what escapes, channel by channel, is known exactly, however weak the path and
/// however the channels differ: Russian roulette may not show in the means.
TEST(DistanceTracking, RouletteIsFair) {
    struct Case {
        Rgb absorption, scattering, throughput;
    };
    const std::vector<Case> cases{
        {Rgb(0.02f), Rgb(0.3f), Rgb(0.03f)},
        {Rgb(0.3f), Rgb(0.1f), Rgb(0.2f)},
        {{0, 0, 0}, {0.5f, 0.1f, 0.01f}, Rgb(0.05f)},
        {{0.4f, 0.2f, 0}, {0.01f, 0.1f, 0.2f}, Rgb(0.05f)},
        {{0.01f, 0.2f, 0.3f}, {0.4f, 0.1f, 0}, {0.02f, 0.08f, 0.01f}},
        {{0.5f, 0.1f, 0.02f}, {0.1f, 0.3f, 0.001f}, {0.3f, 0.02f, 0.001f}}};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        SCOPED_TRACE(i);
        const Case& c = cases[i];
        const Medium medium = colouredRow(c.absorption, c.scattering);
        std::array<Moments, 3> scattered, escaped;
        TrackingCounters counters;
        for (std::uint64_t n = 0; n < 400000; ++n) {
            RandomStream random(hashOf(17, i, n));
            const double u = random.uniformOpenLow();
            DistanceQuery<3> q{{3.5, 3.5, -5}, {0, 0, 1}, 20, u, random, 0.1f, false,
                               c.throughput, 0, -1};
            trackDistance<3>(medium, {&q, 1}, counters);
            for (int k = 0; k < 3; ++k) {
                scattered[static_cast<std::size_t>(k)].add(q.part >= 0 ? q.throughput[k] : 0);
                escaped[static_cast<std::size_t>(k)].add(q.part < 0 ? q.throughput[k] : 0);
            }
        }
        for (int k = 0; k < 3; ++k) {
            SCOPED_TRACE(k);
            const double sigmaT = c.absorption[k] + c.scattering[k];
            const double out = std::exp(-8 * sigmaT);
            const double in = c.scattering[k] / sigmaT * (1 - out);
            expectAgrees(Estimate(escaped[static_cast<std::size_t>(k)]), c.throughput[k] * out, 0.05);
            expectAgrees(Estimate(scattered[static_cast<std::size_t>(k)]), c.throughput[k] * in, 0.05);
        }
    }
}

}  // namespace
}  // namespace woodcock::test
