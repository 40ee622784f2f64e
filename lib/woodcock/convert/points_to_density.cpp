// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/points_to_density.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"
#include "woodcock/convert/limits.h"
#include "woodcock/convert/openvdb_lattice.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_trees.h"
#include "woodcock/mesh/triangle_mesh.h"

namespace woodcock::convert {

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

/// A point in index space.
struct Bump {
    Vec3d centre;
    double radius = 0, peak = 0;
    Vec3i lower, upper;  ///< leaves that it may reach, in units of leaves
};

/// A point's share in a leaf. Sorted, leaves come one after another, and each has its points in the
/// order of the file.
struct Share {
    std::array<int, 3> leaf;
    std::uint32_t point;
    auto operator<=>(const Share&) const = default;
};

void requireSound(const PointCloud& cloud, const PointsToDensityOptions& options) {
    requireVoxel(options.voxel);
    if (!(options.radius >= 0) || !std::isfinite(options.radius))
        throw usageError("a point's radius of {}; it must be positive", options.radius);
    if (cloud.points.empty()) throw inputError("there are no points");
    if (cloud.points.size() > std::numeric_limits<std::uint32_t>::max())
        throw inputError("{} points; at most {} are possible", cloud.points.size(),
                         std::numeric_limits<std::uint32_t>::max());
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        if (!isFinite(cloud.points[i])) throw inputError("point {} is not finite", i + 1);
        if (!cloud.radii.empty() && !(cloud.radii[i] >= 0 && std::isfinite(cloud.radii[i])))
            throw inputError("point {} has a radius of {}", i + 1, cloud.radii[i]);
        if (!cloud.weights.empty() && !(cloud.weights[i] >= 0 && std::isfinite(cloud.weights[i])))
            throw inputError("point {} has a density of {}", i + 1, cloud.weights[i]);
    }
}

class Summer {
public:
    Summer(const PointCloud& cloud, const PointsToDensityOptions& options, const Lattice& lattice)
        : options_(options), lattice_(lattice) {
        makeBumps(cloud);
        findShares();
    }

    std::size_t widened() const { return widened_; }

    openvdb::FloatTree::Ptr sum() const {
        std::vector<std::size_t> begins;
        for (std::size_t i = 0; i < shares_.size(); ++i)
            if (i == 0 || shares_[i].leaf != shares_[i - 1].leaf) begins.push_back(i);
        begins.push_back(shares_.size());
        requireVoxels(512.0 * static_cast<double>(begins.size() - 1), options_.voxel,
                      options_.mostVoxels);
        std::vector<std::unique_ptr<Leaf>> leaves(begins.size() - 1);
        tbb::parallel_for(std::size_t{0}, leaves.size(),
                          [&](std::size_t i) { leaves[i] = makeLeaf(begins[i], begins[i + 1]); });
        auto tree = std::make_shared<openvdb::FloatTree>(0.0f);
        for (std::unique_ptr<Leaf>& leaf : leaves)
            if (leaf) tree->addLeaf(leaf.release());
        return tree;
    }

private:
    void makeBumps(const PointCloud& cloud) {
        constexpr double leastRadius = 1.5;  // voxels: less falls between them
        const double usual = options_.radius > 0 ? options_.radius / options_.voxel : 2;
        bumps_.resize(cloud.points.size());
        for (std::size_t i = 0; i < bumps_.size(); ++i) {
            Bump& bump = bumps_[i];
            bump.centre = lattice_.index(cloud.points[i]);
            double radius =
                cloud.radii.empty() ? usual : static_cast<double>(cloud.radii[i]) / options_.voxel;
            bump.peak = cloud.weights.empty() ? 1 : static_cast<double>(cloud.weights[i]);
            if (radius < leastRadius) {
                ++widened_;
                if (!options_.normalised) bump.peak *= std::pow(radius / leastRadius, 3);
                radius = leastRadius;
            }
            bump.radius = radius;
            if (options_.normalised)  // the integral of the kernel is 64 pi R^3 / 315
                bump.peak *= 315 / (64 * pi * std::pow(radius * options_.voxel, 3));
            const Vec3d reach{radius, radius, radius};
            requireIndices(bump.centre - reach, bump.centre + reach, options_.voxel);
            bump.lower = floorToInt((bump.centre - reach) / 8.0);
            bump.upper = floorToInt((bump.centre + reach) / 8.0);
        }
    }

    void findShares() {
        double count = 0;
        for (const Bump& b : bumps_) {
            const Vec3d size = (b.upper - b.lower + Vec3i{1, 1, 1}).as<double>();
            count += size.x * size.y * size.z;
        }
        const double bytes = count * sizeof(Share);
        if (bytes > static_cast<double>(memoryLimit()) / 4)
            throw inputError(
                "points of these radii touch {:.3g} blocks of 8 voxels, and sorting them takes {} "
                "of memory; take voxels larger than {}, or smaller radii",
                count, formatGiB(bytes), options_.voxel);
        shares_.reserve(static_cast<std::size_t>(count));
        for (std::uint32_t i = 0; i < bumps_.size(); ++i)
            for (int x = bumps_[i].lower.x; x <= bumps_[i].upper.x; ++x)
                for (int y = bumps_[i].lower.y; y <= bumps_[i].upper.y; ++y)
                    for (int z = bumps_[i].lower.z; z <= bumps_[i].upper.z; ++z)
                        shares_.push_back({{x, y, z}, i});
        tbb::parallel_sort(shares_.begin(), shares_.end());
    }

    /// Null where no voxel of it is reached.
    std::unique_ptr<Leaf> makeLeaf(std::size_t begin, std::size_t end) const {
        const auto [x, y, z] = shares_[begin].leaf;
        const Vec3i origin{8 * x, 8 * y, 8 * z};
        std::array<double, 512> sums{};
        for (std::size_t i = begin; i < end; ++i) add(bumps_[shares_[i].point], origin, sums);
        auto leaf = std::make_unique<Leaf>(openvdb::Coord(origin.x, origin.y, origin.z), 0.0f);
        for (openvdb::Index n = 0; n < 512; ++n)
            if (sums[n] > 0) leaf->setValueOn(n, static_cast<float>(sums[n]));
        return leaf->isEmpty() ? nullptr : std::move(leaf);
    }

    static void add(const Bump& bump, Vec3i origin, std::array<double, 512>& sums) {
        const double inverseSquare = 1 / (bump.radius * bump.radius);
        const Vec3d d = origin.as<double>() - bump.centre;
        for (int x = 0; x < 8; ++x)
            for (int y = 0; y < 8; ++y) {
                const double square = (d.x + x) * (d.x + x) + (d.y + y) * (d.y + y);
                for (int z = 0; z < 8; ++z) {
                    const double left = 1 - (square + (d.z + z) * (d.z + z)) * inverseSquare;
                    if (left > 0)
                        sums[static_cast<std::size_t>(64 * x + 8 * y + z)] +=
                            bump.peak * left * left * left;
                }
            }
    }

    const PointsToDensityOptions& options_;
    const Lattice lattice_;
    std::vector<Bump> bumps_;
    std::vector<Share> shares_;
    std::size_t widened_ = 0;
};

}  // namespace

grid::VdbGrids pointsToDensity(const PointCloud& cloud, const PointsToDensityOptions& options,
                               std::vector<std::string>& notes) {
    requireSound(cloud, options);
    Box3d bounds;
    for (const Vec3d& p : cloud.points) bounds.add(p);
    const Lattice lattice(mesh::originFor(bounds), options.voxel);
    const Summer summer(cloud, options, lattice);
    const auto grid = openvdb::FloatGrid::create(summer.sum());
    if (grid->empty())
        throw inputError("the density is zero everywhere: the weights of all points are zero");
    grid->setTransform(lattice.transform());
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setName(options.name);
    if (summer.widened() > 0)
        notes.push_back(
            fmt::format("{} of {} points have a radius below 1.5 voxels; they were widened to 1.5 "
                        "voxels, with their mass kept",
                        summer.widened(), cloud.points.size()));
    return {{grid}};
}

}  // namespace woodcock::convert
