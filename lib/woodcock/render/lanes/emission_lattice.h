// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "woodcock/render/flight.h"

namespace woodcock::render {

/// What is known of a medium's extinction and emission in cubes of voxels, for rays that look for
/// what glows: see EmissionTracer. Positions are in voxels of the medium's first part, from the
/// lattice's lower corner.
class EmissionLattice {
public:
    /// Per world unit. Where a rate is 0, `none` is its inverse.
    struct alignas(32) Cell {
        static constexpr float none = 1e30f;
        Rgb extinction;                          ///< roughly the mean of sigma_t
        float residual = 0, perResidual = none;  ///< no channel of sigma_t differs from it by more
        float glow = 0, perGlow = none;          ///< of the order of q; positive wherever q may be
    };
    /// A field of the medium: sigma_t or q is the field at an index position times `scale`.
    struct Source {
        const grid::Field* field;
        Affine3d indexFromLattice;
        bool isTranslation;  ///< the map is
        Rgb scale;

        Vec3d index(Vec3d position) const {
            return isTranslation ? position + indexFromLattice.translation
                                 : indexFromLattice.point(position);
        }
    };

    /// Nothing where something moves or is not of voxels, where what glows is of several light
    /// groups, or where cells of 128 voxels would be too many.
    static std::optional<EmissionLattice> make(const MediumSummary& medium);

    const Affine3d& latticeFromWorld() const { return latticeFromWorld_; }
    Vec3i cells() const { return cells_; }
    int edge() const { return 1 << log2Edge_; }  ///< of a cell, in voxels
    Box3d box() const { return {{}, (cells_ * edge()).as<double>()}; }
    /// The content of all cells, x first, then y.
    const std::vector<Cell>& content() const { return content_; }
    const std::vector<Source>& extinction() const { return extinction_; }
    const std::vector<Source>& emission() const { return emission_; }
    /// The integral of Cell::glow along a ray through what glows, roughly: radiance.
    float typicalGlow() const { return typicalGlow_; }
    std::uint8_t group() const { return group_; }  ///< the light group of what glows

private:
    /// Of one field, in a cell: a bound of its values, and their mean at some points.
    struct Survey {
        float most = 0, mean = 0;
    };

    EmissionLattice() = default;
    bool place(const MediumSummary& medium);
    Source sourceOf(const grid::Field& field, const Affine3d& worldFromIndex, Rgb scale) const;
    std::vector<Survey> survey(const Source& source, const grid::MajorantGrid& majorants) const;
    void findTypicalGlow();
    std::size_t numberOf(Vec3i cell) const {
        return (static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(cells_.y) +
                static_cast<std::size_t>(cell.y)) *
                   static_cast<std::size_t>(cells_.x) +
               static_cast<std::size_t>(cell.x);
    }
    /// Calls act(cell) for those from one to another, both included.
    template <class F>
    static void forEachCell(Vec3i from, Vec3i to, F&& act) {
        for (int z = from.z; z <= to.z; ++z)
            for (int y = from.y; y <= to.y; ++y)
                for (int x = from.x; x <= to.x; ++x) act(Vec3i{x, y, z});
    }

    Affine3d latticeFromWorld_;
    Vec3i cells_;
    int log2Edge_ = 3;
    std::vector<Cell> content_;
    std::vector<Source> extinction_, emission_;
    float typicalGlow_ = 0;
    std::uint8_t group_ = 0;
};

}  // namespace woodcock::render
