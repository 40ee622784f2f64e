// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/load_surfaces.h"

#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "woodcock/image/read_texture.h"
#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/instance_file.h"
#include "woodcock/scene/unit_shapes.h"

namespace woodcock::scene {
namespace {

/// What a colour space conversion of white may give.
constexpr float almostOne = 1 + 1e-4f;

/// Reads images, each once.
class Reader {
public:
    explicit Reader(const SceneDescription& scene) : scene_(scene) {}

    std::shared_ptr<const surface::TextureImage> read(const std::filesystem::path& file,
                                                      const std::string& colourSpace,
                                                      const std::string& place) {
        auto& image = known_[{file, colourSpace}];
        if (image) return image;
        if (!config_)
            inPlace(findPlace(scene_.places, "ocio"), [&] { config_.emplace(scene_.ocio); });
        inPlace(place, [&] {
            image::Image read = image::readTexture(file, colourSpace, *config_);
            image = std::make_shared<surface::TextureImage>(read.width, read.height,
                                                            std::move(read.rgb));
        });
        return image;
    }

private:
    const SceneDescription& scene_;
    std::optional<image::ColorConfig> config_;
    std::map<std::pair<std::filesystem::path, std::string>,
             std::shared_ptr<const surface::TextureImage>>
        known_;
};

struct NamedTexture {
    const TextureDescription* texture = nullptr;
    const char* key = "";
    bool limited = true;  ///< to 1: it shares light out, and makes none
    bool isData = false;
};
NamedTexture textureOf(const DiffuseDescription& m) { return {&m.colour, "colour"}; }
NamedTexture textureOf(const ConductorDescription& m) { return {&m.colour, "colour"}; }
NamedTexture textureOf(const DielectricDescription&) { return {}; }
NamedTexture textureOf(const InterfaceDescription&) { return {}; }
NamedTexture textureOf(const EmissiveDescription& m) { return {&m.radiance, "radiance", false}; }
NamedTexture textureOf(const MixDescription& m) { return {&m.weight, "weight", true, true}; }

using Mesh = std::shared_ptr<const mesh::SurfaceMesh>;

constexpr double defaultSmooth = 60;  // degrees, where a shape brings no normals of its own
constexpr int emitterRings = 48, emitterSectors = 256;

void smooth(mesh::SurfaceMesh& mesh, double angle) {
    if (angle > 0)
        mesh::smoothNormals(mesh, angle);
    else
        mesh.normals.clear();
}

mesh::SurfaceMesh readShape(const MeshShape& shape, std::optional<double> angle) {
    const bool levelSet = shape.file.extension() == ".vdb" || shape.file.extension() == ".nvdb";
    mesh::SurfaceMesh mesh = levelSet ? mesh::levelSetMesh(shape.file, shape.levelSet, 0)
                                      : mesh::readSurfaceMesh(shape.file);
    if (angle || levelSet) smooth(mesh, angle.value_or(defaultSmooth));
    return mesh;
}

/// Makes meshes, each once.
class Loader {
public:
    Loader(const SceneDescription& scene, std::vector<std::string>& notes)
        : scene_(scene), notes_(notes) {}

    LoadedSurface load(size_t index) {
        const SurfaceDescription& surface = scene_.surfaces[index];
        const SurfaceNature nature = natureOf(scene_, index);
        const auto placeOf = [&](const char* key) {
            return findPlace(scene_.places, fmt::format("surface[{}].{}", index, key));
        };
        LoadedSurface loaded = inPlace(placeOf(keyOf(surface)), [&] {
            return std::visit([&](const auto& shape) { return shaped(shape, surface, nature); },
                              surface.shape);
        });
        loaded.instances = surface.instances;
        if (!surface.instanceFile.empty()) {
            const auto more = inPlace(placeOf("instances"),
                                      [&] { return readInstanceFile(surface.instanceFile); });
            loaded.instances.insert(loaded.instances.end(), more.begin(), more.end());
        }
        if (loaded.instances.empty()) loaded.instances.emplace_back();
        return loaded;
    }

private:
    /// Of the shape's value, where reading or making it may fail.
    static const char* keyOf(const SurfaceDescription& surface) {
        if (std::holds_alternative<MeshShape>(surface.shape)) return "file";
        return std::holds_alternative<FacetShape>(surface.shape) ? "facets" : "lathe";
    }

    LoadedSurface shaped(const MeshShape& shape, const SurfaceDescription& surface,
                         const SurfaceNature& nature) {
        const auto key =
            std::tuple(shape.file, shape.levelSet, surface.smooth.value_or(-1), nature.encloses);
        Mesh& mesh = files_[key];
        if (!mesh) {
            mesh::SurfaceMesh read = readShape(shape, surface.smooth);
            if (read.droppedTriangles > 0)
                notes_.push_back(fmt::format("{} holds {} triangle{} of no area: left out",
                                             shape.file.string(), read.droppedTriangles,
                                             read.droppedTriangles == 1 ? "" : "s"));
            if (nature.encloses) close(read, shape.file.string());
            mesh = std::make_shared<mesh::SurfaceMesh>(std::move(read));
        }
        return {mesh, Affine3d::translate(mesh->mesh.origin), {}};
    }
    LoadedSurface shaped(const LatheShape& shape, const SurfaceDescription& surface,
                         const SurfaceNature& nature) {
        const double angle = surface.smooth.value_or(defaultSmooth);
        mesh::SurfaceMesh mesh = mesh::latheMesh(shape.profile, shape.segments, angle);
        if (angle == 0) mesh.normals.clear();
        if (nature.encloses) close(mesh, "the lathe");
        return {std::make_shared<mesh::SurfaceMesh>(std::move(mesh)), {}, {}};
    }
    LoadedSurface shaped(const FacetShape& shape, const SurfaceDescription&, const SurfaceNature&) {
        return {std::make_shared<mesh::SurfaceMesh>(mesh::facetedMesh(shape.rings)), {}, {}};
    }
    LoadedSurface shaped(const BoxShape& shape, const SurfaceDescription&, const SurfaceNature&) {
        if (!box_)
            box_ = std::make_shared<mesh::SurfaceMesh>(mesh::boxMesh({{0, 0, 0}, {1, 1, 1}}));
        return {box_, Affine3d::translate(shape.box.lower) * Affine3d::scale(shape.box.size()), {}};
    }
    LoadedSurface shaped(const SphereShape& shape, const SurfaceDescription&,
                         const SurfaceNature& nature) {
        if (nature.emits && !sphere_)
            sphere_ = std::make_shared<mesh::SurfaceMesh>(sphereMesh(emitterRings));
        const Vec3d scale = Vec3d{1, 1, 1} * shape.radius;
        return {nature.emits ? sphere_ : nullptr,
                Affine3d::translate(shape.centre) * Affine3d::scale(scale),
                {}};
    }
    LoadedSurface shaped(const DiskShape& shape, const SurfaceDescription&,
                         const SurfaceNature& nature) {
        if (nature.emits && !disk_)
            disk_ = std::make_shared<mesh::SurfaceMesh>(diskMesh(emitterSectors));
        return {nature.emits ? disk_ : nullptr, Affine3d::scale(Vec3d{1, 1, 1} * shape.radius), {}};
    }
    LoadedSurface shaped(const PlaneShape& shape, const SurfaceDescription&, const SurfaceNature&) {
        if (!shape.size) return {};
        if (!rectangle_)
            rectangle_ = std::make_shared<mesh::SurfaceMesh>(mesh::rectangleMesh(1, 1));
        return {rectangle_, Affine3d::scale({(*shape.size)[0], 1, (*shape.size)[1]}), {}};
    }

    /// Sees to it that a mesh encloses something.
    void close(mesh::SurfaceMesh& mesh, const std::string& name) {
        const mesh::Closedness found = mesh::checkClosed(mesh.mesh);
        if (found.inwards) {
            mesh::flip(mesh);
            notes_.push_back(fmt::format(
                "{} faces inwards: turned over, as its material tells inside from outside", name));
        } else if (!found.closed) {
            throw inputError(
                "{} is not closed ({}), and its material tells inside from outside; close it, or "
                "give it a material that lets no light in",
                name, found.problem);
        }
    }

    const SceneDescription& scene_;
    std::vector<std::string>& notes_;
    std::map<std::tuple<std::filesystem::path, std::string, double, bool>, Mesh> files_;
    Mesh box_, sphere_, disk_, rectangle_;
};

void checkFillings(const SceneDescription& scene, const std::vector<LoadedSurface>& loaded) {
    for (size_t i = 0; i < scene.volumes.size(); ++i) {
        const std::string& name = scene.volumes[i].inside;
        const auto found = findNamed(scene.surfaces, name);
        if (!found || loaded[*found].instances.size() == 1) continue;
        inPlace(findPlace(scene.places, fmt::format("volume[{}].inside", i)), [&] {
            throw inputError(
                "'{}' stands in {} places; a volume fills a surface that stands in one", name,
                loaded[*found].instances.size());
        });
    }
}

}  // namespace

std::vector<LoadedSurface> loadSurfaces(const SceneDescription& scene,
                                        std::vector<std::string>& notes) {
    std::vector<LoadedSurface> loaded;
    Loader loader(scene, notes);
    for (size_t i = 0; i < scene.surfaces.size(); ++i) loaded.push_back(loader.load(i));
    checkFillings(scene, loaded);
    return loaded;
}

surface::Texture makeTexture(const TextureDescription& description,
                             std::shared_ptr<const surface::TextureImage> image) {
    surface::Texture texture(description.colour, std::move(image));
    const float largest = texture.maximum().maximum();
    if (texture.image && largest > 1 && largest <= almostOne) texture.colour *= 1 / largest;
    return texture;
}

std::vector<std::shared_ptr<const surface::TextureImage>> loadTextures(
    const SceneDescription& scene) {
    std::vector<std::shared_ptr<const surface::TextureImage>> textures;
    Reader reader(scene);
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        const NamedTexture named =
            std::visit([](const auto& m) { return textureOf(m); }, scene.materials[i].material);
        textures.emplace_back();
        if (!named.texture || named.texture->image.empty()) continue;
        const std::string value = fmt::format("material[{}].{}", i, named.key);
        const auto placeOf = [&](const char* key) {
            return findPlace(scene.places, fmt::format("{}.{}", value, key));
        };
        // Weights are no colours: a mask of bytes means what it says.
        const bool data = named.isData && named.texture->colourSpace.empty();
        const auto image = reader.read(
            named.texture->image, data ? "data" : named.texture->colourSpace, placeOf("image"));
        textures.back() = image;
        const Rgb largest = named.texture->colour * image->maximum();
        if (!named.limited || largest.maximum() <= almostOne) continue;
        inPlace(placeOf(named.texture->colour == Rgb(1) ? "image" : "times"), [&] {
            throw inputError(
                "{} reaches {:.4g} with {}, but a {} is at most 1; give times = {:.3g} or less",
                value, largest.maximum(), named.texture->image.string(), named.key,
                std::floor(1000 / image->maximum().maximum()) / 1000);
        });
    }
    return textures;
}

}  // namespace woodcock::scene
