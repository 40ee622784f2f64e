// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/plates.h"

#include <algorithm>
#include <cmath>

namespace woodcock::oracle {

namespace {

/// Cosine in index `to` of a beam at `mu` in index `from`; 0 from the critical angle on.
double refracted(double mu, double from, double to) {
    const double ratio = from / to;
    return std::sqrt(std::max(0.0, 1 - ratio * ratio * (1 - mu * mu)));
}

/// Some plates: power reflected on either side, and transmitted, which is the same both ways.
struct Pile {
    double above = 0, below = 0, through = 1;
};

Pile added(const Pile& upper, const Pile& lower) {
    const double between = upper.through / (1 - upper.below * lower.above);
    return {
        upper.above + upper.through * lower.above * between,
        lower.below + lower.through * lower.through * upper.below / (1 - upper.below * lower.above),
        lower.through * between};
}

template <class Reflectance>
PlateAnswer answer(const std::vector<Plate>& plates, double mu, double outside,
                   Reflectance reflectance) {
    Pile pile;
    double index = outside;
    const auto face = [&](double next) {
        const double r = reflectance(refracted(mu, outside, index), index, next);
        pile = added(pile, {r, r, 1 - r});
        index = next;
    };
    for (const Plate& plate : plates) {
        face(plate.index);
        const double cosine = refracted(mu, outside, index);
        if (!(cosine > 0)) return {pile.above, 0};  // nothing came through that face
        pile = added(pile, {0, 0, std::exp(-plate.opticalDepth / cosine)});
    }
    face(outside);
    return {pile.above, pile.through};
}

}  // namespace

FresnelReflectance fresnelReflectances(double mu, double from, double to) {
    if (from == to) return {0, 0};
    const double inside = refracted(mu, from, to);
    const double s = (from * mu - to * inside) / (from * mu + to * inside);
    const double p = (to * mu - from * inside) / (to * mu + from * inside);
    return inside > 0 ? FresnelReflectance{s * s, p * p} : FresnelReflectance{1, 1};
}

PlateAnswer unpolarisedPlates(const std::vector<Plate>& plates, double mu, double outside) {
    return answer(plates, mu, outside, [](double cosine, double from, double to) {
        return fresnelReflectances(cosine, from, to).mean();
    });
}

PlateAnswer polarisedPlates(const std::vector<Plate>& plates, double mu, double outside) {
    const PlateAnswer s = answer(plates, mu, outside, [](double cosine, double from, double to) {
        return fresnelReflectances(cosine, from, to).s;
    });
    const PlateAnswer p = answer(plates, mu, outside, [](double cosine, double from, double to) {
        return fresnelReflectances(cosine, from, to).p;
    });
    return {(s.reflectance + p.reflectance) / 2, (s.transmittance + p.transmittance) / 2};
}

}  // namespace woodcock::oracle
