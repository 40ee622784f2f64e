// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/phase.h"

namespace woodcock::medium {

namespace {

constexpr double even = 1 / (4 * pi);

/// u in [0, 1), after a decision that took the part from `first` to `last` of it.
double within(double u, double first, double last) {
    return last > first ? std::min((u - first) / (last - first), 1 - 0x1p-53) : 0;
}

Turn evenTurn(double u) { return {2 * (1 - u), 2 * u}; }

}  // namespace

double PhaseFunction::valueOfKind(double cosine) const {
    const double own = std::visit([&](const auto& k) { return k.value(cosine); }, *kind_);
    return (1 - isotropic_) * own + isotropic_ * even;
}

PhaseSample PhaseFunction::sampleKind(Vec3d forward, double u0, double u1) const {
    const Turn turn =
        u0 < isotropic_
            ? evenTurn(within(u0, 0, isotropic_))
            : std::visit([&](const auto& k) { return k.sample(within(u0, isotropic_, 1)); },
                         *kind_);
    return {turned(forward, turn, u1), valueOfKind(turn.cosine())};
}

double PhaseFunction::meanCosine() const {
    return (1 - isotropic_) * std::visit([](const auto& k) { return k.meanCosine(); }, *kind_);
}

Rgb PhaseFunction::values(double cosine) const {
    if (!chromatic_) return Rgb(static_cast<float>(value(cosine)));
    const auto& table = std::get<PhaseTable>(*kind_);
    return Rgb::map([&](int c) {
        return static_cast<float>((1 - isotropic_) * table.value(cosine, c) + isotropic_ * even);
    });
}

Rgb PhaseFunction::meanCosines() const {
    if (!chromatic_) return Rgb(static_cast<float>(meanCosine()));
    const auto& table = std::get<PhaseTable>(*kind_);
    return Rgb::map(
        [&](int c) { return static_cast<float>((1 - isotropic_) * table.meanCosine(c)); });
}

PhaseFunction::Mixed PhaseFunction::mixed(double cosine, Rgb throughput) const {
    const Rgb values = this->values(cosine);
    double sum = 0, mean = 0;
    for (int c = 0; c < 3; ++c) {
        sum += double{throughput[c]};
        mean += double{throughput[c]} * double{values[c]};
    }
    if (!(mean > 0)) return {0, Rgb(0.0f)};
    const double density = mean / sum;
    return {density, values * static_cast<float>(1 / density)};
}

PhaseSample PhaseFunction::sampleMixed(Vec3d forward, Rgb throughput, double u0, double u1) const {
    const auto* table = std::get_if<PhaseTable>(kind_.get());
    if (!table) return sample(forward, u0, u1);
    Turn turn{};
    if (u0 < isotropic_) {
        turn = evenTurn(within(u0, 0, isotropic_));
    } else {
        u0 = within(u0, isotropic_, 1);
        const double sum = double{throughput[0]} + double{throughput[1]} + double{throughput[2]};
        double first = 0, last = throughput[0] / sum;
        int channel = 0;
        for (; channel < 2 && u0 >= last; ++channel)
            first = last, last += double{throughput[channel + 1]} / sum;
        // Rounding may leave the last channel more than its share, by 1e-16.
        turn = table->sample(within(u0, first, std::max(last, u0)), channel);
    }
    return {turned(forward, turn, u1), mixed(turn.cosine(), throughput).density};
}

PhaseFunction PhaseFunction::towardsIsotropic(double factor) const {
    if (const auto* k = std::get_if<HenyeyGreenstein>(kind_.get()))
        return HenyeyGreenstein(k->g() * factor);
    if (const auto* k = std::get_if<TwoLobes>(kind_.get())) return k->scaled(factor);
    PhaseFunction wider = *this;
    wider.isotropic_ = 1 - factor * (1 - isotropic_);
    return wider;
}

const char* PhaseFunction::name() const {
    return std::visit([](const auto& k) { return k.name; }, *kind_);
}

}  // namespace woodcock::medium
