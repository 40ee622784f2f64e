// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/mesh/triangle_mesh.h"

namespace woodcock::test {

/// Of the solid that the triangles enclose, by the divergence theorem.
inline double volume(const mesh::TriangleMesh& mesh) {
    double six = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        six += dot(mesh.points[a].as<double>(),
                   cross(mesh.points[b].as<double>(), mesh.points[c].as<double>()));
    return six / 6;
}

}  // namespace woodcock::test
