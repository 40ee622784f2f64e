// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>

#include "woodcock/medium/medium.h"

namespace woodcock::medium {

/// The optical depth of a medium from any point of it to a light: to infinity in one direction, the
/// same for all points, towards a sun; or to a lamp outside of the medium. It is stored at the
/// nodes of a lattice in light space, whose third axis points towards the light, and interpolated
/// between them. The light space of a lamp is in perspective: its lines meet in the lamp. From node
/// to node along a line the depth is integrated by two points. So it is near the truth and no more:
/// a control variate, see correctedTransmittance().
///
/// The lattice is made where it is first read, by columns along the direction. What it holds does
/// not depend on who reads it when. It may be read by many threads.
class DepthGrid {
public:
    /// `towards`: unit vector in world space. `mostBytes`: of the whole lattice, whose nodes are
    /// 1.4 of the medium's finest voxels apart where that fits. Null where the medium has no end,
    /// moves, or has an extinction that varies against its density; and where so much memory is too
    /// little to show what the medium is like. The medium must outlive the grid.
    static std::unique_ptr<const DepthGrid> make(const Medium& medium, Vec3d towards,
                                                 std::size_t mostBytes);
    /// The same towards a lamp at a point in world space, of such a radius. Null also where the
    /// lamp is not farther from the box around the medium than a tenth of the box's diagonal.
    static std::unique_ptr<const DepthGrid> makeForLamp(const Medium& medium, Vec3d lamp,
                                                        double radius, std::size_t mostBytes);
    ~DepthGrid();
    DepthGrid(const DepthGrid&) = delete;
    DepthGrid& operator=(const DepthGrid&) = delete;

    /// Distance of neighbouring nodes, in world units; of a lamp's about the medium's middle.
    double spacing() const { return spacing_; }
    /// How far rays to the light may run beside the lattice's lines, in nodes, and at least 1.
    float blur() const { return blur_; }
    std::size_t bytesMade() const { return bytesMade_; }  ///< of columns so far
    std::size_t bytesOfAll() const;                       ///< where all columns are read

    /// Optical depths around a point: interpolated, and the least and the most at the eight nodes.
    /// Of a wide lamp these are as far apart as they would be blur() nodes away from each other.
    struct Depth {
        float depth, least, most;
    };
    /// Of each channel.
    template <int N>
    std::array<Depth, N> at(Vec3d world) const {
        std::array<Depth, N> depths;
        const Place place = find(world);
        if (channels_ == 1) {
            const Depth grey = read(place, 0);
            for (int c = 0; c < N; ++c)
                depths[static_cast<std::size_t>(c)] = {
                    colour_[c] * grey.depth, colour_[c] * grey.least, colour_[c] * grey.most};
        } else {
            for (int c = 0; c < N; ++c) depths[static_cast<std::size_t>(c)] = read(place, c);
        }
        return depths;
    }

    // For readers that interpolate by themselves, as at() does:

    /// From the world to the lattice, whose nodes have whole numbers. With perspective(), the first
    /// two coordinates are to be divided by its value at the third.
    Affine3d latticeFromWorld() const;
    /// At the third coordinate z of the lattice: first + second x z. That is 1 for suns.
    std::array<double, 2> perspective() const;
    /// How many cells there are along each axis. Outside, the nearest one counts.
    Vec3i cells() const {
        return {columnCount_[0] * columnCells, columnCount_[1] * columnCells, length_ - 1};
    }
    /// The first node of a cell. The next ones along the axes are strides() floats further.
    const float* nodes(int i, int j, int k) const {
        const int line = j % columnCells * columnNodes + i % columnCells;
        return column(
                   static_cast<std::size_t>(j / columnCells * columnCount_[0] + i / columnCells)) +
               static_cast<std::size_t>(line) * lineFloats() +
               static_cast<std::size_t>(k * channels_);
    }
    std::array<std::size_t, 3> strides() const {
        return {lineFloats(), columnNodes * lineFloats(), static_cast<std::size_t>(channels_)};
    }
    /// Floats of a node: one, which colour() is to be multiplied with, or three.
    int channels() const { return channels_; }
    const Rgb& colour() const { return colour_; }

private:
    DepthGrid(const Medium& medium, Vec3d origin, Vec3d towards, double middle);
    bool layOut(std::size_t mostBytes);
    Vec3d lightFromWorld(Vec3d world) const;
    Vec3d worldFromLight(Vec3d light) const;

    static constexpr int columnCells = 8;  ///< across a column
    static constexpr int columnNodes = columnCells + 1;

    /// The cell around a point: its first node, and where in the cell the point is.
    struct Place {
        const float* node;
        float u, v, w;
    };
    Place find(Vec3d world) const;
    Depth read(const Place& place, int channel) const;

    const float* column(std::size_t index) const {
        const float* made = columns_[index].load(std::memory_order_acquire);
        return made ? made : makeColumn(index);
    }
    std::size_t lineFloats() const { return static_cast<std::size_t>(length_ * channels_); }
    const float* makeColumn(std::size_t index) const;
    void fillLine(double i, double j, float* nodes) const;

    // Light space has the world's units. Its origin is the lamp, where it is in perspective; its
    // first two axes are then as in the world at a distance of `middle_`.
    const Medium* medium_;
    Vec3d origin_, towards_, across_[2];
    double middle_;  ///< 0: without perspective
    Vec3d base_;     ///< of the first node, in light space
    double spacing_ = 1, perSpacing_ = 1;
    float blur_ = 1;
    int columnCount_[2] = {0, 0};
    int length_ = 0;  ///< nodes along
    // With one channel, the depth of channel c is colour_[c] times the number that is stored.
    int channels_ = 1;
    Rgb colour_{1.0f};
    std::unique_ptr<std::atomic<float*>[]> columns_;
    mutable std::array<std::mutex, 64> making_;
    mutable std::atomic<std::size_t> bytesMade_{0};
};

}  // namespace woodcock::medium
