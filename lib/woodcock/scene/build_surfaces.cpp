// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/build.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "woodcock/base/error.h"
#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/choose_camera.h"
#include "woodcock/scene/light_groups.h"
#include "woodcock/scene/load_surfaces.h"
#include "woodcock/surface/material.h"

namespace woodcock::scene {
namespace {

// ---- materials

/// In the list of buildMaterials(); the empty name is the default's.
std::uint32_t materialIndex(const SceneDescription& description, std::string_view name) {
    return static_cast<std::uint32_t>(
        findNamed(description.materials, name).value_or(description.materials.size()));
}

using Image = std::shared_ptr<const surface::TextureImage>;

surface::Material buildMaterial(const DiffuseDescription& m, const Image& image,
                                const SceneDescription&) {
    return surface::DiffuseMaterial{makeTexture(m.colour, image)};
}
surface::Material buildMaterial(const ConductorDescription& m, const Image& image,
                                const SceneDescription&) {
    surface::ConductorMaterial conductor;
    conductor.fresnelColour = makeTexture(m.colour, image);
    conductor.roughness = m.roughness;
    conductor.schlick = !m.etaK;
    if (m.etaK) std::tie(conductor.eta, conductor.k) = *m.etaK;
    return conductor;
}
surface::Material buildMaterial(const DielectricDescription& m, const Image&,
                                const SceneDescription&) {
    return surface::DielectricMaterial{m.ior, m.roughness};
}
surface::Material buildMaterial(const InterfaceDescription&, const Image&,
                                const SceneDescription&) {
    return surface::InterfaceMaterial();
}
surface::Material buildMaterial(const EmissiveDescription& m, const Image& image,
                                const SceneDescription&) {
    return surface::EmissiveMaterial{surface::Texture(m.radiance.colour, image), m.bothSides};
}
surface::Material buildMaterial(const MixDescription& m, const Image& image,
                                const SceneDescription& scene) {
    return surface::MixMaterial{materialIndex(scene, m.first), materialIndex(scene, m.second),
                                makeTexture(m.weight, image)};
}

/// What a surface sends out.
struct Emission {
    Rgb radiance{0.0f};
    bool bothSides = false;
};

/// At texture coordinates, from the side that it faces or from the other.
Emission emissionAt(const std::vector<surface::Material>& materials, std::uint32_t index, double u,
                    double v, bool front) {
    if (const auto* emissive = std::get_if<surface::EmissiveMaterial>(&materials[index])) {
        const bool dark = !front && !emissive->bothSides;
        return {dark ? Rgb(0.0f) : emissive->radiance.at(u, v), emissive->bothSides};
    }
    const auto* mix = std::get_if<surface::MixMaterial>(&materials[index]);
    if (!mix) return {};
    const float weight = mix->weight.at(u, v).mean();
    const Emission first = emissionAt(materials, mix->first, u, v, front),
                   second = emissionAt(materials, mix->second, u, v, front);
    return {first.radiance * (1 - weight) + second.radiance * weight,
            first.bothSides || second.bothSides};
}

/// The longer side of the largest image that decides about emission; 0: there is none.
int finestTexture(const std::vector<surface::Material>& materials, std::uint32_t index) {
    const auto side = [](const surface::Texture& texture) {
        return texture.image ? std::max(texture.image->width(), texture.image->height()) : 0;
    };
    if (const auto* emissive = std::get_if<surface::EmissiveMaterial>(&materials[index]))
        return side(emissive->radiance);
    if (const auto* mix = std::get_if<surface::MixMaterial>(&materials[index]))
        return std::max({side(mix->weight), finestTexture(materials, mix->first),
                         finestTexture(materials, mix->second)});
    return 0;
}

/// How often to cut the sides of a triangle, so that the pieces are about two texels wide.
int cutsOf(const std::array<mesh::Vec2f, 3>& uv, int texels) {
    constexpr int most = 64;
    float longest = 0;
    for (size_t i = 0; i < 3; ++i) {
        const mesh::Vec2f a = uv[i], b = uv[(i + 1) % 3];
        longest = std::max({longest, std::abs(a.u - b.u), std::abs(a.v - b.v)});
    }
    const double pieces = std::ceil(double{longest} * texels / 2);
    return pieces < most ? std::max(1, static_cast<int>(pieces)) : most;
}

/// Mean over a triangle, from the centres of the equal pieces that `cuts` leave of it.
Emission meanOver(const std::vector<surface::Material>& materials, std::uint32_t index,
                  const std::array<mesh::Vec2f, 3>& uv, int cuts) {
    Vec3d sum;
    Emission mean;
    const auto add = [&](double b1, double b2) {
        const double b0 = 1 - b1 - b2;
        mean = emissionAt(materials, index, b0 * uv[0].u + b1 * uv[1].u + b2 * uv[2].u,
                          b0 * uv[0].v + b1 * uv[1].v + b2 * uv[2].v, true);
        sum += Vec3d{mean.radiance[0], mean.radiance[1], mean.radiance[2]};
    };
    for (int i = 0; i < cuts; ++i)
        for (int j = 0; i + j < cuts; ++j) {
            add((i + 1.0 / 3) / cuts, (j + 1.0 / 3) / cuts);
            if (i + j + 1 < cuts) add((i + 2.0 / 3) / cuts, (j + 2.0 / 3) / cuts);
        }
    sum = sum / (double(cuts) * cuts);
    mean.radiance = Rgb::map([&](int c) { return static_cast<float>(sum[c]); });
    return mean;
}

/// The materials in the order of the description, and after them the one of surfaces that name
/// none.
std::vector<surface::Material> buildMaterials(const SceneDescription& description,
                                              const LoadedScene& loaded) {
    std::vector<surface::Material> materials;
    for (size_t i = 0; i < description.materials.size(); ++i)
        materials.push_back(std::visit(
            [&](const auto& m) { return buildMaterial(m, loaded.textures[i], description); },
            description.materials[i].material));
    materials.emplace_back(surface::DiffuseMaterial());
    return materials;
}

/// Whether that is not the same everywhere and from both sides.
bool emissionVaries(const std::vector<surface::Material>& materials, std::uint32_t index) {
    return std::holds_alternative<surface::MixMaterial>(materials[index]) ||
           finestTexture(materials, index) > 0;
}

/// Of each triangle of a mesh of this material, textures averaged over it; empty where all are
/// dark.
std::vector<Emission> meanEmission(const std::vector<surface::Material>& materials,
                                   std::uint32_t material, const mesh::SurfaceMesh& mesh) {
    const int texels = mesh.uvs.empty() ? 0 : finestTexture(materials, material);
    std::vector<Emission> emission;
    bool dark = true;
    for (size_t i = 0; i < mesh.mesh.triangles.size(); ++i) {
        const auto uv = mesh.uvs.empty() ? std::array<mesh::Vec2f, 3>{} : mesh.uvs[i];
        emission.push_back(meanOver(materials, material, uv, cutsOf(uv, texels)));
        dark &= !(emission.back().radiance.maximum() > 0);
    }
    if (dark) emission.clear();
    return emission;
}

// ---- surfaces

Box3d grown(const Box3d& box, double by) {
    const Vec3d all = Vec3d{1, 1, 1} * by;
    return {box.lower - all, box.upper + all};
}

double largestCoordinate(const Box3d& box) {
    double largest = 0;
    for (int i = 0; i < 3; ++i)
        largest = std::max({largest, std::abs(box.lower[i]), std::abs(box.upper[i])});
    return largest;
}

/// A world box with room around all of a surface, for what it holds: the surface itself is what
/// bounds that, wherever it moves. Below an infinite plane it reaches 1e9 times as far as all there
/// is in the scene.
Box3d spaceAround(const SceneDescription& scene, const LoadedScene& loaded,
                  const Movements& movements, size_t index) {
    const Box3d rest = surfaceBounds(scene.surfaces[index], loaded.surfaces[index]);
    Box3d bounds = rest;
    if (!bounds.empty())
        for (const auto& movement : movements.surfaces[index])
            if (movement) bounds.add(movement->box(rest));
    // Of hits, floats may lose 1e-6.
    if (!bounds.empty())
        return grown(bounds, 0.01 * length(bounds.size()) + 1e-5 * largestCoordinate(bounds));
    Box3d all;
    for (const Vec3d& p : sceneOutline(scene, loaded)) all.add(p);
    if (scene.camera.pose) all.add(worldFromCamera(*scene.camera.pose).translation);
    for (const Affine3d& instance : loaded.surfaces[index].instances)
        all.add((scene.surfaces[index].worldFromObject * instance).translation);
    return grown(all, 1e9 * length(all.size()));
}

constexpr std::size_t mostEmitters = std::size_t{1} << 26;

surface::Shape shapeOf(const SurfaceDescription& surface, const LoadedSurface& loaded) {
    if (loaded.mesh) return loaded.mesh;
    if (std::holds_alternative<SphereShape>(surface.shape)) return surface::UnitSphere();
    if (std::holds_alternative<DiskShape>(surface.shape)) return surface::UnitDisk();
    return surface::InfinitePlane();
}

/// Of one emissive mesh, from its first emitter on.
struct EmissiveInstance {
    std::uint32_t firstEmitter;
    std::shared_ptr<const mesh::SurfaceMesh> mesh;
    std::uint32_t material;
    bool mirrored;
};

class Builder {
public:
    Builder(const SceneDescription& description, const LoadedScene& loaded,
            const Movements& movements)
        : description_(description),
          loaded_(loaded),
          movements_(movements),
          groups_(lightGroups(description)),
          materials_(buildMaterials(description, loaded)) {}

    BuiltSurfaces build() {
        for (size_t i = 0; i < description_.surfaces.size(); ++i) add(i);
        built_.set = std::make_shared<surface::SurfaceSet>(surface::SurfaceSet{
            surface::Geometry(std::move(shapes_), std::move(instances_)), std::move(objects_),
            std::move(materials_), std::move(firstEmitter_)});
        if (emissionVaries_) built_.radianceAt = radianceAt();
        return std::move(built_);
    }

private:
    void add(size_t index) {
        const SurfaceDescription& surface = description_.surfaces[index];
        const SurfaceNature nature = natureOf(description_, index);
        surface::SurfaceObject object;
        object.name = surface.name.empty() ? fmt::format("surface[{}]", index) : surface.name;
        object.material = materialIndex(description_, surface.material);
        object.holdsMedium = nature.encloses;
        object.ior = nature.ior;
        if (nature.encloses) object.medium = addInterior(index);
        object.priority = surface.priority;
        object.holdout = surface.holdout;
        object.shadowCatcher = surface.shadowCatcher;
        object.matte = surface.matte;
        object.cameraVisible = surface.cameraVisible;
        if (nature.emits && object.material < description_.materials.size())
            object.lightGroup = groupNumber(
                groups_, groupOfMaterial(description_, description_.materials[object.material]));
        addInstances(index, nature.emits, object);
        objects_.push_back(std::move(object));
    }

    void addInstances(std::size_t index, bool emits, const surface::SurfaceObject& like) {
        const SurfaceDescription& surface = description_.surfaces[index];
        const LoadedSurface& loaded = loaded_.surfaces[index];
        const auto& moves = movements_.surfaces[index];
        const auto shape = addShape(shapeOf(surface, loaded));
        const auto object = static_cast<std::uint32_t>(objects_.size());
        const std::vector<Emission> emission =
            emits ? meanEmission(materials_, like.material, *loaded.mesh) : std::vector<Emission>();
        for (std::size_t k = 0; k < loaded.instances.size(); ++k) {
            const Affine3d worldFromShape =
                surface.worldFromObject * loaded.instances[k] * loaded.objectFromMesh;
            const auto motion = moves.empty() ? nullptr : moves[k];
            instances_.push_back({shape, object, worldFromShape, motion});
            firstEmitter_.push_back(emission.empty()
                                        ? surface::SurfaceObject::dark
                                        : addEmitters(loaded.mesh, emission, worldFromShape, like));
            if (!emission.empty() && motion)
                built_.movingEmitters.push_back({firstEmitter_.back(),
                                                 static_cast<std::uint32_t>(built_.emitters.size()),
                                                 motion});
        }
    }

    /// Shapes that are the same are one.
    std::uint32_t addShape(const surface::Shape& shape) {
        const auto* mesh = std::get_if<std::shared_ptr<const mesh::SurfaceMesh>>(&shape);
        const auto next = static_cast<std::uint32_t>(shapes_.size());
        const auto [known, isNew] =
            known_.try_emplace({shape.index(), mesh ? mesh->get() : nullptr}, next);
        if (isNew) shapes_.push_back(shape);
        return known->second;
    }

    std::uint32_t addEmitters(const std::shared_ptr<const mesh::SurfaceMesh>& mesh,
                              const std::vector<Emission>& emission, const Affine3d& worldFromMesh,
                              const surface::SurfaceObject& like) {
        const size_t first = built_.emitters.size();
        if (emission.size() > mostEmitters - first)
            throw inputError(
                "the emissive surfaces have more than {} triangles, all instances counted; give "
                "the light to simpler ones",
                mostEmitters);
        // A mirror image runs around its corners the other way, and faces outwards all the same.
        const bool mirrored = worldFromMesh.determinant() < 0;
        for (size_t i = 0; i < emission.size(); ++i) {
            const auto& t = mesh->mesh.triangles[i];
            const auto corner = [&](size_t k) {
                return worldFromMesh.point(mesh->mesh.points[t[k]].as<double>());
            };
            built_.emitters.push_back(
                {{corner(0), corner(mirrored ? 2 : 1), corner(mirrored ? 1 : 2)},
                 emission[i].radiance,
                 emission[i].bothSides,
                 like.lightGroup});
        }
        emissionVaries_ |= emissionVaries(materials_, like.material);
        emissive_.push_back({static_cast<std::uint32_t>(first), mesh, like.material, mirrored});
        return static_cast<std::uint32_t>(first);
    }

    light::MeshLight::RadianceAt radianceAt() {
        return [set = built_.set, instances = std::move(emissive_)](
                   std::uint32_t emitter, double b1, double b2, bool front) {
            const auto after = std::upper_bound(
                instances.begin(), instances.end(), emitter,
                [](std::uint32_t e, const EmissiveInstance& i) { return e < i.firstEmitter; });
            const EmissiveInstance& instance = *std::prev(after);
            if (instance.mirrored) std::swap(b1, b2);
            const auto& uvs = instance.mesh->uvs;
            const auto uv =
                uvs.empty() ? std::array<mesh::Vec2f, 3>{} : uvs[emitter - instance.firstEmitter];
            const double b0 = 1 - b1 - b2;
            return emissionAt(set->materials, instance.material,
                              b0 * uv[0].u + b1 * uv[1].u + b2 * uv[2].u,
                              b0 * uv[0].v + b1 * uv[1].v + b2 * uv[2].v, front)
                .radiance;
        };
    }

    /// What SurfaceObject::medium says of it.
    std::uint32_t addInterior(size_t index) {
        const SurfaceDescription& surface = description_.surfaces[index];
        medium::Medium medium;
        std::vector<std::uint32_t> owners;
        if (!surface.name.empty()) {
            medium = buildMedium(description_, loaded_, movements_, surface.name);
            for (const size_t volume : volumesOfParts(description_, loaded_, surface.name))
                owners.push_back(static_cast<std::uint32_t>(volume));
        }
        if (surface.interior) fill(medium, *surface.interior, index);
        // What is not a volume's is the surface's own.
        owners.resize(medium.parts.size(),
                      static_cast<std::uint32_t>(description_.volumes.size() + index));
        if (!medium.parts.empty() || !medium.emission.empty()) {
            built_.interiorMedia.push_back(std::move(medium));
            built_.partOwners.push_back(std::move(owners));
            return static_cast<std::uint32_t>(built_.interiorMedia.size());
        }
        if (vacuum_ == 0) {
            built_.interiorMedia.emplace_back();
            built_.partOwners.emplace_back();
            vacuum_ = static_cast<std::uint32_t>(built_.interiorMedia.size());
        }
        return vacuum_;
    }

    /// Evenly.
    void fill(medium::Medium& medium, const InteriorDescription& interior, size_t index) const {
        const Box3d space = spaceAround(description_, loaded_, movements_, index);
        if ((interior.sigmaA + interior.sigmaS).maximum() > 0) {
            medium::MediumPart::Description part;
            part.box = space;
            part.absorption = interior.sigmaA;
            part.scattering = interior.sigmaS;
            part.phase = buildPhase(interior.g, interior.phase, loaded_.interiorPhases[index]);
            medium.parts.emplace_back(std::move(part));
        }
        if (interior.emission.maximum() > 0) {
            medium::EmissionPart::Description part;
            part.box = space;
            part.scale = interior.emission;
            part.group = groupNumber(groups_, interior.group);
            medium.emission.emplace_back(std::move(part));
        }
    }

    const SceneDescription& description_;
    const LoadedScene& loaded_;
    const Movements& movements_;
    const std::vector<std::string> groups_;
    std::vector<surface::Material> materials_;
    std::vector<surface::Shape> shapes_;
    std::map<std::pair<std::size_t, const mesh::SurfaceMesh*>, std::uint32_t> known_;
    std::vector<surface::ShapeInstance> instances_;
    std::vector<surface::SurfaceObject> objects_;
    std::vector<std::uint32_t> firstEmitter_;
    std::vector<EmissiveInstance> emissive_;
    bool emissionVaries_ = false;
    std::uint32_t vacuum_ = 0;  ///< the interior that holds nothing; 0: not yet needed
    BuiltSurfaces built_;
};

}  // namespace

BuiltSurfaces buildSurfaces(const SceneDescription& description, const LoadedScene& loaded,
                            const Movements& movements) {
    if (description.surfaces.empty()) return {};
    return Builder(description, loaded, movements).build();
}

}  // namespace woodcock::scene
