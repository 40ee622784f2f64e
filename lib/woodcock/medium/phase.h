// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <memory>
#include <string>
#include <variant>

#include "woodcock/base/spectrum.h"
#include "woodcock/medium/phase/draine.h"
#include "woodcock/medium/phase/fournier_forand.h"
#include "woodcock/medium/phase/henyey_greenstein.h"
#include "woodcock/medium/phase/mie.h"
#include "woodcock/medium/phase/phase_table.h"
#include "woodcock/medium/phase/rayleigh.h"
#include "woodcock/medium/phase/two_lobes.h"

namespace woodcock::medium {

/// How a medium scatters light: the density, per steradian, with which it turns light by an angle.
/// Each integrates to one over the sphere. Cosines are between the way that light travelled before
/// and after. A value of one of a closed set of kinds; phase/ has a file for each.
///
/// A kind has value(cosine), sample(u) in proportion to it, and meanCosine(). The kind that has a
/// column for each colour channel is `chromatic`: it is sampled by a mixture of the channels, and
/// weights carry the difference.
class PhaseFunction {
public:
    using Kind = std::variant<HenyeyGreenstein, TwoLobes, Rayleigh, Draine, MieDroplets,
                              FournierForand, PhaseTable>;

    /// Isotropic.
    PhaseFunction() : PhaseFunction(HenyeyGreenstein(0)) {}
    template <class K>
        requires(!std::same_as<K, PhaseFunction> && !std::is_arithmetic_v<K> &&
                 std::constructible_from<Kind, K>)
    PhaseFunction(K kind) : kind_(std::make_shared<const Kind>(std::move(kind))) {
        if constexpr (std::same_as<K, HenyeyGreenstein>)
            g_ = std::get<HenyeyGreenstein>(*kind_).g();
        else if constexpr (std::same_as<K, PhaseTable>)
            chromatic_ = std::get<PhaseTable>(*kind_).chromatic();
        henyeyGreenstein_ = std::same_as<K, HenyeyGreenstein>;
    }

    /// Of a chromatic function the mean of the channels.
    double value(double cosine) const {
        return henyeyGreenstein_ ? henyeyGreenstein(cosine, g_) : valueOfKind(cosine);
    }
    /// Samples a direction around unit vector `forward` in proportion to value(), by u in [0, 1)^2.
    PhaseSample sample(Vec3d forward, double u0, double u1) const {
        return henyeyGreenstein_ ? sampleHenyeyGreenstein(forward, g_, u0, u1)
                                 : sampleKind(forward, u0, u1);
    }
    double meanCosine() const;

    // ---- for each colour channel

    bool chromatic() const { return chromatic_; }
    /// The density of each channel.
    Rgb values(double cosine) const;
    Rgb meanCosines() const;
    /// How light of `throughput` is scattered by a chromatic function: the density of sampling, in
    /// which each channel counts in proportion to its throughput, and each channel's value over it.
    /// So no weight carries more than the sum of the channels; see collide() in tracking.cpp for
    /// the same choice among distances.
    struct Mixed {
        double density;
        Rgb weight;
    };
    Mixed mixed(double cosine, Rgb throughput) const;
    /// Samples a direction by the density of mixed().
    PhaseSample sampleMixed(Vec3d forward, Rgb throughput, double u0, double u1) const;

    /// A function whose mean cosine is `factor`, in [0, 1], times this one's. Henyey-Greenstein's
    /// lobes become wider, with g times the factor. Any other kind is mixed with isotropic
    /// scattering.
    PhaseFunction towardsIsotropic(double factor) const;

    /// The kind as scene files have it, such as "two_lobe".
    const char* name() const;
    const Kind& kind() const { return *kind_; }

private:
    double valueOfKind(double cosine) const;
    PhaseSample sampleKind(Vec3d forward, double u0, double u1) const;

    std::shared_ptr<const Kind> kind_;
    double g_ = 0;  // of Henyey-Greenstein, which is by far the most common: it is inlined
    bool henyeyGreenstein_ = true, chromatic_ = false;
    double isotropic_ = 0;  // the share of isotropic scattering
};

/// For whatever has a direction and no medium.
inline const PhaseFunction isotropicScattering;

}  // namespace woodcock::medium
