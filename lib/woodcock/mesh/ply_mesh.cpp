// SPDX-License-Identifier: Apache-2.0
#include "woodcock/mesh/mesh_formats.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "woodcock/base/error.h"
#include "woodcock/mesh/ply_file.h"
#include "woodcock/mesh/polygon.h"

namespace woodcock::mesh {

namespace {

namespace fs = std::filesystem;

const PlyElement& require(const fs::path& file, const std::vector<PlyElement>& elements,
                          std::string_view name) {
    const auto found = std::find_if(elements.begin(), elements.end(),
                                    [&](const PlyElement& e) { return e.name == name; });
    if (found == elements.end()) throw inputError("{} has no element '{}'", file.string(), name);
    return *found;
}

const PlyElement::Property& require(const fs::path& file, const PlyElement& element,
                                    std::initializer_list<std::string_view> names, bool isList) {
    const PlyElement::Property* found = element.find(names);
    if (!found || found->isList != isList)
        throw inputError("{}: element '{}' has no {} '{}'", file.string(), element.name,
                         isList ? "list" : "number", *names.begin());
    return *found;
}

/// Points, and the mesh's origin, which is taken off them.
void readPlyVertices(const fs::path& file, const PlyElement& vertices, TriangleMesh& mesh) {
    const PlyElement::Property& x = require(file, vertices, {"x"}, false);
    const PlyElement::Property& y = require(file, vertices, {"y"}, false);
    const PlyElement::Property& z = require(file, vertices, {"z"}, false);
    if (vertices.count > std::numeric_limits<std::uint32_t>::max())
        throw inputError("{} has more than {} points", file.string(),
                         std::numeric_limits<std::uint32_t>::max());
    Box3d bounds;
    std::size_t faulty = 0, firstFaulty = 0;
    for (std::size_t i = 0; i < vertices.count; ++i) {
        const Vec3d p{x.values[i], y.values[i], z.values[i]};
        if (!isFinite(p.as<float>().as<double>()) && faulty++ == 0) firstFaulty = i;
        bounds.add(p);
    }
    if (faulty > 0)
        throw inputError("{} has {} points that are not finite, the first is {}", file.string(),
                         faulty, firstFaulty);
    mesh.origin = originFor(bounds);
    mesh.points.reserve(vertices.count);
    for (std::size_t i = 0; i < vertices.count; ++i)
        mesh.points.push_back(
            (Vec3d{x.values[i], y.values[i], z.values[i]} - mesh.origin).as<float>());
}

/// A number of each vertex; null where the file has none of these names.
const std::vector<double>* numbers(const PlyElement& vertices,
                                   std::initializer_list<std::string_view> names) {
    const PlyElement::Property* found = vertices.find(names);
    return found && !found->isList ? &found->values : nullptr;
}

void addAttributes(const PlyElement& vertices, SurfaceMesh& surface) {
    const auto *x = numbers(vertices, {"nx"}), *y = numbers(vertices, {"ny"}),
               *z = numbers(vertices, {"nz"});
    const auto *u = numbers(vertices, {"u", "s", "texture_u"}),
               *v = numbers(vertices, {"v", "t", "texture_v"});
    for (const auto& triangle : surface.mesh.triangles) {
        if (x && y && z) {
            const auto normal = [&](std::uint32_t i) {
                return Vec3d{(*x)[i], (*y)[i], (*z)[i]}.as<float>();
            };
            surface.normals.push_back(
                {normal(triangle[0]), normal(triangle[1]), normal(triangle[2])});
        }
        if (u && v) {
            const auto uv = [&](std::uint32_t i) {
                return Vec2f{static_cast<float>((*u)[i]), static_cast<float>((*v)[i])};
            };
            surface.uvs.push_back({uv(triangle[0]), uv(triangle[1]), uv(triangle[2])});
        }
    }
}

}  // namespace

SurfaceMesh readPlyMesh(const fs::path& file) {
    const std::vector<PlyElement> elements = readPly(file);
    SurfaceMesh surface;
    TriangleMesh& mesh = surface.mesh;
    const PlyElement& vertices = require(file, elements, "vertex");
    readPlyVertices(file, vertices, mesh);
    const PlyElement& faces = require(file, elements, "face");
    const PlyElement::Property& corners =
        require(file, faces, {"vertex_indices", "vertex_index"}, true);
    for (std::size_t i = 0; i < faces.count; ++i) {
        const std::span<const double> face = corners.list(i);
        if (face.size() < 3) continue;  // points and lines
        std::vector<Vec3d> polygon;
        for (const double index : face) {
            if (!(index >= 0 && index < static_cast<double>(mesh.points.size())) ||
                index != std::floor(index))
                throw inputError("{} is damaged: face {} refers to point {} of {}", file.string(),
                                 i, index, mesh.points.size());
            polygon.push_back(mesh.points[static_cast<std::size_t>(index)].as<double>());
        }
        for (const auto& [a, b, c] : triangulate(polygon))
            mesh.triangles.push_back({static_cast<std::uint32_t>(face[a]),
                                      static_cast<std::uint32_t>(face[b]),
                                      static_cast<std::uint32_t>(face[c])});
    }
    addAttributes(vertices, surface);
    return surface;
}

}  // namespace woodcock::mesh
