// SPDX-License-Identifier: Apache-2.0
#include "woodcock/mesh/polygon.h"

#include <cstddef>

namespace woodcock::mesh {

namespace {

/// Twice the area, along the normal; Newell's method, which needs no planarity.
Vec3d areaOf(std::span<const Vec3d> corners) {
    Vec3d area;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        area += cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    return area;
}

class EarCutter {
public:
    explicit EarCutter(std::span<const Vec3d> corners)
        : corners_(corners), normal_(areaOf(corners)) {
        for (std::uint32_t i = 0; i < corners.size(); ++i) left_.push_back(i);
    }

    std::vector<std::array<std::uint32_t, 3>> cut() {
        constexpr std::size_t most = 512;  // each ear is sought among all corners
        std::vector<std::array<std::uint32_t, 3>> triangles;
        while (left_.size() > 3) {
            std::size_t ear = 1;
            if (corners_.size() <= most)
                for (std::size_t i = 1; i <= left_.size(); ++i)
                    if (isEar(i)) {
                        ear = i;
                        break;
                    }
            triangles.push_back({at(ear - 1), at(ear), at(ear + 1)});
            left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear % left_.size()));
        }
        triangles.push_back({left_[0], left_[1], left_[2]});
        return triangles;
    }

private:
    std::uint32_t at(std::size_t i) const { return left_[i % left_.size()]; }

    /// Positive where a, b, c turn as the polygon does.
    double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        return dot(normal_, cross(corners_[b] - corners_[a], corners_[c] - corners_[a]));
    }

    bool isEar(std::size_t i) const {
        const std::uint32_t a = at(i - 1), b = at(i), c = at(i + 1);
        if (!(turn(a, b, c) > 0)) return false;
        for (const std::uint32_t p : left_) {
            const Vec3d& q = corners_[p];
            if (q == corners_[a] || q == corners_[b] || q == corners_[c]) continue;
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
        }
        return true;
    }

    std::span<const Vec3d> corners_;
    Vec3d normal_;
    std::vector<std::uint32_t> left_;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec3d> corners) {
    return EarCutter(corners).cut();
}

}  // namespace woodcock::mesh
