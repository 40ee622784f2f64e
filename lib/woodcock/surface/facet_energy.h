// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace woodcock {

/// What rough facets keep from light at their first one, as it is hidden by others: it meets a
/// second one, and more. Of facets that absorb nothing, as far as one scattering tells.
class FacetLosses {
public:
    FacetLosses() = default;
    /// `lost` at each node(), for light that comes at that cosine.
    static constexpr std::size_t nodes = 64;
    static double node(std::size_t i);
    explicit FacetLosses(const std::array<double, nodes>& lost);

    /// Share in [0, 1] of light at this cosine, in (0, 1], to the normal.
    double lost(double cosine) const;
    double mean() const { return mean_; }  ///< of light from all around

    /// Density of directions that leave in the end, in proportion to what is lost at them and to
    /// the cosine: per steradian.
    double density(double cosine) const;
    double sampleCosine(double u) const;

private:
    std::array<double, nodes> lost_{};
    std::array<double, nodes> sum_{};  ///< of what leaves below each node
    double mean_ = 0;
};

/// Both sides of a surface of facets. What is scattered more than once leaves in directions that
/// are those of the light that would be: Kulla and Conty 2017, "Revisiting Physically Based Shading
/// at Imageworks", which keeps energy and reciprocity; which side it leaves by, too.
struct FacetEnergy {
    FacetLosses outside, inside;  ///< of light that comes from there; metals have one side
    /// Of what is scattered again, the share that leaves by the side where it came from.
    double backOutside = 1, backInside = 1;
};

/// Of GGX of this alpha, between indices of which the inner one is `eta` times the outer one; 0:
/// metal. Worked out once for each pair, in a tenth of a second; valid until the thread's next
/// call but seven, or as long as the copy is kept.
const FacetEnergy& facetEnergy(double alpha, double eta);

}  // namespace woodcock
