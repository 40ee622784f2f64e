// SPDX-License-Identifier: Apache-2.0
#include "tools/cycles/scene.h"

#include <spdlog/spdlog.h>

#include <cmath>

#include "tools/cycles/json.h"
#include "tools/cycles/lights.h"
#include "tools/cycles/motion.h"
#include "tools/cycles/surfaces.h"
#include "woodcock/grid/vdb/file.h"
#include "woodcock/grid/velocity.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/keys/sections.h"

namespace woodcock::tool {

namespace {

using nlohmann::json;

// ---- volumes

class VolumeWriter {
public:
    VolumeWriter(const scene::SceneDescription& scene, const scene::LoadedScene& loaded,
                 const scene::Movements::Movement& movement, std::size_t index)
        : scene_(scene),
          volume_(scene.volumes[index]),
          loaded_(loaded.volumes[index]),
          movement_(movement),
          places_(scene.places),
          fps_(scene.render.fps),
          name_(fmt::format("volume[{}]", index)),
          scatters_(scene.render.maxScatterings != 0) {}

    void addTo(json& list) const {
        if (!volume_.inside.empty())
            throw cyclesRefusal(place(volume_.inside), "a volume inside the surface '{}'",
                                volume_.inside);
        if (volume_.repair)
            throw cyclesRefusal(place(volume_.repair),
                                "a volume that is repaired as it is loaded: it reads the "
                                "file as it is; save it repaired with woodcock convert --repair");
        if (!volume_.file.empty() && grid::listGrids(volume_.file).nanoVdb)
            throw cyclesRefusal(place(volume_.file),
                                "a file of NanoVDB: Blender reads none; `woodcock convert {} "
                                "x.vdb` makes a VDB of it",
                                volume_.file.string());
        const std::size_t first = list.size();
        std::visit([&](const auto& c) { add(list, c); }, volume_.coefficients);
        if (loaded_.emission)
            sharing(list, first, loaded_.emission)["emission"] =
                emissionJson(volume_.emission->scale, loaded_.emission.grid);
        if (volume_.blackbody)
            sharing(list, first, loaded_.blackbody)["blackbody"] = blackbodyJson();
        const json motion = cyclesMotion(movement_, volume_.worldFromObject, scene_, name_);
        for (std::size_t i = first; i < list.size(); ++i) list[i]["motion"] = motion;
    }

private:
    template <class Member>
    std::string place(const Member& member) const {
        return scene::findPlace(places_, name_ + "." + scene::keyName(volume_, member));
    }
    template <class Member>
    std::string placeInBlackbody(const Member& member) const {
        return scene::findPlace(
            places_, fmt::format("{}.{}.{}", name_, scene::keyName(volume_, volume_.blackbody),
                                 scene::keyName(*volume_.blackbody, member)));
    }

    CyclesPhase phase() const {
        return phaseFor(volume_, [&](const auto& member) { return place(member); });
    }
    json fileJson(const scene::LoadedField& field, Rgb sigmaA, Rgb sigmaS) const {
        json grid = mediumJson(sigmaA, sigmaS, phase(), scatters_);
        grid["file"] = std::filesystem::absolute(volume_.file).string();
        grid["matrix"] = toJson(volume_.worldFromObject);
        grid["object_from_index"] = toJson(field.objectFromIndex);
        grid["grid"] = grid["albedo_grid"] = grid["blackbody"] = nullptr;
        grid["velocity"] = velocityJson();
        return grid;
    }

    /// Null where the volume stands still. Per second: Cycles takes velocities per frame as they
    /// are, whatever the shutter.
    json velocityJson() const {
        if (!loaded_.velocity) return nullptr;
        const scene::VelocityDescription& v = volume_.velocity;
        for (int i = 0; i < 3; ++i)
            if (loaded_.velocity->source(i).offset != Vec3d{})
                throw cyclesRefusal(place(v.sampling),
                                    "staggered velocities: it reads them in the middle of voxels, "
                                    "as velocity_sampling = \"collocated\" does");
        std::string grid = loaded_.velocities;
        if (const auto comma = grid.find(','); comma != std::string::npos) {
            grid.resize(comma - 1);  // without the x of the first of three
            if (grid.ends_with('.') || grid.ends_with('_')) grid.pop_back();
        }
        return {{"grid", grid}, {"scale", v.timeOfFrame(fps_) * fps_}};
    }

    /// The object among this volume's whose voxels are those of a grid; a new one without any.
    json& sharing(json& list, std::size_t first, const scene::LoadedField& field) const {
        for (std::size_t i = first; i < list.size(); ++i)
            if (list[i]["object_from_index"] == toJson(field.objectFromIndex)) return list[i];
        list.push_back(fileJson(field, Rgb(0), Rgb(0)));
        return list.back();
    }

    json blackbodyJson() const {
        const scene::BlackbodyDescription& b = *volume_.blackbody;
        if (b.offset != 0)
            throw cyclesRefusal(placeInBlackbody(b.offset),
                                "an offset of temperatures, {}: it can only multiply them",
                                b.offset);
        if (b.scale < 0)
            throw cyclesRefusal(placeInBlackbody(b.scale), "a scale of temperatures below 0, {}",
                                b.scale);
        if (loaded_.ambient != 0)
            throw cyclesRefusal(place(volume_.blackbody),
                                "the background {} of the temperature grid '{}': it would glow "
                                "there, too",
                                loaded_.ambient, loaded_.blackbody.grid);
        const CyclesBlackbody blackbody = cyclesBlackbody(b);
        return {{"grid", loaded_.blackbody.grid},
                {"temperature", blackbody.temperature},
                {"intensity", blackbody.intensity},
                {"tint", toJson(blackbody.tint)}};
    }

    json gridJson(const scene::LoadedField& field, Rgb sigmaA, Rgb sigmaS) const {
        for (int c = 0; c < field.field->channels(); ++c)
            if (field.field->background(c) != 0)
                throw cyclesRefusal(place(volume_.file),
                                    "the background {} of grid '{}': it draws active voxels "
                                    "alone",
                                    field.field->background(c), field.grid);
        json grid = fileJson(field, sigmaA, sigmaS);
        grid["grid"] = field.grid;
        grid["colour"] = field.field->channels() > 1;
        return grid;
    }

    void add(json& list, const scene::DensityCoefficients& c) const {
        const auto [sigmaA, sigmaS] = scene::splitByAlbedo(*c.scale, c.albedo);
        json grid = gridJson(loaded_.density, sigmaA, sigmaS);
        if (loaded_.albedo && scatters_) {
            grid["albedo_grid"] = loaded_.albedo.grid;
            grid["albedo_from_index"] = toJson(loaded_.albedo.objectFromIndex);
            grid["absorbs"] = true;  // what the grid takes from scattering
        }
        list.push_back(std::move(grid));
    }
    void add(json& list, const scene::SeparateCoefficients& c) const {
        const Rgb none(0);
        const bool sameGrid = c.sigmaA && c.sigmaS && loaded_.sigmaA.field == loaded_.sigmaS.field;
        if (sameGrid)
            return list.push_back(gridJson(loaded_.sigmaA, c.sigmaA->scale, c.sigmaS->scale));
        if (c.sigmaA) list.push_back(gridJson(loaded_.sigmaA, c.sigmaA->scale, none));
        if (c.sigmaS) list.push_back(gridJson(loaded_.sigmaS, none, c.sigmaS->scale));
    }
    void add(json& list, const scene::HomogeneousBox& c) const {
        json box = mediumJson(c.sigmaA, c.sigmaS, phase(), scatters_,
                              volume_.emission ? volume_.emission->scale : Rgb(0));
        box["box"] = {toJson(c.box.lower), toJson(c.box.upper)};
        box["matrix"] = toJson(volume_.worldFromObject);
        list.push_back(std::move(box));
    }

    const scene::SceneDescription& scene_;
    const scene::VolumeDescription& volume_;
    const scene::LoadedVolume& loaded_;
    const scene::Movements::Movement& movement_;
    const scene::Places& places_;
    double fps_;
    std::string name_;
    bool scatters_;
};

// ---- camera and settings

json cameraJson(const scene::SceneDescription& scene, const camera::CameraMotion* motion) {
    const scene::CameraDescription& camera = scene.camera;
    const bool orthographic = camera.kind == scene::CameraDescription::Kind::Orthographic;
    json out{{"type", orthographic ? "orthographic" : "perspective"},
             {"matrix", toJson(scene::worldFromCamera(*camera.pose))},
             {"shift", camera.shift},
             {"clip_start", 1e-6},
             {"clip_end", 1e9}};
    const camera::Shutter& shutter = camera.shutter;
    const auto place = [&](const auto& member) {
        return scene::findPlace(scene.places, "camera." + scene::keyName(camera, member));
    };
    const std::string position = cyclesShutterPosition(shutter);
    if (position.empty())
        throw cyclesRefusal(place(camera.shutter),
                            "a shutter that is neither open for as long before the frame as after "
                            "it, nor opens or closes at the frame, [{}, {}]",
                            shutter.open, shutter.close);
    out["shutter"] = shutter.length();
    out["shutter_position"] = position;
    out["times"] = cyclesTimes(shutter);
    out["motion"] = out["angles"] = nullptr;
    if (motion)  // its places are those in the world
        out["motion"] = cyclesMotion(motion->pose, Affine3d(), scene, "camera");
    if (motion && motion->lens) {
        out["angles"] = json::array();
        for (int i = 0; i <= cyclesMotionPieces; ++i) {
            const auto lens = camera::Lens::of(motion->lens->at(double(i) / cyclesMotionPieces));
            if (lens.shiftX != camera.shift[0] || lens.shiftY != camera.shift[1] || orthographic)
                throw cyclesRefusal(placeOfKeys(scene, "camera"),
                                    "a shift or an orthographic camera's height that changes while "
                                    "the shutter is open");
            out["angles"].push_back(lens.fovY * pi / 180);
        }
    }
    out["fps"] = scene.render.fps;
    if (orthographic)
        out["height"] = *camera.height;
    else
        out["angle"] = camera.fovY * pi / 180;
    return out;
}

template <class Member>
std::string placeInRender(const scene::SceneDescription& scene, const Member& member) {
    return scene::findPlace(scene.places, "render." + scene::keyName(scene.render, member));
}

/// Cycles bounds diffuse, glossy and transmitted bounces each by itself, or all kinds together.
json bouncesJson(const scene::SceneDescription& scene) {
    const scene::RenderDescription& render = scene.render;
    bool media = !scene.volumes.empty();
    for (const scene::SurfaceDescription& surface : scene.surfaces)
        media |= surface.interior.has_value();
    json out{{"volume", render.maxScatterings == 0 ? 0 : cyclesBounces(render.maxScatterings)},
             {"surface", cyclesMostBounces},
             {"all", cyclesMostBounces}};
    if (scene.surfaces.empty() || !render.maxBounces) return out;
    const std::string place = placeInRender(scene, render.maxBounces);
    if (*render.maxBounces == 0)
        throw cyclesRefusal(place, "surfaces that reflect nothing, {} = 0",
                            scene::keyName(render, render.maxBounces));
    out["surface"] = cyclesBounces(render.maxBounces);
    if (media)
        spdlog::warn(
            "{}: Cycles bounds diffuse, glossy and transmitted bounces by {} each, not "
            "together",
            place, *render.maxBounces);
    else
        out["all"] = out["surface"];
    return out;
}

json renderJson(const scene::SceneDescription& scene, const CyclesSettings& settings) {
    constexpr std::uint64_t seeds = 0x7fffffff;
    const scene::RenderDescription& render = scene.render;
    return {{"resolution", {render.width, render.height}},
            {"spp", render.spp},
            {"seed", render.seed % seeds},
            {"mode", settings.mode},
            {"step_rate", settings.stepRate},
            {"interpolation", settings.interpolation},
            {"threads", settings.threads},
            {"draw", settings.draw},
            {"bounces", bouncesJson(scene)}};
}

}  // namespace

std::string cyclesScene(const scene::SceneDescription& scene, const scene::LoadedScene& loaded,
                        const CyclesSettings& settings) {
    if (scene.render.approximations.transparentShadows)
        throw cyclesRefusal(placeInRender(scene, scene.render.approximations.transparentShadows),
                            "Woodcock's transparent shadows");
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        if (loaded.volumes[i].velocity && scene.camera.shutter.length() > 0 &&
            cyclesShutterPosition(scene.camera.shutter) == "END")
            throw cyclesRefusal(scene::findPlace(scene.places, "camera.shutter"),
                                "velocities while a shutter closes at the frame, as of volume[{}]",
                                i);
    const scene::Movements movements = scene::findMovements(scene, loaded);
    json volumes = json::array(), lights = json::array();
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        VolumeWriter(scene, loaded, movements.volumes[i], i).addTo(volumes);
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        for (json& part : cyclesLight(scene, movements, i)) lights.push_back(std::move(part));
    const json out{{"volumes", std::move(volumes)},
                   {"lights", std::move(lights)},
                   {"surfaces", cyclesSurfaces(scene, loaded, movements)},
                   {"camera", cameraJson(scene, movements.camera.get())},
                   {"render", renderJson(scene, settings)},
                   {"save", settings.save}};
    return out.dump(1);
}

}  // namespace woodcock::tool
