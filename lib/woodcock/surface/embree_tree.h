// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "woodcock/base/vec.h"

namespace woodcock::surface {

/// Embree, version 3 or 4: trees of triangles or boxes in which a ray finds candidates in floats. A
/// tree lies in a frame of about unit size.
class EmbreeDevice {
public:
    EmbreeDevice();  ///< Errors: Failure where Embree does not start
    ~EmbreeDevice();
    EmbreeDevice(EmbreeDevice&&) noexcept;
    EmbreeDevice& operator=(EmbreeDevice&&) noexcept;

    std::size_t memoryBytes() const;  ///< of all its trees

private:
    friend class EmbreeTree;
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Receives the triangles that a ray may meet, mostly the nearer ones first.
struct TriangleVisitor {
    /// Whether the ray meets the triangle. If so, the search ends at `beyond` behind it.
    virtual bool accept(std::uint32_t triangle) = 0;
    double beyond = 0;

protected:
    ~TriangleVisitor() = default;
};
struct BoxVisitor {
    /// Returns how far the search goes on.
    virtual double visit(std::uint32_t box) = 0;

protected:
    ~BoxVisitor() = default;
};

/// A ray in a tree's frame. Its direction is of unit length, and its origin within the tree's box.
struct TreeRay {
    Vec3d origin, direction;
    double distance = 0;
    float time = 0;  ///< of boxes that move
};

class EmbreeTree {
public:
    /// By how much boxes are larger than their contents, and rays longer at both ends. It is far
    /// more than the rounding of floats, so that nothing is missed.
    static constexpr double margin = 0x1p-18;

    EmbreeTree();  ///< an empty tree
    /// A tree of triangles, whose corners are given by `point`. `triangles` and the device must
    /// outlive the tree. Errors: Failure where there is not enough memory.
    EmbreeTree(const EmbreeDevice& device, std::size_t points,
               const std::function<Vec3d(std::size_t)>& point,
               std::span<const std::array<std::uint32_t, 3>> triangles);
    EmbreeTree(const EmbreeDevice& device, std::uint32_t boxes,
               const std::function<Box3d(std::uint32_t)>& box);
    /// The same of boxes that move: `box` gives them at evenly spaced steps from time 0 to 1, two
    /// steps at least. In between they are interpolated.
    EmbreeTree(const EmbreeDevice& device, std::uint32_t boxes, std::uint32_t steps,
               const std::function<Box3d(std::uint32_t box, std::uint32_t step)>& box);
    ~EmbreeTree();
    EmbreeTree(EmbreeTree&&) noexcept;
    EmbreeTree& operator=(EmbreeTree&&) noexcept;

    explicit operator bool() const { return impl_ != nullptr; }
    void traverse(const TreeRay& ray, TriangleVisitor& visitor) const;
    void traverse(const TreeRay& ray, BoxVisitor& visitor) const;
    /// Calls `visit` with all triangles or boxes that may lie within a radius of a point, at a
    /// time, and with some others.
    void around(Vec3d point, double radius, float time,
                const std::function<void(std::uint32_t)>& visit) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace woodcock::surface
