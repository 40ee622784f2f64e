// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/evaluate.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/expect_error.h"

namespace woodcock::test {

using namespace trade;

namespace {

constexpr PictureSize size{20, 10};

/// A picture of `samples` samples of unit mean, each with so much deviation and the same bias.
Stage stage(std::mt19937& random, int samples, double deviation, double bias, double seconds) {
    std::normal_distribution<float> noise(static_cast<float>(1 + bias),
                                          static_cast<float>(deviation / std::sqrt(samples)));
    Stage stage{samples, Pixels(static_cast<std::size_t>(3 * size.pixels())), seconds * samples,
                seconds * samples};
    for (float& v : stage.pixels) v = noise(random);
    return stage;
}

/// Half as wide and high as the full picture.
TradeMeasurements measurements(double referenceDeviation) {
    std::mt19937 random(1);
    TradeMeasurements m;
    m.full = {2 * size.width, 2 * size.height}, m.measured = size;
    for (int k = 0; k < tradeReferenceSeeds; ++k)
        m.reference.push_back(stage(random, 100, referenceDeviation, 0, 0.01));
    const auto add = [&](const char* name, bool biased, double deviation, double bias) {
        m.candidates.push_back({{name, "", {}}, biased, 1, 1000, {}});
        for (int k = 0; k < tradeSeeds; ++k)
            m.candidates.back().seeds.push_back({stage(random, 4, deviation, bias, 0.01),
                                                 stage(random, 16, deviation, bias, 0.01)});
    };
    add("plain", false, 1, 0);
    add("fast", true, 0.1, 0.2);
    add("harmless", true, 1, 0);
    return m;
}

TEST(EvaluateTrade, FindsWhatWasPutIn) {
    const TradeResult result = evaluateTrade(measurements(1), 100);
    ASSERT_EQ(result.candidates.size(), 3u);
    const CandidateResult &plain = result.candidates[0], &fast = result.candidates[1];
    EXPECT_NEAR(plain.variance.value, 1, 4 * plain.variance.se);
    EXPECT_LT(plain.variance.se, 0.1);
    EXPECT_NEAR(fast.variance.value, 0.01, 4 * fast.variance.se);
    EXPECT_NEAR(fast.bias.value, 0.2, 4 * fast.bias.se);
    EXPECT_NEAR(fast.squaredBias.value, 0.04, 4 * fast.squaredBias.se);
    EXPECT_TRUE(fast.biasResolved());
    EXPECT_FALSE(result.candidates[2].biasResolved());
    EXPECT_NEAR(plain.secondsPerSample.value, 0.04, 1e-9) << "a quarter of the pixels was measured";
    ASSERT_EQ(plain.points.size(), 2u);
    EXPECT_NEAR(plain.points[0].relMse.value, 0.25, 4 * plain.points[0].relMse.se);
    EXPECT_NEAR(plain.points[1].seconds, 16 * 0.04, 1e-9);
    EXPECT_GT(plain.points[0].flip->value, plain.points[1].flip->value);
    EXPECT_NEAR(result.reference.error.value, 1.0 / 800, 4 * result.reference.error.se);
    EXPECT_EQ(result.reference.samples, 800);
}

// Its squared bias is 0.4^2 with 4 samples and 0.2^2 with 16: it falls as 1 / n.
TEST(EvaluateTrade, DenoisedPicturesHaveABiasThatFalls) {
    TradeMeasurements m = measurements(1);
    std::mt19937 random(2);
    m.candidates.push_back({{"denoised", "", {}}, true, 1, 1000, {}, true});
    for (int k = 0; k < tradeSeeds; ++k) {
        m.candidates.back().seeds.push_back(
            {stage(random, 4, 0.1, 0.4, 0.01), stage(random, 16, 0.1, 0.2, 0.01)});
        for (Stage& s : m.candidates.back().seeds.back()) s.denoiseSeconds = 0.5;
    }
    const TradeResult result = evaluateTrade(m, 0);
    const CandidateResult& denoised = result.candidates.back();
    EXPECT_NEAR(denoised.squaredBias.value, 0.04, 4 * denoised.squaredBias.se);
    EXPECT_NEAR(denoised.model.biasPower, 1, 0.05);
    EXPECT_NEAR(denoised.model.biasSeconds, 16 * 0.04, 1e-9);
    EXPECT_DOUBLE_EQ(denoised.denoiseSeconds, 4 * 0.5) << "a quarter of the pixels was measured";
    EXPECT_NEAR(denoised.points[0].seconds, 2 + 4 * 0.04, 1e-9);
    EXPECT_NEAR(denoised.model.errorAt(2 + 4 * 0.04)->value, 0.16, 0.02);
    EXPECT_NEAR(denoised.points[0].relMse.value, 0.16, 0.02);
    EXPECT_EQ(result.candidates[0].model.fixedSeconds, 0);
    m.denoiserStart = 0.3;
    EXPECT_DOUBLE_EQ(evaluateTrade(m, 0).candidates.back().denoiseSeconds, 0.3 + 4 * 0.2)
        << "what does not grow with the picture";
    EXPECT_DOUBLE_EQ(result.models(Counted::LoadingToo).back().fixedSeconds, 3);
    EXPECT_NE(result.notes.back().find("'denoised' is denoised, in 2"), std::string::npos)
        << result.notes.back();
}

// Unbiased: 1 x 0.04 / t; fast: 0.04 + 0.01 x 0.04 / t. They cross just below a second.
TEST(EvaluateTrade, RecommendsTheUnbiasedAmongEquals) {
    const TradeResult result = evaluateTrade(measurements(1), 0);
    EXPECT_FALSE(result.candidates[0].points[0].flip) << "there was no time for it";
    ASSERT_FALSE(result.equalTime.empty());
    for (const TradeReading& reading : result.equalTime)
        if (reading.target > 1.5) {
            EXPECT_EQ(reading.winner.recommended, 0u) << reading.target;
        }
    EXPECT_TRUE(result.candidates[1].onFront);
    EXPECT_EQ(result.front.front().candidate, 1u);
    bool noted = false;
    for (const std::string& note : result.notes) noted |= note.find("'harmless'") != note.npos;
    EXPECT_TRUE(noted);
}

TEST(EvaluateTrade, ANoisyReferenceJudgesNothing) {
    expectError(ErrorKind::Usage, "too small for the reference to converge",
                [] { evaluateTrade(measurements(15), 0); });
}

}  // namespace
}  // namespace woodcock::test
