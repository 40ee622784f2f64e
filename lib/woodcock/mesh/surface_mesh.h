// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "woodcock/mesh/triangle_mesh.h"

namespace woodcock::mesh {

struct Vec2f {
    float u = 0, v = 0;
    bool operator==(const Vec2f&) const = default;
};

/// A mesh for rendering: triangles, counter-clockwise from outside, with normals and texture
/// coordinates that are interpolated over them. Corners are in the order of mesh.triangles.
struct SurfaceMesh {
    TriangleMesh mesh;
    std::vector<std::array<Vec3f, 3>> normals;  ///< at corners; empty: flat
    std::vector<std::array<Vec2f, 3>> uvs;      ///< at corners; empty: none
    std::size_t droppedTriangles = 0;  ///< triangles of zero area that were left out while reading
};

/// Reads a mesh with its normals and texture coordinates where the file has them (OBJ, PLY, STL,
/// glTF). Triangles of no area are left out and counted. Errors: as of readMesh(), and Input where
/// no triangle has an area.
SurfaceMesh readSurfaceMesh(const std::filesystem::path& file);

/// Replaces the mesh's normals. The normal at a corner is the mean, by area, of the triangles at
/// the point whose normals differ by less than `angle` degrees.
void smoothNormals(SurfaceMesh& mesh, double angle);

/// Whether a mesh encloses something: each edge belongs to two triangles that run along it in
/// opposite ways, and the enclosed volume is positive. Otherwise `problem` says what is wrong, and
/// where.
struct Closedness {
    bool closed = false;
    bool inwards = false;  ///< closed, but its triangles face inwards
    std::string problem;   ///< "12 open edges, the first one at (1, 2, 3)"
};
Closedness checkClosed(const TriangleMesh& mesh);

/// Flips all triangles and normals.
void flip(SurfaceMesh& mesh);

// Meshes from numbers, closed and facing outwards.

/// The box from lower to upper: 12 triangles.
SurfaceMesh boxMesh(const Box3d& box);
/// A flat rectangle in y = 0 that faces +y, centred at the origin; open. uv from its -x, +z corner.
SurfaceMesh rectangleMesh(double width, double depth);
/// A body of revolution about y: `profile` is a list of points (radius, height), counter-clockwise
/// in the half-plane (radius to the right, height upwards), so that the outside is on the right.
/// The body is closed if the profile starts and ends on the axis, or ends where it starts.
/// `smoothAngle` as of smoothNormals(). Errors: Usage on fewer than 3 segments or 2 points, on a
/// negative radius.
SurfaceMesh latheMesh(std::span<const std::array<double, 2>> profile, int segments,
                      double smoothAngle);

// The round shapes as meshes of as exact an area, for what has to be made of triangles: light.

/// The unit sphere in `rings` bands from pole to pole and twice as many sectors, with smooth
/// normals, u along the longitude and v from below. Scaled about its centre so that its area is 4
/// pi; with 48 rings no point is off by more than 1e-3.
SurfaceMesh sphereMesh(int rings);

/// The unit disk in y = 0 that faces +y, of area pi, as a fan of `sectors` triangles; u and v run
/// over the square around it as on rectangleMesh().
SurfaceMesh diskMesh(int sectors);

/// The surface of a level set (its zero), in world space, by OpenVDB's volumeToMesh. `grid`: its
/// name; empty: the only level set of the file. Adaptivity 0 to 1 makes flat parts coarser. Errors:
/// Input where there is no level set, with what exists.
SurfaceMesh levelSetMesh(const std::filesystem::path& file, const std::string& grid,
                         double adaptivity);

}  // namespace woodcock::mesh
