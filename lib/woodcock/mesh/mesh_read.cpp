// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "woodcock/base/affine.h"
#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"
#include "woodcock/mesh/mesh_formats.h"
#include "woodcock/mesh/polygon.h"
#include "woodcock/mesh/surface_mesh.h"

#ifdef WOODCOCK_WITH_ASSIMP
#include <assimp/DefaultIOSystem.h>
#include <assimp/scene.h>

#include <assimp/IOStream.hpp>
#include <assimp/Importer.hpp>

#endif

namespace woodcock::mesh {

namespace fs = std::filesystem;

namespace {

/// A mesh takes up to about this many times its file's size while it is read.
constexpr double memoryPerByte = 14;

/// The extension, of a file that may be read.
std::string requireReadable(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status)) throw inputError("cannot read mesh '{}': no such file", file.string());
    if (!fs::is_regular_file(status))
        throw inputError("cannot read mesh '{}': it is not a regular file", file.string());
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    constexpr std::array known{".obj", ".ply", ".stl", ".gltf", ".glb"};
    if (std::find(known.begin(), known.end(), extension) == known.end())
        throw inputError(
            "cannot read mesh '{}': its name ends in '{}'; expected .obj, .ply, .stl, .gltf or "
            ".glb",
            file.string(), extension);
    const double needed = memoryPerByte * static_cast<double>(fs::file_size(file, error));
    if (const auto limit = static_cast<double>(memoryLimit()); needed > limit)
        throw failure("cannot read mesh '{}': it may take {} of memory, and there are {}",
                      file.string(), formatGiB(needed), formatGiB(limit));
    return extension;
}

#ifdef WOODCOCK_WITH_ASSIMP

constexpr double bytesPerTriangle = 160;  ///< of a SurfaceMesh while it is welded

/// Ends reading at the end of a file: some of Assimp's readers would go on forever.
class EndingStream : public Assimp::IOStream {
public:
    explicit EndingStream(std::unique_ptr<Assimp::IOStream> stream) : stream_(std::move(stream)) {}

    std::size_t Read(void* to, std::size_t size, std::size_t count) override {
        constexpr int mostEmptyReads = 100;
        const std::size_t read = stream_->Read(to, size, count);
        if (read == 0 && ++emptyReads_ > mostEmptyReads)
            throw std::runtime_error("the file is cut short");
        return read;
    }
    std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
    aiReturn Seek(std::size_t offset, aiOrigin origin) override {
        return stream_->Seek(offset, origin);
    }
    std::size_t Tell() const override { return stream_->Tell(); }
    std::size_t FileSize() const override { return stream_->FileSize(); }
    void Flush() override {}

private:
    std::unique_ptr<Assimp::IOStream> stream_;
    int emptyReads_ = 0;
};

/// A text in memory as a file.
class TextStream : public Assimp::IOStream {
public:
    explicit TextStream(std::string text) : text_(std::move(text)) {}

    std::size_t Read(void* to, std::size_t size, std::size_t count) override {
        const std::size_t whole = size == 0 ? 0 : std::min(count, (text_.size() - at_) / size);
        std::memcpy(to, text_.data() + at_, whole * size);
        at_ += whole * size;
        return whole;
    }
    std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
    aiReturn Seek(std::size_t offset, aiOrigin origin) override {
        const std::size_t from = origin == aiOrigin_SET   ? 0
                                 : origin == aiOrigin_CUR ? at_
                                                          : text_.size();
        if (offset > text_.size() - std::min(from, text_.size())) return aiReturn_FAILURE;
        at_ = from + offset;
        return aiReturn_SUCCESS;
    }
    std::size_t Tell() const override { return at_; }
    std::size_t FileSize() const override { return text_.size(); }
    void Flush() override {}

private:
    std::string text_;
    std::size_t at_ = 0;
};

/// Opens regular files only: a mesh may refer to a pipe, for which reading would wait forever. One
/// file may be replaced by another text.
class RegularFiles : public Assimp::DefaultIOSystem {
public:
    void replace(const std::string& file, std::string text) {
        replaced_ = file;
        text_ = std::move(text);
    }
    bool Exists(const char* file) const override {
        std::error_code ignored;
        return fs::is_regular_file(file, ignored);
    }
    Assimp::IOStream* Open(const char* file, const char* mode) override {
        if (!Exists(file)) return nullptr;
        if (replaced_ && *replaced_ == file) return new TextStream(text_);
        std::unique_ptr<Assimp::IOStream> stream(DefaultIOSystem::Open(file, mode));
        return stream ? new EndingStream(std::move(stream)) : nullptr;
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }

private:
    std::optional<std::string> replaced_;
    std::string text_;
};

Affine3d toAffine(const aiMatrix4x4& m) {
    return {{Vec3d{m.a1, m.b1, m.c1}, Vec3d{m.a2, m.b2, m.c2}, Vec3d{m.a3, m.b3, m.c3}},
            Vec3d{m.a4, m.b4, m.c4}};
}

/// Joins the parts of a scene, each transformed by its nodes.
class Joiner {
public:
    /// `origin`: what has been taken off already.
    Joiner(const fs::path& file, const aiScene& scene, Vec3d origin)
        : file_(file), scene_(scene), origin_(origin) {}

    SurfaceMesh join() {
        struct Placed {
            const aiNode* node;
            Affine3d parent;
        };
        std::vector<Placed> waiting;  // a stack, not recursion: files may nest very deeply
        if (scene_.mRootNode) waiting.push_back({scene_.mRootNode, {}});
        while (!waiting.empty()) {
            const auto [node, parent] = waiting.back();
            waiting.pop_back();
            const Affine3d world = parent * toAffine(node->mTransformation);
            for (unsigned i = 0; i < node->mNumMeshes; ++i) {
                if (node->mMeshes[i] >= scene_.mNumMeshes)
                    throw inputError("{} is damaged: a node refers to part {} of {}",
                                     file_.string(), node->mMeshes[i], scene_.mNumMeshes);
                add(*scene_.mMeshes[node->mMeshes[i]], world);
            }
            for (unsigned i = node->mNumChildren; i-- > 0;)
                waiting.push_back({node->mChildren[i], world});
        }
        if (faulty_ > 0)
            throw inputError("{} has {} points that are not finite, the first is {} of part '{}'",
                             file_.string(), faulty_, firstFaulty_, firstFaultyPart_);
        place();
        if (!anyNormals_) surface_.normals.clear();
        if (!anyUvs_) surface_.uvs.clear();
        return std::move(surface_);
    }

private:
    /// Points become floats after the origin is taken off.
    void place() {
        Box3d bounds;
        for (const Vec3d& p : points_) bounds.add(p);
        const Vec3d more = origin_ == Vec3d{} ? originFor(bounds) : Vec3d{};
        mesh_.origin = origin_ + more;
        mesh_.points.reserve(points_.size());
        for (const Vec3d& p : points_) mesh_.points.push_back((p - more).as<float>());
    }

    void add(const aiMesh& part, const Affine3d& world) {
        requireRoom(part);
        const bool mirrored = world.determinant() < 0;
        const auto first = static_cast<std::uint32_t>(points_.size());
        for (unsigned i = 0; i < part.mNumVertices; ++i) {
            const aiVector3D& v = part.mVertices[i];
            const Vec3d p = world.point(Vec3d{v.x, v.y, v.z});
            if (!isFinite(p.as<float>().as<double>()) && faulty_++ == 0)
                firstFaulty_ = i, firstFaultyPart_ = part.mName.C_Str();
            points_.push_back(p);
        }
        for (unsigned i = 0; i < part.mNumFaces; ++i) {
            const aiFace& face = part.mFaces[i];
            if (face.mNumIndices < 3) continue;  // points and lines
            std::vector<Vec3d> corners;
            for (unsigned j = 0; j < face.mNumIndices; ++j) {
                if (face.mIndices[j] >= part.mNumVertices)
                    throw inputError("{} is damaged: face {} refers to point {} of {}",
                                     file_.string(), i, face.mIndices[j], part.mNumVertices);
                corners.push_back(points_[first + face.mIndices[j]]);
            }
            for (auto [a, b, c] : triangulate(corners)) {
                if (mirrored) std::swap(b, c);  // faces outwards still
                addTriangle(part, world, first,
                            {face.mIndices[a], face.mIndices[b], face.mIndices[c]});
            }
        }
    }

    void addTriangle(const aiMesh& part, const Affine3d& world, std::uint32_t first,
                     const std::array<std::uint32_t, 3>& corners) {
        mesh_.triangles.push_back({first + corners[0], first + corners[1], first + corners[2]});
        auto& normals = surface_.normals.emplace_back();
        auto& uvs = surface_.uvs.emplace_back();
        if (part.mNormals) {
            anyNormals_ = true;
            const std::array<Vec3d, 3>& m = world.column;
            // The inverse's transpose but for its scale, which does not matter; the sign does.
            const double side = world.determinant() < 0 ? -1 : 1;
            const std::array<Vec3d, 3> cofactors{cross(m[1], m[2]) * side, cross(m[2], m[0]) * side,
                                                 cross(m[0], m[1]) * side};
            for (std::size_t i = 0; i < 3; ++i) {
                const aiVector3D& n = part.mNormals[corners[i]];
                normals[i] =
                    (cofactors[0] * n.x + cofactors[1] * n.y + cofactors[2] * n.z).as<float>();
            }
        }
        if (const aiVector3D* places = part.mTextureCoords[0]) {
            anyUvs_ = true;
            for (std::size_t i = 0; i < 3; ++i)
                uvs[i] = {places[corners[i]].x, places[corners[i]].y};
        }
    }

    /// One part may have many instances.
    void requireRoom(const aiMesh& part) const {
        const std::uint64_t points = points_.size() + std::uint64_t{part.mNumVertices};
        const std::uint64_t triangles = mesh_.triangles.size() + std::uint64_t{part.mNumFaces};
        if (points > std::numeric_limits<std::uint32_t>::max())
            throw inputError("{} has more than {} points", file_.string(),
                             std::numeric_limits<std::uint32_t>::max());
        const double needed = bytesPerTriangle * static_cast<double>(std::max(points, triangles));
        if (const auto limit = static_cast<double>(memoryLimit()); needed > limit)
            throw failure("cannot read mesh '{}': {} points take {} of memory, and there are {}",
                          file_.string(), points, formatGiB(needed), formatGiB(limit));
    }

    const fs::path& file_;
    const aiScene& scene_;
    Vec3d origin_;
    SurfaceMesh surface_;
    TriangleMesh& mesh_ = surface_.mesh;
    std::vector<Vec3d> points_;
    bool anyNormals_ = false, anyUvs_ = false;
    std::size_t faulty_ = 0;
    unsigned firstFaulty_ = 0;
    std::string firstFaultyPart_;
};

SurfaceMesh readByAssimp(const fs::path& file) {
    Assimp::Importer importer;
    auto* const files = new RegularFiles;
    importer.SetIOHandler(files);  // which the importer deletes
    Vec3d origin;
    if (auto far = withoutOrigin(file)) {
        origin = far->origin;
        files->replace(file.string(), std::move(far->text));
    }
    // Without any of Assimp's steps of processing: they abort where a face is not as they expect.
    const aiScene* scene = importer.ReadFile(file.string(), 0);
    if (!scene)
        throw inputError("cannot read mesh '{}': {}", file.string(), importer.GetErrorString());
    return Joiner(file, *scene, origin).join();
}

constexpr bool hasAssimp = true;

#else

SurfaceMesh readByAssimp(const fs::path& file) {
    throw failure("cannot read mesh '{}': this build has no Assimp", file.string());
}

constexpr bool hasAssimp = false;

#endif

/// The mesh as in the file: points not welded, normals of any length.
SurfaceMesh readAny(const fs::path& file) {
    const std::string extension = requireReadable(file);
    if (extension == ".gltf" || extension == ".glb") refuseDeepGltf(file);
    // Assimp's reader of PLY does not end where some files are damaged.
    SurfaceMesh surface = extension == ".ply" ? readPlyMesh(file) : readByAssimp(file);
    if (extension == ".stl") surface.normals.clear();  // one of each triangle, or none at all
    return surface;
}

/// Leaves out triangles of no area, and makes normals unit vectors.
void clean(SurfaceMesh& surface) {
    TriangleMesh& mesh = surface.mesh;
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const Vec3d p = mesh.points[a].as<double>();
        const Vec3d area = cross(mesh.points[b].as<double>() - p, mesh.points[c].as<double>() - p);
        if (!(length(area) > 0)) continue;
        mesh.triangles[kept] = mesh.triangles[t];
        if (!surface.uvs.empty()) surface.uvs[kept] = surface.uvs[t];
        if (!surface.normals.empty()) {
            surface.normals[kept] = surface.normals[t];
            for (Vec3f& n : surface.normals[kept]) {
                const Vec3d unit = normalize(n.as<double>());
                n = (isFinite(unit) ? unit : normalize(area)).as<float>();
            }
        }
        ++kept;
    }
    surface.droppedTriangles = mesh.triangles.size() - kept;
    mesh.triangles.resize(kept);
    if (!surface.uvs.empty()) surface.uvs.resize(kept);
    if (!surface.normals.empty()) surface.normals.resize(kept);
}

}  // namespace

bool canReadMeshes() { return hasAssimp; }

TriangleMesh readMesh(const fs::path& file) {
    TriangleMesh mesh = weld(readAny(file).mesh);
    if (mesh.triangles.empty()) throw inputError("{} holds no triangles", file.string());
    return mesh;
}

SurfaceMesh readSurfaceMesh(const fs::path& file) {
    SurfaceMesh surface = readAny(file);
    clean(surface);
    if (surface.mesh.triangles.empty())
        throw inputError("{} holds no triangles{}", file.string(),
                         surface.droppedTriangles > 0
                             ? fmt::format(" but {} of no area", surface.droppedTriangles)
                             : "");
    surface.mesh = weld(surface.mesh);
    return surface;
}

}  // namespace woodcock::mesh
