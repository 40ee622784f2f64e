// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "woodcock/base/vec.h"

namespace woodcock {

/// Embree, version 3 or 4, as far as surfaces need it: trees of triangles or of boxes, in frames of
/// about unit size, in which a ray finds candidates in floats.
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

/// What a ray may meet, the nearer ones first as a rule.
struct TriangleVisitor {
    /// Whether the ray meets it: then what lies farther than `beyond` behind it is not looked for.
    virtual bool accept(std::uint32_t triangle) = 0;
    double beyond = 0;

protected:
    ~TriangleVisitor() = default;
};
struct BoxVisitor {
    /// How far the ray goes still.
    virtual double visit(std::uint32_t box) = 0;

protected:
    ~BoxVisitor() = default;
};

/// A ray in a tree's frame. Its direction is of unit length, and its origin within the tree's box.
struct TreeRay {
    Vec3d origin, direction;
    double distance = 0;
};

class EmbreeTree {
public:
    /// By how much boxes are larger than what is in them, and rays longer at both ends: far more
    /// than what floats lose, so that nothing is missed.
    static constexpr double margin = 0x1p-18;

    EmbreeTree();  ///< of nothing
    /// Of triangles, whose corners are given by `point`; `triangles` must outlive the tree. Errors
    /// of both: Failure where there is too little memory. The device must outlive them.
    EmbreeTree(const EmbreeDevice& device, std::size_t points,
               const std::function<Vec3d(std::size_t)>& point,
               std::span<const std::array<std::uint32_t, 3>> triangles);
    EmbreeTree(const EmbreeDevice& device, std::uint32_t boxes,
               const std::function<Box3d(std::uint32_t)>& box);
    ~EmbreeTree();
    EmbreeTree(EmbreeTree&&) noexcept;
    EmbreeTree& operator=(EmbreeTree&&) noexcept;

    explicit operator bool() const { return impl_ != nullptr; }
    void traverse(const TreeRay& ray, TriangleVisitor& visitor) const;
    void traverse(const TreeRay& ray, BoxVisitor& visitor) const;
    /// Calls `visit` with all triangles or boxes that may lie within a radius of a point, and with
    /// some others.
    void around(Vec3d point, double radius, const std::function<void(std::uint32_t)>& visit) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace woodcock
