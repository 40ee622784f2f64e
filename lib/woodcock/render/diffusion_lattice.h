// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/render/scene.h"

namespace woodcock::render {

/// Radiance inside of a medium that is lit from far away, by the diffusion approximation, in coarse
/// cells. It is near the truth and no more: a control variate for paths; see
/// lanes/lane_diffusion-inl.h.
///
/// In each cell it solves div(D grad phi) = sigma_a phi - q with D = 1 / (3 sigma_tr), where
/// sigma_tr = sigma_a + (1 - g) sigma_s. Around the medium, phi is the mean radiance of what lights
/// it from all sides. q is what sunlight scatters: (1 - g) sigma_s E T / (4 pi), with the
/// irradiance E and the transmittance T of sigma_tr towards the sun; what scatters forwards still
/// counts as sunlight. A path that goes from x to direction d is then expected to bring phi(x) + d
/// . grad phi(x) / sigma_tr (Ishimaru 1978, "Wave Propagation and Scattering in Random Media",
/// chapter 9).
class DiffusionLattice {
public:
    struct Light {
        Rgb environment;  ///< radiance, of all directions alike
        Rgb sun;          ///< irradiance of a surface that faces it
        Vec3d towardsSun{0, 0, 1};
    };
    /// Of a channel in a cell: phi in its middle; how it grows along each axis of the world, per
    /// edge of a cell; and 1 / sigma_tr in edges, or less where it would make radiance negative.
    struct Channel {
        float phi = 0, slope[3] = {}, path = 0;
    };
    struct alignas(64) Cell {
        Channel channels[3];
    };

    /// Null where nothing absorbs, or nothing scatters, or the medium has no end. The medium's
    /// parts stand still.
    static std::unique_ptr<const DiffusionLattice> make(const medium::Medium& medium,
                                                        const Light& light);
    /// The same for a render: null also where it does not pay, as paths scatter too seldom, or
    /// where no light comes from far away. Of several suns the first counts, and none that is of
    /// another light group than the environment.
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
    std::vector<float> sunlight(const Rates& rates, Vec3d towardsSun) const;
    std::vector<float> solve(const Rates& rates, float around,
                             const std::vector<float>& source) const;
    void keep(const std::vector<float>& phi, const Rates& rates, int channel);
    /// Calls act(x, y, z) for the cells that are not at the lattice's border.
    template <class F>
    void forInner(F&& act) const {
        for (int z = 1; z + 1 < cells_.z; ++z)
            for (int y = 1; y + 1 < cells_.y; ++y)
                for (int x = 1; x + 1 < cells_.x; ++x) act(x, y, z);
    }
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
