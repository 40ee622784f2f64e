// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/plan.h"

#include <algorithm>
#include <cmath>

namespace woodcock::trade {
namespace {

/// One picture among which the budget is shared.
struct Share {
    double perSample = 0;  ///< seconds of one sample from all seeds
    double root = 0;       ///< of weight x variance x seconds
    int least = 1, samples = 0;
};

/// Gives each picture its part. Pictures whose part is below the least get the least, and the
/// others share the rest.
void share(std::vector<Share>& shares, double seconds) {
    std::vector<bool> fixed(shares.size(), false);
    for (bool again = true; again;) {
        again = false;
        double left = seconds, roots = 0;
        for (std::size_t i = 0; i < shares.size(); ++i)
            fixed[i] ? left -= shares[i].perSample * shares[i].least : roots += shares[i].root;
        for (std::size_t i = 0; i < shares.size(); ++i) {
            Share& s = shares[i];
            if (fixed[i]) continue;
            const double samples =
                roots > 0 ? std::max(0.0, left) * s.root / roots / s.perSample : 0;
            s.samples = static_cast<int>(std::min(1e6, samples));
            if (s.samples >= s.least) continue;
            s.samples = s.least;
            fixed[i] = again = true;
        }
    }
}

}  // namespace

TradePlan planTrade(const std::vector<PilotCost>& candidates, const PilotCost& reference,
                    double seconds, int least) {
    std::vector<Share> shares;
    double weights = 0;
    const auto add = [&](const PilotCost& c, double weight, int seeds) {
        // The number of seeds does not matter: twice as many with half the samples cost and tell
        // the same.
        shares.push_back({c.secondsPerSample * seeds,
                          std::sqrt(weight * c.variance * c.secondsPerSample), least});
    };
    for (const PilotCost& c : candidates) add(c, c.weight, tradeSeeds), weights += c.weight;
    add(reference, weights, tradeReferenceSeeds);
    share(shares, seconds);

    TradePlan plan;
    for (const Share& s : shares) {
        plan.candidates.push_back(s.samples);
        plan.seconds += s.perSample * s.samples;
    }
    plan.reference = plan.candidates.back();
    plan.candidates.pop_back();
    return plan;
}

PictureSize sizeOfPixels(PictureSize full, double pixels) {
    const double scale = std::min(1.0, std::sqrt(pixels / full.pixels()));
    const auto side = [scale](int n) {
        return std::clamp(static_cast<int>(std::lround(n * scale)), 1, n);
    };
    return {side(full.width), side(full.height)};
}

double leastSamplesPerPixel(std::size_t candidates) {
    return 4 * (3 + tradeSeeds) * static_cast<double>(candidates) + 16 * tradeReferenceSeeds;
}

double goodSamplesPerPixel(std::size_t candidates) { return 4 * leastSamplesPerPixel(candidates); }

}  // namespace woodcock::trade
