// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/math/Transform.h>

#include "woodcock/base/affine.h"
#include "woodcock/base/error.h"

namespace woodcock::grid {

/// The map as an OpenVDB transform, in its simplest form: a scale and a translation where these
/// suffice, which every reader understands. Errors: Input for voxels too small for OpenVDB's maps,
/// whose determinant must not be below 1e-15.
inline openvdb::math::Transform::Ptr openVdbTransform(const Affine3d& worldFromIndex) {
    using openvdb::math::Transform;
    const auto& m = worldFromIndex.column;
    const Vec3d t = worldFromIndex.translation;
    try {
        if (m[0].y == 0 && m[0].z == 0 && m[1].x == 0 && m[1].z == 0 && m[2].x == 0 &&
            m[2].y == 0) {
            using openvdb::math::ScaleMap, openvdb::math::UniformScaleMap;
            const openvdb::Vec3d scale(m[0].x, m[1].y, m[2].z);
            const bool uniform = scale[0] == scale[1] && scale[0] == scale[2];
            const auto transform =
                uniform ? std::make_shared<Transform>(std::make_shared<UniformScaleMap>(scale[0]))
                        : std::make_shared<Transform>(std::make_shared<ScaleMap>(scale));
            // Separately: a transform takes its map apart by differences of points, which lose
            // digits where it translates.
            transform->postTranslate(openvdb::Vec3d(t.x, t.y, t.z));
            return transform;
        }
        // OpenVDB's matrices act on row vectors: the images of the axes are its rows.
        openvdb::Mat4d rows = openvdb::Mat4d::identity();
        for (int i = 0; i < 3; ++i) {
            for (int row = 0; row < 3; ++row) rows(row, i) = m[static_cast<std::size_t>(row)][i];
            rows(3, i) = t[i];
        }
        return Transform::createLinearTransform(rows);
    } catch (const openvdb::ArithmeticError&) {
        throw inputError(
            "voxels of {:.3g} x {:.3g} x {:.3g} world units are too small for a VDB file, which "
            "begins at about 1e-5: take a larger unit of length",
            length(m[0]), length(m[1]), length(m[2]));
    }
}

/// The affine map of a linear OpenVDB map. It is not taken from the matrix, which throws for voxels
/// below 1e-5. Where the map has a scale, it is not taken from the Jacobian either, which some
/// versions of OpenVDB find as a difference of two points.
inline Affine3d affineOf(const openvdb::math::MapBase& map) {
    using openvdb::math::ScaleMap, openvdb::math::ScaleTranslateMap;
    const auto vec = [](const openvdb::Vec3d& v) { return Vec3d{v[0], v[1], v[2]}; };
    if (const auto* scaled = dynamic_cast<const ScaleTranslateMap*>(&map))
        return Affine3d::translate(vec(scaled->getTranslation())) *
               Affine3d::scale(vec(scaled->getScale()));
    if (const auto* scaled = dynamic_cast<const ScaleMap*>(&map))
        return Affine3d::scale(vec(scaled->getScale()));
    Affine3d m;
    for (int i = 0; i < 3; ++i) {
        openvdb::Vec3d axis(0.0);
        axis[i] = 1;
        m.column[static_cast<std::size_t>(i)] = vec(map.applyJacobian(axis));
    }
    m.translation = vec(map.applyMap(openvdb::Vec3d(0.0)));
    return m;
}

}  // namespace woodcock::grid
