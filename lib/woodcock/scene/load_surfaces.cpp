// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/load_surfaces.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "woodcock/base/error.h"
#include "woodcock/base/printable.h"
#include "woodcock/grid/input_file.h"
#include "woodcock/image/read_texture.h"
#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {
namespace {

constexpr std::string_view expected =
    "x y z, x y z scale, x y z scale rx ry rz, or the 12 numbers of a matrix of three rows";
constexpr size_t mostNumbers = 12;

/// One line on its way to a transform.
class Line {
public:
    Line(std::string_view text, const std::filesystem::path& file, size_t number)
        : rest_(text.substr(0, text.find('#'))), file_(file), number_(number) {}

    /// False where there is nothing but space.
    bool read() {
        while (skipSpace()) {
            if (count_ == mostNumbers)
                throw error("more than {} numbers; expected {}", mostNumbers, expected);
            readNumber();
        }
        return count_ > 0;
    }

    Affine3d transform() const {
        const auto& n = numbers_;
        const Vec3d position{n[0], n[1], n[2]};
        Affine3d map;
        switch (count_) {
            case 3:
                return Affine3d::translate(position);
            case 4:
                map = placement(position, {}, Vec3d{1, 1, 1} * n[3]);
                break;
            case 7:
                map = placement(position, {n[4], n[5], n[6]}, Vec3d{1, 1, 1} * n[3]);
                break;
            case 12:
                map = {{Vec3d{n[0], n[4], n[8]}, {n[1], n[5], n[9]}, {n[2], n[6], n[10]}},
                       {n[3], n[7], n[11]}};
                break;
            default:
                throw error("{} number{}; expected {}", count_, count_ == 1 ? "" : "s", expected);
        }
        if (const std::string flaw = flawOf(map); !flaw.empty())
            throw error("a transform that {}", flaw);
        return map;
    }

private:
    bool skipSpace() {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r"), rest_.size()));
        return !rest_.empty();
    }

    void readNumber() {
        const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r"));
        const char* const end = word.data() + word.size();
        const char* const begin = word.data() + (word.front() == '+' && word.size() > 1);
        double& value = numbers_[count_];
        const auto [stop, failed] = std::from_chars(begin, end, value);
        if (failed != std::errc() || stop != end || !std::isfinite(value))
            throw error("'{}', which is no number that can be used; expected {}",
                        printable(word.substr(0, 40)), expected);
        ++count_;
        rest_.remove_prefix(word.size());
    }

    template <class... A>
    Error error(fmt::format_string<A...> message, A&&... args) const {
        return inputError("{}:{}: found {}", file_.string(), number_,
                          fmt::format(message, std::forward<A>(args)...));
    }

    std::string_view rest_;
    const std::filesystem::path& file_;
    size_t number_;
    std::array<double, mostNumbers> numbers_{};
    size_t count_ = 0;
};

/// What a colour space conversion of white may give.
constexpr float almostOne = 1 + 1e-4f;

using TexturePointer = std::shared_ptr<const surface::TextureImage>;

/// Reads images, each once.
class Reader {
public:
    Reader(const SceneDescription& scene, LoadCache& cache) : scene_(scene), cache_(cache) {}

    TexturePointer read(const std::filesystem::path& file, const std::string& colourSpace,
                        const std::string& place) {
        return cache_.get<TexturePointer>(
            cacheName("texture", file.string(), colourSpace, scene_.ocio.string()), [&] {
                if (!config_)
                    inPlace(findPlace(scene_.places, keyName(scene_, scene_.ocio)),
                            [&] { config_.emplace(scene_.ocio); });
                return inPlace(place, [&]() -> TexturePointer {
                    image::Image read = image::readTexture(file, colourSpace, *config_);
                    return std::make_shared<surface::TextureImage>(read.width, read.height,
                                                                   std::move(read.rgb));
                });
            });
    }

private:
    const SceneDescription& scene_;
    LoadCache& cache_;
    std::optional<image::ColorConfig> config_;
};

struct NamedTexture {
    const TextureDescription* texture = nullptr;
    std::string key = {};
    bool limited = true;  ///< to 1: it shares light out, and makes none
    bool isData = false;
};
NamedTexture textureOf(const DiffuseDescription& m) { return {&m.colour, keyName(m, m.colour)}; }
NamedTexture textureOf(const ConductorDescription& m) { return {&m.colour, keyName(m, m.colour)}; }
NamedTexture textureOf(const DielectricDescription&) { return {}; }
NamedTexture textureOf(const InterfaceDescription&) { return {}; }
NamedTexture textureOf(const EmissiveDescription& m) {
    return {&m.radiance, keyName(m, m.radiance), false};
}
NamedTexture textureOf(const MixDescription& m) {
    return {&m.weight, keyName(m, m.weight), true, true};
}

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
class SurfaceLoader {
public:
    SurfaceLoader(const SceneDescription& scene, std::vector<std::string>& notes, LoadCache& cache)
        : scene_(scene), notes_(notes), cache_(cache) {}

    LoadedSurface load(size_t index) {
        const SurfaceDescription& surface = scene_.surfaces[index];
        const SurfaceNature nature = natureOf(scene_, index);
        const auto placeOf = [&](const auto& member) {
            return findPlace(scene_.places,
                             fmt::format("surface[{}].{}", index, keyName(surface, member)));
        };
        LoadedSurface loaded = std::visit(
            [&](const auto& shape) {
                return inPlace(placeOf(shape), [&] { return shaped(shape, surface, nature); });
            },
            surface.shape);
        loaded.instances = surface.instances;
        if (!surface.instanceFile.empty()) {
            const auto& more =
                inPlace(placeOf(surface.instances), [&]() -> const std::vector<Affine3d>& {
                    return cache_.get<std::vector<Affine3d>>(
                        cacheName("instances", surface.instanceFile.string()),
                        [&] { return readInstanceFile(surface.instanceFile); });
                });
            loaded.instances.insert(loaded.instances.end(), more.begin(), more.end());
        }
        if (loaded.instances.empty()) loaded.instances.emplace_back();
        return loaded;
    }

private:
    LoadedSurface shaped(const MeshShape& shape, const SurfaceDescription& surface,
                         const SurfaceNature& nature) {
        const Mesh& mesh = cache_.get<Mesh>(
            cacheName("mesh", shape.file.string(), shape.levelSet, surface.smooth.value_or(-1),
                      nature.encloses),
            [&]() -> Mesh {
                mesh::SurfaceMesh read = readShape(shape, surface.smooth);
                if (read.droppedTriangles > 0)
                    notes_.push_back(fmt::format("{} holds {} triangle{} of no area: left out",
                                                 shape.file.string(), read.droppedTriangles,
                                                 read.droppedTriangles == 1 ? "" : "s"));
                if (nature.encloses) close(read, shape.file.string());
                return std::make_shared<mesh::SurfaceMesh>(std::move(read));
            });
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
            sphere_ = std::make_shared<mesh::SurfaceMesh>(mesh::sphereMesh(emitterRings));
        const Vec3d scale = Vec3d{1, 1, 1} * shape.radius;
        return {nature.emits ? sphere_ : nullptr,
                Affine3d::translate(shape.centre) * Affine3d::scale(scale),
                {}};
    }
    LoadedSurface shaped(const DiskShape& shape, const SurfaceDescription&,
                         const SurfaceNature& nature) {
        if (nature.emits && !disk_)
            disk_ = std::make_shared<mesh::SurfaceMesh>(mesh::diskMesh(emitterSectors));
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
    LoadCache& cache_;
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

Box3d meshBounds(const LoadedSurface& loaded) {
    if (!loaded.mesh) return {{-1, -1, -1}, {1, 1, 1}};
    Box3d box;
    for (const Vec3f& p : loaded.mesh->mesh.points) box.add(p.as<double>());
    return box;
}

bool infinite(const SurfaceDescription& surface) {
    const auto* plane = std::get_if<PlaneShape>(&surface.shape);
    return plane && !plane->size;
}

}  // namespace

std::vector<Affine3d> readInstanceFile(const std::filesystem::path& file) {
    const std::string text = grid::readInput(file);
    std::vector<Affine3d> instances;
    size_t number = 0;
    for (std::string_view rest = text; !rest.empty();) {
        const size_t end = rest.find('\n');
        Line line(rest.substr(0, end), file, ++number);
        if (line.read()) instances.push_back(line.transform());
        rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    if (instances.empty())
        throw inputError("{} places no instance; expected lines of {}", file.string(), expected);
    return instances;
}

std::vector<LoadedSurface> loadSurfaces(const SceneDescription& scene,
                                        std::vector<std::string>& notes, LoadCache& cache) {
    std::vector<LoadedSurface> loaded;
    SurfaceLoader loader(scene, notes, cache);
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
    const SceneDescription& scene, LoadCache& cache) {
    std::vector<std::shared_ptr<const surface::TextureImage>> textures;
    Reader reader(scene, cache);
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        const NamedTexture named =
            std::visit([](const auto& m) { return textureOf(m); }, scene.materials[i].material);
        textures.emplace_back();
        if (!named.texture || named.texture->image.empty()) continue;
        const std::string value = fmt::format("material[{}].{}", i, named.key);
        const auto placeOf = [&](const auto& member) {
            return findPlace(scene.places,
                             fmt::format("{}.{}", value, keyName(*named.texture, member)));
        };
        // Weights are no colours: a mask of bytes means what it says.
        const bool data = named.isData && named.texture->colourSpace.empty();
        const auto image =
            reader.read(named.texture->image, data ? "data" : named.texture->colourSpace,
                        placeOf(named.texture->image));
        textures.back() = image;
        const Rgb largest = named.texture->colour * image->maximum();
        if (!named.limited || largest.maximum() <= almostOne) continue;
        const std::string place = named.texture->colour == Rgb(1) ? placeOf(named.texture->image)
                                                                  : placeOf(named.texture->colour);
        inPlace(place, [&] {
            throw inputError(
                "{} reaches {:.4g} with {}, but a {} is at most 1; give times = {:.3g} or less",
                value, largest.maximum(), named.texture->image.string(), named.key,
                std::floor(1000 / image->maximum().maximum()) / 1000);
        });
    }
    return textures;
}

Box3d surfaceBounds(const SurfaceDescription& surface, const LoadedSurface& loaded) {
    Box3d bounds;
    if (infinite(surface)) return bounds;
    const Box3d mesh = meshBounds(loaded);
    for (const Affine3d& instance : loaded.instances)
        bounds.add((surface.worldFromObject * instance * loaded.objectFromMesh).box(mesh));
    return bounds;
}

}  // namespace woodcock::scene
