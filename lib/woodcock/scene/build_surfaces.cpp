// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/build_surfaces.h"

#include <algorithm>
#include <map>

#include "woodcock/base/error.h"
#include "woodcock/scene/build_materials.h"
#include "woodcock/scene/build_medium.h"
#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/scene_bounds.h"

namespace woodcock::scene {
namespace {

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
    Builder(const SceneDescription& description, const LoadedScene& loaded)
        : description_(description),
          loaded_(loaded),
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
        const LoadedSurface& loaded = loaded_.surfaces[index];
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
        addInstances(surface, loaded, nature.emits, object.material);
        objects_.push_back(std::move(object));
    }

    void addInstances(const SurfaceDescription& surface, const LoadedSurface& loaded, bool emits,
                      std::uint32_t material) {
        const auto shape = addShape(shapeOf(surface, loaded));
        const auto object = static_cast<std::uint32_t>(objects_.size());
        const std::vector<Emission> emission =
            emits ? meanEmission(materials_, material, *loaded.mesh) : std::vector<Emission>();
        for (const Affine3d& instance : loaded.instances) {
            const Affine3d worldFromShape =
                surface.worldFromObject * instance * loaded.objectFromMesh;
            instances_.push_back({shape, object, worldFromShape});
            firstEmitter_.push_back(
                emission.empty() ? surface::SurfaceObject::dark
                                 : addEmitters(loaded.mesh, emission, worldFromShape, material));
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
                              std::uint32_t material) {
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
                 emission[i].bothSides});
        }
        emissionVaries_ |= emissionVaries(materials_, material);
        emissive_.push_back({static_cast<std::uint32_t>(first), mesh, material, mirrored});
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
        if (!surface.name.empty()) medium = buildMedium(description_, loaded_, surface.name);
        if (surface.interior) fill(medium, *surface.interior, index);
        if (!medium.parts.empty() || !medium.emission.empty()) {
            built_.interiorMedia.push_back(std::move(medium));
            return static_cast<std::uint32_t>(built_.interiorMedia.size());
        }
        if (vacuum_ == 0) {
            built_.interiorMedia.emplace_back();
            vacuum_ = static_cast<std::uint32_t>(built_.interiorMedia.size());
        }
        return vacuum_;
    }

    /// Evenly.
    void fill(medium::Medium& medium, const InteriorDescription& interior, size_t index) const {
        const Box3d space = spaceAround(description_, loaded_, index);
        if ((interior.sigmaA + interior.sigmaS).maximum() > 0) {
            medium::MediumPart::Description part;
            part.box = space;
            part.absorption = interior.sigmaA;
            part.scattering = interior.sigmaS;
            part.g = interior.g;
            medium.parts.emplace_back(std::move(part));
        }
        if (interior.emission.maximum() > 0) {
            medium::EmissionPart::Description part;
            part.box = space;
            part.scale = interior.emission;
            medium.emission.emplace_back(std::move(part));
        }
    }

    const SceneDescription& description_;
    const LoadedScene& loaded_;
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

BuiltSurfaces buildSurfaces(const SceneDescription& description, const LoadedScene& loaded) {
    if (description.surfaces.empty()) return {};
    return Builder(description, loaded).build();
}

}  // namespace woodcock::scene
