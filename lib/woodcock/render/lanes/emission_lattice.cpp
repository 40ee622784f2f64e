// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/lanes/emission_lattice.h"

#include <algorithm>
#include <cmath>

namespace woodcock::render {

namespace {

/// A float within a wider cell would not be exact enough.
constexpr int widestCellLog2 = 7;
/// They take 5 MB.
constexpr double mostLatticeCells = 1 << 18;

bool isStillAndEnds(const medium::EmissionPart& part) {
    const medium::EmissionPart::Description& d = part.description();
    if (!d.field || d.field->limits() || d.motion || d.movement) return false;
    for (int c = 0; c < d.field->channels(); ++c)
        if (d.field->background(c) != 0) return false;
    return true;
}

float largestOf(grid::Range range) { return std::max(std::abs(range.min), std::abs(range.max)); }

}  // namespace

std::optional<EmissionLattice> EmissionLattice::make(const MediumSummary& medium) {
    EmissionLattice lattice;
    if (medium.medium->parts.empty() || medium.emission.empty()) return {};
    lattice.group_ = medium.emission.front().description().group;
    for (const medium::EmissionPart& part : medium.emission)
        if (!isStillAndEnds(part) || part.description().group != lattice.group_) return {};
    if (!lattice.place(medium)) return {};
    for (const medium::MediumPart& part : medium.medium->parts) {
        const Source& source = lattice.extinction_.emplace_back(
            lattice.sourceOf(*part.field(), part.description().worldFromIndex, part.extinction()));
        const std::vector<Survey> found = lattice.survey(source, part.majorants());
        for (std::size_t i = 0; i < found.size(); ++i) {
            Cell& cell = lattice.content_[i];
            cell.extinction += source.scale * found[i].mean;
            cell.residual +=
                source.scale.maximum() * std::max(found[i].most - found[i].mean, found[i].mean);
        }
    }
    for (const medium::EmissionPart& part : medium.emission) {
        const medium::EmissionPart::Description& d = part.description();
        const Source& source =
            lattice.emission_.emplace_back(lattice.sourceOf(*d.field, d.worldFromIndex, d.scale));
        const std::vector<Survey> found = lattice.survey(source, part.majorants());
        for (std::size_t i = 0; i < found.size(); ++i)
            lattice.content_[i].glow +=
                source.scale.maximum() * std::max(found[i].mean, 0.5f * found[i].most);
    }
    for (Cell& cell : lattice.content_) {
        if (cell.residual > 0) cell.perResidual = 1 / cell.residual;
        if (cell.glow > 0) cell.perGlow = 1 / cell.glow;
    }
    lattice.findTypicalGlow();
    return lattice;
}

/// Chooses box and cells. False: there would be too many.
bool EmissionLattice::place(const MediumSummary& medium) {
    const Affine3d indexFromWorld =
        medium.medium->parts.front().description().worldFromIndex.inverse();
    Box3d box;
    const auto add = [&](const Affine3d& worldFromIndex, const Box3d& extent) {
        if (!extent.empty()) box.add((indexFromWorld * worldFromIndex).box(extent));
    };
    for (const medium::MediumPart& part : medium.medium->parts)
        add(part.description().worldFromIndex, part.support());
    for (const medium::EmissionPart& part : medium.emission)
        add(part.description().worldFromIndex, part.extent());
    const Vec3d size = box.size();
    const auto cellsAlong = [&](int i) { return std::floor(std::ldexp(size[i], -log2Edge_)) + 2; };
    while (!(cellsAlong(0) * cellsAlong(1) * cellsAlong(2) <= mostLatticeCells))
        if (++log2Edge_ > widestCellLog2) return false;
    Vec3d low;
    for (int i = 0; i < 3; ++i) {
        cells_[i] = static_cast<int>(cellsAlong(i));
        // Cells coincide with the blocks of majorants.
        low[i] = std::floor(box.lower[i] / edge()) * edge();
    }
    latticeFromWorld_ = Affine3d::translate(-low) * indexFromWorld;
    content_.resize(numberOf(cells_ - Vec3i{1, 1, 1}) + 1);
    return true;
}

EmissionLattice::Source EmissionLattice::sourceOf(const grid::Field& field,
                                                  const Affine3d& worldFromIndex, Rgb scale) const {
    const Affine3d map = worldFromIndex.inverse() * latticeFromWorld_.inverse();
    double apart = 0;  // how far the axes are from those of the lattice
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            apart += std::abs(map.column[static_cast<std::size_t>(column)][row] -
                              (row == column ? 1 : 0));
    constexpr double rounding = 1e-12;
    return {&field, map, apart < rounding, scale};
}

std::vector<EmissionLattice::Survey> EmissionLattice::survey(
    const Source& source, const grid::MajorantGrid& majorants) const {
    std::vector<Survey> found(content_.size());
    const Affine3d latticeFromIndex = source.indexFromLattice.inverse();
    majorants.forEachEntry([&](Vec3i first, int log2Size, grid::Range range) {
        const float bound = largestOf(range);
        if (!(bound > 0)) return;
        const Vec3d lower = first.as<double>();
        const double size = std::ldexp(1.0, log2Size);
        const Box3d cube = latticeFromIndex.box({lower, lower + Vec3d{size, size, size}});
        const auto cellOf = [&](double at, int i) {
            return static_cast<int>(
                std::floor(std::clamp(at / edge(), -1.0, static_cast<double>(cells_[i]))));
        };
        constexpr double rounding = 1e-9;  // of a voxel
        Vec3i from, to;
        for (int i = 0; i < 3; ++i) {
            from[i] = std::max(0, cellOf(cube.lower[i] + rounding, i));
            to[i] = std::min(cells_[i] - 1, cellOf(cube.upper[i] - rounding, i));
        }
        forEachCell(from, to, [&](Vec3i cell) {
            float& most = found[numberOf(cell)].most;
            most = std::max(most, bound);
        });
    });
    forEachCell({0, 0, 0}, cells_ - Vec3i{1, 1, 1}, [&](Vec3i at) {
        Survey& cell = found[numberOf(at)];
        if (!(cell.most > 0)) return;
        constexpr int side = 2, points = side * side * side;
        for (int i = 0; i < points; ++i) {
            const Vec3d within{i % side + 0.5, i / side % side + 0.5, i / side / side + 0.5};
            const Vec3d p = source.index((at.as<double>() + within * (1.0 / side)) * edge());
            float most = 0;
            for (int c = 0; c < source.field->channels(); ++c)
                most = std::max(most, std::abs(source.field->trilinear(p, c)));
            cell.mean += most / points;
        }
    });
    return found;
}

void EmissionLattice::findTypicalGlow() {
    double sum = 0, cells = 0;
    for (const Cell& cell : content_) sum += double{cell.glow}, cells += cell.glow > 0;
    if (cells == 0) return;
    // The mean of parallel rays through a body is its volume over its outline's.
    const double worldEdge = edge() / std::cbrt(std::abs(latticeFromWorld_.determinant()));
    typicalGlow_ = static_cast<float>(sum / std::pow(cells, 2.0 / 3) * worldEdge);
}

}  // namespace woodcock::render
