// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/medium/phase/henyey_greenstein.h"
#include "woodcock/render/scene.h"

namespace woodcock::render {

/// Radiance inside of a medium that is lit from far away, in coarse cells. It is near the truth and
/// no more: a control variate for paths; see lanes/lane_expected-inl.h.
///
/// Deep inside, the diffusion approximation is good (Ishimaru 1978, "Wave Propagation and
/// Scattering in Random Media", chapter 9): div(D grad phi) = sigma_a phi - q, with D = 1 / (3
/// sigma_tr) and sigma_tr = sigma_a + (1 - g) sigma_s. Around the medium, phi is the mean radiance
/// of what lights it from all sides. q is what sunlight scatters: (1 - g) sigma_s E T / (4 pi),
/// with the irradiance E and the transmittance T of sigma_tr towards the sun.
///
/// One sweep of discrete ordinates over that mends what diffusion has wrong in thin media and near
/// surfaces. In it, sunlight is what sigma_t lets through, and is scattered by the whole phase
/// function. The sweep's first two moments are kept: a path that goes from x to direction v is
/// expected to bring phi(x) + v . ahead(x).
class RadianceLattice {
public:
    struct Light {
        Rgb environment;  ///< radiance, of all directions alike
        Rgb sun;          ///< irradiance of a surface that faces it
        Vec3d towardsSun{0, 0, 1};
    };
    /// Of a channel in a cell, as multiples of unit(): phi in its middle; how it grows along each
    /// axis of the world, per edge of a cell; `ahead`; and the irradiance that is left of the sun.
    struct Channel {
        float phi = 0, slope[3] = {}, ahead[3] = {}, sun = 0;
    };
    struct alignas(32) Cell {
        Channel channels[3];
    };
    /// What a collision's next event brings is expected by a phase function of Henyey and
    /// Greenstein with at most this g forwards: cells are too coarse for more.
    static constexpr float mostPeaked = 0.5f;

    /// Null where nothing scatters, nothing shines, or the medium has no end; and where every path
    /// brings the same, as a grey medium in an even environment takes nothing. The medium's parts
    /// stand still.
    static std::unique_ptr<const RadianceLattice> make(const medium::Medium& medium,
                                                       const Light& light);
    /// The same for a render: null also in most scenes that are not traced in lanes. Of several
    /// suns the first counts, and none that is of another light group than the environment.
    static std::unique_ptr<const RadianceLattice> make(const Scene& scene);

    /// From world space to cells, the first of which begins at the origin.
    const Affine3d& latticeFromWorld() const { return latticeFromWorld_; }
    double edge() const { return edge_; }  ///< of a cell, in the world
    Vec3i cells() const { return cells_; }
    const Cell* content() const { return content_.data(); }  ///< x first, then y
    /// Where the medium is grey, its radiance is one channel of the mean colour of the lights.
    Rgb unit() const { return unit_; }

    /// What a path is expected to bring, as a multiple of unit(), that scatters at a point of the
    /// world, having come in a direction.
    template <int N>
    Spectrum<N> scattered(Vec3d at, Vec3d direction) const;

private:
    /// Of a channel, for each cell: sigma_a, sigma_s and sigma_tr, times the edge of a cell.
    struct Rates {
        std::vector<float> absorption, scattering, transport;
    };

    RadianceLattice() = default;
    void survey(const medium::Medium& medium, Rates rates[3]) const;
    void surveyRay(const medium::MediumPart& part, int row, int ray, Rates rates[3]) const;
    void solve(const Rates& rates, const Light& light, int channel);
    std::vector<float> sunlight(const std::vector<float>& rates, Vec3d towardsSun) const;
    std::vector<float> diffuse(const Rates& rates, float around,
                               const std::vector<float>& source) const;
    void sweep(const Rates& rates, const Light& light, int channel, const std::vector<float>& phi);
    template <class F>
    void sweepOrdinate(Vec3d direction, const Rates& rates, float around, F&& source,
                       std::vector<float>& radiance) const;
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
    Rgb unit_{1, 1, 1};
    Vec3d towardsSun_;
    float meanCosine_ = 0;  // of what scatters, by how much it does
    std::vector<Cell> content_;
};

template <int N>
Spectrum<N> RadianceLattice::scattered(Vec3d at, Vec3d direction) const {
    const Vec3d inside = latticeFromWorld_.point(at);
    int cell[3];
    float within[3];
    for (int i = 0; i < 3; ++i) {
        cell[i] = static_cast<int>(std::clamp(inside[i], 0.0, cells_[i] - 1.0));
        within[i] = static_cast<float>(inside[i] - cell[i]) - 0.5f;
    }
    const Cell& content = content_[numberOf(cell[0], cell[1], cell[2])];
    const auto phase = static_cast<float>(medium::henyeyGreenstein(
        dot(direction, towardsSun_), double{std::min(meanCosine_, mostPeaked)}));
    return Spectrum<N>::map([&](int c) {
        const Channel& channel = content.channels[c];
        float sum = channel.phi + phase * channel.sun;
        for (int i = 0; i < 3; ++i)
            sum += within[i] * channel.slope[i] +
                   meanCosine_ * static_cast<float>(direction[i]) * channel.ahead[i];
        return sum;
    });
}

}  // namespace woodcock::render
