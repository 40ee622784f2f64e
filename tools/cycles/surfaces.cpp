// SPDX-License-Identifier: Apache-2.0
#include "tools/cycles/surfaces.h"

#include <nlohmann/json.hpp>

#include "tools/cycles/json.h"
#include "tools/cycles/motion.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/mesh/surface_mesh.h"
#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/load_surfaces.h"

namespace woodcock::tool {

namespace {

using nlohmann::json;

constexpr int sphereRings = 128, diskSectors = 512;

json textureJson(const scene::TextureDescription& texture, const std::string& place) {
    json out{{"colour", toJson(texture.colour)}, {"image", nullptr}};
    if (texture.image.empty()) return out;
    if (!texture.colourSpace.empty() && texture.colourSpace != "data")
        throw cyclesRefusal(place, "the colour space '{}' of an image", texture.colourSpace);
    out["image"] = std::filesystem::absolute(texture.image).string();
    out["data"] = texture.colourSpace == "data";
    return out;
}

class MaterialWriter {
public:
    explicit MaterialWriter(const scene::SceneDescription& scene) : scene_(scene) {}

    json write(const std::string& name) const {
        if (name.empty()) return kind(scene::DiffuseDescription(), "");
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
            if (scene_.materials[i].name != name) continue;
            const std::string place =
                scene::findPlace(scene_.places, fmt::format("material[{}].type", i));
            return std::visit([&](const auto& m) { return kind(m, place); },
                              scene_.materials[i].material);
        }
        throw inputError("there is no material '{}'", name);
    }

private:
    json kind(const scene::DiffuseDescription& m, const std::string& place) const {
        return {{"type", "diffuse"}, {"colour", textureJson(m.colour, place)}};
    }
    json kind(const scene::ConductorDescription& m, const std::string& place) const {
        json out{{"type", "conductor"},
                 {"colour", textureJson(m.colour, place)},
                 {"roughness", m.roughness},
                 {"eta", nullptr}};
        if (m.etaK) out["eta"] = toJson(m.etaK->first), out["k"] = toJson(m.etaK->second);
        return out;
    }
    json kind(const scene::DielectricDescription& m, const std::string&) const {
        return {{"type", "dielectric"}, {"ior", m.ior}, {"roughness", m.roughness}};
    }
    json kind(const scene::InterfaceDescription&, const std::string&) const {
        return {{"type", "interface"}};
    }
    json kind(const scene::EmissiveDescription& m, const std::string& place) const {
        return {{"type", "emissive"},
                {"radiance", textureJson(m.radiance, place)},
                {"both_sides", m.bothSides}};
    }
    json kind(const scene::MixDescription& m, const std::string& place) const {
        scene::TextureDescription weight = m.weight;
        if (weight.colourSpace.empty()) weight.colourSpace = "data";
        return {{"type", "mix"},
                {"first", write(m.first)},
                {"second", write(m.second)},
                {"weight", textureJson(weight, place)}};
    }

    const scene::SceneDescription& scene_;
};

bool overlap(const Box3d& a, const Box3d& b) {
    for (int i = 0; i < 3; ++i)
        if (!(a.lower[i] < b.upper[i] && b.lower[i] < a.upper[i])) return false;
    return true;
}

/// What holds something replaces what is around it, where Cycles adds: refused where that differs.
void refuseReplacement(const scene::SceneDescription& scene, const scene::LoadedScene& loaded,
                       std::size_t index, const std::string& place) {
    const Box3d bounds = scene::surfaceBounds(scene.surfaces[index], loaded.surfaces[index]);
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i)
        if (i != index && scene::natureOf(scene, i).encloses &&
            overlap(bounds, scene::surfaceBounds(scene.surfaces[i], loaded.surfaces[i])))
            throw cyclesRefusal(place, "what one surface holds inside another, surface[{}]", i);
    const auto boundsOf = [&](std::size_t i) {
        const scene::VolumeDescription& volume = scene.volumes[i];
        if (const auto* box = std::get_if<scene::HomogeneousBox>(&volume.coefficients))
            return volume.worldFromObject.box(box->box);
        Box3d all;
        const scene::LoadedVolume& v = loaded.volumes[i];
        for (const scene::LoadedField* field :
             {&v.density, &v.sigmaA, &v.sigmaS, &v.emission, &v.blackbody})
            if (*field) {
                const Box3d part =
                    (volume.worldFromObject * field->objectFromIndex).box(field->field->extent());
                all.add(part.lower), all.add(part.upper);
            }
        return all;
    };
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        if (overlap(bounds, boundsOf(i)))
            throw cyclesRefusal(place, "a surface that replaces volume[{}] inside it", i);
}

json surfaceJson(const scene::SceneDescription& scene, const scene::LoadedScene& loaded,
                 const std::vector<scene::Movements::Movement>& moves, std::size_t index) {
    const scene::SurfaceDescription& surface = scene.surfaces[index];
    const scene::LoadedSurface& mesh = loaded.surfaces[index];
    const auto place = [&](const auto& member) {
        return scene::findPlace(
            scene.places, fmt::format("surface[{}].{}", index, scene::keyName(surface, member)));
    };
    if (surface.holdout) throw cyclesRefusal(place(surface.holdout), "a holdout as Woodcock does");
    if (surface.shadowCatcher)
        throw cyclesRefusal(place(surface.shadowCatcher), "a shadow catcher as Woodcock does");
    if (surface.matte) throw cyclesRefusal(place(surface.matte), "a matte surface");
    if (surface.priority != 0)
        throw cyclesRefusal(place(surface.priority), "priorities of surfaces");
    const auto* plane = std::get_if<scene::PlaneShape>(&surface.shape);
    if (plane && !plane->size)
        throw cyclesRefusal(place(*plane), "an infinite plane; give it a size");
    if (scene::natureOf(scene, index).encloses)
        refuseReplacement(scene, loaded, index, place(surface.material));

    json out{{"material", MaterialWriter(scene).write(surface.material)},
             {"camera_visible", surface.cameraVisible},
             {"medium", nullptr},
             {"instances", json::array()},
             {"motion", json::array()}};
    if (surface.interior)
        out["medium"] = mediumJson(
            surface.interior->sigmaA, surface.interior->sigmaS,
            phaseFor(*surface.interior, [&](const auto&) { return place(surface.interior); }),
            scene.render.maxScatterings != 0,
            cyclesEmissionWithin(surface.interior->emission, scene::natureOf(scene, index).ior));
    for (std::size_t k = 0; k < mesh.instances.size(); ++k) {
        const Affine3d there = surface.worldFromObject * mesh.instances[k] * mesh.objectFromMesh;
        out["instances"].push_back(toJson(there));
        out["motion"].push_back(cyclesMotion(moves.empty() ? nullptr : moves[k], there, scene,
                                             fmt::format("surface[{}]", index)));
    }
    return out;
}

template <class T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void writeMesh(const std::filesystem::path& file, const mesh::SurfaceMesh& mesh) {
    std::string bytes;
    for (const std::size_t count : {mesh.mesh.points.size(), mesh.mesh.triangles.size(),
                                    mesh.normals.size(), mesh.uvs.size()})
        append(bytes, static_cast<std::uint32_t>(count));
    for (const auto& point : mesh.mesh.points) append(bytes, point);
    for (const auto& triangle : mesh.mesh.triangles) append(bytes, triangle);
    for (const auto& normals : mesh.normals) append(bytes, normals);
    for (const auto& uvs : mesh.uvs) append(bytes, uvs);
    writeWholeFile(file, {reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
}

}  // namespace

json cyclesSurfaces(const scene::SceneDescription& scene, const scene::LoadedScene& loaded,
                    const scene::Movements& movements) {
    json surfaces = json::array();
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i)
        surfaces.push_back(surfaceJson(scene, loaded, movements.surfaces[i], i));
    return surfaces;
}

void writeCyclesMeshes(const std::filesystem::path& directory, const scene::SceneDescription& scene,
                       const scene::LoadedScene& loaded) {
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
        const auto file = directory / fmt::format("surface{}.mesh", i);
        if (loaded.surfaces[i].mesh)
            writeMesh(file, *loaded.surfaces[i].mesh);
        else if (std::holds_alternative<scene::SphereShape>(scene.surfaces[i].shape))
            writeMesh(file, mesh::sphereMesh(sphereRings));
        else
            writeMesh(file, mesh::diskMesh(diskSectors));
    }
}

}  // namespace woodcock::tool
