// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/render/scene.h"

namespace woodcock::render {

/// Radiance inside of a medium that is lit from all sides alike, as a multiple of the radiance
/// around it: by the diffusion approximation, in coarse cells. It is near the truth and no more: a
/// control variate for paths that are about to leave the medium; see lanes/lane_diffusion-inl.h.
///
/// In each cell it solves div(D grad phi) = sigma_a phi with D = 1 / (3 sigma_tr), where sigma_tr =
/// sigma_a + (1 - g) sigma_s, and phi = 1 around the medium. A path that goes from x to direction d
/// is then expected to bring phi(x) + d . grad phi(x) / sigma_tr (Ishimaru 1978, "Wave Propagation
/// and Scattering in Random Media", chapter 9).
class DiffusionLattice {
public:
    /// Of a channel in a cell: phi in its middle; how it grows along each axis of the world, per
    /// edge of a cell; and 1 / sigma_tr in edges, or less where it would make radiance negative.
    struct Channel {
        float phi = 1, slope[3] = {}, path = 0;
    };
    struct alignas(64) Cell {
        Channel channels[3];
    };

    /// Null where nothing absorbs, or nothing scatters, or the medium has no end. The medium's
    /// parts stand still.
    static std::unique_ptr<const DiffusionLattice> make(const medium::Medium& medium);
    /// The same for a render: null also where it does not pay, as paths scatter too seldom, or
    /// where no light comes from far away.
    static std::unique_ptr<const DiffusionLattice> make(const Scene& scene);

    /// From world space to cells, the first of which begins at the origin.
    const Affine3d& latticeFromWorld() const { return latticeFromWorld_; }
    Vec3i cells() const { return cells_; }
    const Cell* content() const { return content_.data(); }  ///< x first, then y

private:
    /// Of a channel, for each cell: sigma_a and sigma_tr, times the edge of a cell.
    struct Rates {
        std::vector<float> absorption, transport;
    };

    DiffusionLattice() = default;
    void survey(const medium::Medium& medium, Rates rates[3]) const;
    void surveyRay(const medium::MediumPart& part, int row, int ray, Rates rates[3]) const;
    std::vector<float> solve(const Rates& rates) const;
    void keep(const std::vector<float>& phi, const Rates& rates, int channel);
    std::size_t numberOf(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(cells_.y) +
                static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(cells_.x) +
               static_cast<std::size_t>(x);
    }

    Affine3d latticeFromWorld_;
    Vec3d origin_;
    double edge_ = 1;
    Vec3i cells_;
    std::vector<Cell> content_;
};

}  // namespace woodcock::render
