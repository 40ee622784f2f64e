// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace woodcock::surface {

/// How much light single scattering on rough facets loses, because other facets hide it: in truth
/// it meets a second facet, and more. For facets that absorb nothing.
class FacetLosses {
public:
    FacetLosses() = default;
    /// `lost` at each node(): the share lost of light that comes at that cosine.
    static constexpr std::size_t nodes = 64;
    static double node(std::size_t i);
    explicit FacetLosses(const std::array<double, nodes>& lost);

    /// Share in [0, 1] that is lost of light at this cosine, in (0, 1], to the normal.
    double lost(double cosine) const;
    double mean() const { return mean_; }  ///< of light from all around

    /// Density, per steradian, of the directions in which this light finally leaves: in proportion
    /// to lost(cosine) and to the cosine.
    double density(double cosine) const;
    double sampleCosine(double u) const;

private:
    std::array<double, nodes> lost_{};
    std::array<double, nodes> sum_{};  ///< of what leaves below each node
    double mean_ = 0;
};

/// The losses on both sides of a rough surface. Light that is scattered more than once leaves in
/// the directions, and on the sides, in which light would be lost: Kulla and Conty 2017,
/// "Revisiting Physically Based Shading at Imageworks". This keeps energy and reciprocity.
struct FacetEnergy {
    FacetLosses outside, inside;  ///< of light that comes from there; metals have one side
    /// The share of light scattered more than once that leaves on the side from which it came.
    double backOutside = 1, backInside = 1;
};

/// For GGX of this alpha. The inner index of refraction is `eta` times the outer one; 0: metal.
/// Each pair is computed once, in a tenth of a second. The reference is valid until the thread's
/// eighth call after this one; a copy is valid for ever.
const FacetEnergy& facetEnergy(double alpha, double eta);

}  // namespace woodcock::surface
