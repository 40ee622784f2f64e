// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/line_integral.h"

#include <algorithm>
#include <vector>

namespace woodcock::oracle {

double trilinear(const VoxelFunction& voxel, Vec3d at) {
    double sum = 0;
    const Vec3i low{static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y)),
                    static_cast<int>(std::floor(at.z))};
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3i v = low + Vec3i{corner & 1, corner >> 1 & 1, corner >> 2 & 1};
        double weight = 1;
        for (int i = 0; i < 3; ++i) weight *= 1 - std::abs(at[i] - v[i]);
        if (weight > 0) sum += weight * voxel(v);
    }
    return sum;
}

double lineIntegral(const VoxelFunction& voxel, const Box3i& box, Vec3d origin, Vec3d direction,
                    double t0, double t1) {
    for (int axis = 0; axis < 3; ++axis) {  // outside the box all is zero
        if (direction[axis] == 0) continue;
        const double a = (box.lower[axis] - 1 - origin[axis]) / direction[axis];
        const double b = (box.upper[axis] + 1 - origin[axis]) / direction[axis];
        t0 = std::max(t0, std::min(a, b)), t1 = std::min(t1, std::max(a, b));
    }
    if (!(t0 < t1)) return 0;
    std::vector<double> planes{t0};
    if (std::isfinite(t1)) planes.push_back(t1);
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) continue;
        for (int plane = box.lower[axis] - 1; plane <= box.upper[axis] + 1; ++plane) {
            const double t = (plane - origin[axis]) / direction[axis];
            if (t > t0 && t < t1) planes.push_back(t);
        }
    }
    std::sort(planes.begin(), planes.end());
    const double node = std::sqrt(1.0 / 3);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < planes.size(); ++i) {
        const double middle = (planes[i] + planes[i + 1]) / 2,
                     half = (planes[i + 1] - planes[i]) / 2;
        for (const double t : {middle - half * node, middle + half * node})
            sum += half * trilinear(voxel, origin + direction * t);
    }
    return sum;
}

}  // namespace woodcock::oracle
