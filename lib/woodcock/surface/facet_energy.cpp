// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/facet_energy.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "woodcock/surface/fresnel.h"
#include "woodcock/surface/microfacet.h"

namespace woodcock::surface {

namespace {

/// Antiderivative of (p + q t) 4 t^3 at t: of twice mu times a linear loss, by mu = t^2.
double below(double p, double q, double t) { return t * t * t * t * (p + 0.8 * q * t); }

/// Share of light at this cosine that its first facet sends to other facets. eta 0: all facets are
/// mirrors.
double lostAt(double alpha, double eta, double cosine) {
    constexpr int across = 128;
    const Ggx facets(alpha);
    const Vec3d out{std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine};
    double kept = 0;
    for (int i = 0; i < across; ++i)
        for (int j = 0; j < across / 2; ++j) {  // the other half is its mirror image
            const Vec3d facet = facets.sampleVisible(out, (j + 0.5) / across, (i + 0.5) / across);
            const double c = dot(out, facet);
            if (!(c > 0)) continue;
            const Vec3d mirror = facet * (2 * c) - out;
            const double above = mirror.z > 0 ? facets.shadowing(out, mirror) : 0;
            if (eta == 0) {
                kept += above;
                continue;
            }
            const Refraction split = refraction(c, eta);
            kept += split.reflectance * above;
            if (split.reflectance == 1) continue;
            const Vec3d bent = normalize(facet * (c / eta - split.cosine) - out / eta);
            if (bent.z < 0) kept += (1 - split.reflectance) * facets.shadowing(out, bent);
        }
    return std::clamp(1 - kept / (across * across / 2), 0.0, 1.0);
}

FacetLosses lossesOf(double alpha, double eta) {
    std::array<double, FacetLosses::nodes> lost;
    for (std::size_t i = 0; i < lost.size(); ++i)
        lost[i] = lostAt(alpha, eta, std::max(FacetLosses::node(i), 1e-9));
    return FacetLosses(lost);
}

FacetEnergy energyOf(double alpha, double eta) {
    FacetEnergy energy;
    energy.outside = lossesOf(alpha, eta);
    if (eta == 0) return energy;
    energy.inside = lossesOf(alpha, 1 / eta);
    // In uniform light from all around, as much light passes from one side to the other as comes
    // back; inside there is eta^2 times as much of it.
    const double outside = energy.outside.mean(), inside = energy.inside.mean() * eta * eta;
    if (!(outside + inside > 0)) return energy;
    energy.backOutside = outside / (outside + inside);
    energy.backInside = inside / (outside + inside);
    return energy;
}

}  // namespace

double FacetLosses::node(std::size_t i) {
    const double t = static_cast<double>(i) / (nodes - 1);
    return t * t;
}

FacetLosses::FacetLosses(const std::array<double, nodes>& lost) : lost_(lost) {
    constexpr double step = 1.0 / (nodes - 1);
    for (std::size_t i = 1; i < nodes; ++i) {
        const double a = static_cast<double>(i - 1) * step, b = static_cast<double>(i) * step;
        const double q = (lost_[i] - lost_[i - 1]) / step, p = lost_[i - 1] - q * a;
        sum_[i] = sum_[i - 1] + std::max(0.0, below(p, q, b) - below(p, q, a));
    }
    mean_ = sum_.back();
}

double FacetLosses::lost(double cosine) const {
    const double place = std::sqrt(std::clamp(cosine, 0.0, 1.0)) * (nodes - 1);
    const auto i = std::min(static_cast<std::size_t>(place), nodes - 2);
    const double f = place - static_cast<double>(i);
    return lost_[i] * (1 - f) + lost_[i + 1] * f;
}

double FacetLosses::density(double cosine) const {
    return mean_ > 0 && cosine > 0 ? lost(cosine) * cosine / (pi * mean_) : 0;
}

double FacetLosses::sampleCosine(double u) const {
    if (!(mean_ > 0)) return std::sqrt(u);
    const double wanted = u * mean_;
    const auto next = std::upper_bound(sum_.begin() + 1, sum_.end() - 1, wanted);
    const auto i = static_cast<std::size_t>(next - sum_.begin());
    constexpr double step = 1.0 / (nodes - 1);
    double low = static_cast<double>(i - 1) * step, high = static_cast<double>(i) * step;
    const double q = (lost_[i] - lost_[i - 1]) / step, p = lost_[i - 1] - q * low;
    const double start = below(p, q, low) - sum_[i - 1];
    for (int round = 0; round < 40; ++round) {
        const double middle = (low + high) / 2;
        (below(p, q, middle) - start < wanted ? low : high) = middle;
    }
    const double t = (low + high) / 2;
    return std::clamp(t * t, 1e-12, 1.0);
}

const FacetEnergy& facetEnergy(double alpha, double eta) {
    using Key = std::pair<double, double>;
    using Known = std::shared_ptr<const FacetEnergy>;
    // A cache of a pure function: only time depends on it.
    struct Recent {
        Key key{-1, -1};
        Known energy;
    };
    static thread_local std::array<Recent, 8> recent;
    const Key key{alpha, eta};
    for (const Recent& r : recent)
        if (r.key == key) return *r.energy;
    static thread_local std::size_t oldest = 0;
    Recent& place = recent[oldest++ % recent.size()];
    static std::mutex mutex;
    static std::map<Key, Known> all;
    const std::lock_guard lock(mutex);
    constexpr std::size_t most = 4096;  // a few MB
    if (all.size() >= most && !all.contains(key)) all.clear();
    Known& known = all[key];
    if (!known) known = std::make_shared<const FacetEnergy>(energyOf(alpha, eta));
    place = {key, known};
    return *known;
}

}  // namespace woodcock::surface
