// SPDX-License-Identifier: Apache-2.0
#include "tools/cycles/scene.h"

#include <spdlog/spdlog.h>

#include <cmath>

#include "tools/cycles/json.h"
#include "tools/cycles/surfaces.h"
#include "woodcock/grid/vdb/file.h"
#include "woodcock/grid/velocity.h"
#include "woodcock/image/film.h"
#include "woodcock/image/write_exr.h"
#include "woodcock/light/graded_image.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/sky.h"

namespace woodcock::tool {

namespace {

using nlohmann::json;

// ---- volumes

class VolumeWriter {
public:
    VolumeWriter(const scene::SceneDescription& scene, const scene::LoadedScene& loaded,
                 std::size_t index)
        : volume_(scene.volumes[index]),
          loaded_(loaded.volumes[index]),
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

    const scene::VolumeDescription& volume_;
    const scene::LoadedVolume& loaded_;
    const scene::Places& places_;
    double fps_;
    std::string name_;
    bool scatters_;
};

// ---- lights

std::string skyFile(std::size_t light) { return fmt::format("sky{}.exr", light); }

/// A light as a description for Blender. `placeOf`: where the value of a member was written.
template <class PlaceOf>
json lightJson(const scene::SunDescription& sun, const PlaceOf& placeOf) {
    if (sun.visible)
        throw cyclesRefusal(placeOf(sun.visible),
                            "a sun that the camera sees; leave out its 'visible'");
    const CyclesColour light = cyclesColour(sun.irradiance);
    return {{"type", "sun"},
            {"direction", toJson(normalize(sun.direction))},
            {"strength", light.strength},
            {"colour", toJson(light.colour)},
            {"angle", sun.angularDiameter * pi / 180}};
}
template <class PlaceOf>
json lightJson(const scene::EnvironmentDescription& environment, const PlaceOf& placeOf) {
    json light{{"type", "environment"},
               {"radiance", toJson(environment.radiance)},
               {"visible", environment.visible},
               {"image", nullptr}};
    if (!environment.image.empty()) {
        light["image"] = std::filesystem::absolute(environment.image).string();
        light["image_from_world"] = toJson(cyclesImageFromWorld(environment));
    } else if (environment.graded()) {  // an image beside the description (writeCyclesSkies)
        light["radiance"] = toJson(Rgb(1.0f));
        light["image"] = skyFile(placeOf.light);
        light["image_from_world"] = toJson(cyclesImageFromWorld(environment));
    }
    return light;
}
template <class PlaceOf>
json lightJson(const scene::PointDescription& point, const PlaceOf&) {
    const CyclesColour light = cyclesPoint(point.intensity);
    Affine3d axes = point.axes();
    axes.translation = point.position;
    json ies = nullptr;
    if (!point.ies.empty()) ies = std::filesystem::absolute(point.ies).string();
    return {{"type", "point"},
            {"matrix", toJson(cyclesLamp(axes))},
            {"power", light.strength},
            {"colour", toJson(light.colour)},
            {"ies", ies}};
}
template <class PlaceOf>
json lightJson(const scene::SpotDescription& spot, const PlaceOf& placeOf) {
    if (spot.cone < cyclesNarrowestCone)
        throw cyclesRefusal(placeOf(spot.cone), "a spot's cone of {} degrees: Blender's least is 1",
                            spot.cone);
    const CyclesColour light = cyclesPoint(spot.intensity);
    return {{"type", "spot"},
            {"position", toJson(spot.position)},
            {"direction", toJson(normalize(spot.direction))},
            {"power", light.strength},
            {"colour", toJson(light.colour)},
            {"cone", spot.cone * pi / 180},
            {"blend", spot.blend}};
}
template <class PlaceOf>
json lightJson(const scene::SphereDescription& sphere, const PlaceOf&) {
    const CyclesColour light = cyclesColour(sphere.radiance);
    return {{"type", "sphere"},
            {"position", toJson(sphere.position)},
            {"radius", sphere.radius},
            {"strength", light.strength},
            {"colour", toJson(light.colour)},
            {"visible", sphere.visible}};
}

/// `shape`: Blender's name. `areaOfOne`: that of a shape as wide and as deep as 1.
template <class PlaceOf>
json flatJson(const scene::FlatDescription& flat, const char* shape, double sizeX, double sizeZ,
              double areaOfOne, const PlaceOf& placeOf) {
    if (flat.twoSided)
        throw cyclesRefusal(placeOf(flat.twoSided),
                            "an area light that shines to both sides; two of them do");
    const double width = sizeX * length(flat.worldFromLight.column[0]);
    const double depth = sizeZ * length(flat.worldFromLight.column[2]);
    const CyclesColour light = cyclesArea(flat.radiance, areaOfOne * width * depth);
    return {{"type", "area"},
            {"shape", shape},
            {"size", {width, depth}},
            {"matrix", toJson(cyclesLamp(flat.worldFromLight))},
            {"power", light.strength},
            {"colour", toJson(light.colour)},
            {"spread", flat.spread * pi / 180},
            {"visible", flat.visible}};
}
template <class PlaceOf>
json lightJson(const scene::RectangleDescription& r, const PlaceOf& placeOf) {
    return flatJson(r, "RECTANGLE", r.size[0], r.size[1], 1, placeOf);
}
template <class PlaceOf>
json lightJson(const scene::DiskDescription& disk, const PlaceOf& placeOf) {
    return flatJson(disk, "ELLIPSE", 2 * disk.radius, 2 * disk.radius, pi / 4, placeOf);
}

/// The radiance from all around, as an image beside the description (writeCyclesSkies), and a sun.
template <class PlaceOf>
json lightJson(const scene::SkyDescription& sky, const PlaceOf& placeOf) {
    scene::SkyParts parts = scene::partsOf(sky);
    json environment = lightJson(parts.environment, placeOf);
    environment["image"] = skyFile(placeOf.light);
    environment["image_from_world"] = toJson(cyclesImageFromWorld(parts.environment));
    if (!parts.sun) return json::array({environment});
    if (parts.sun->visible)
        spdlog::warn("light[{}]: Cycles does not show the sun's disc to the camera", placeOf.light);
    parts.sun->visible = false;
    return json::array({environment, lightJson(*parts.sun, placeOf)});
}

/// Where the members of a light were written.
template <class L>
struct PlacesOfLight {
    const scene::Places& places;
    std::size_t light;  ///< its index
    const L& described;

    template <class Member>
    std::string operator()(const Member& member) const {
        return scene::findPlace(
            places, fmt::format("light[{}].{}", light, scene::keyName(described, member)));
    }
};

/// What a light shows that no file of the scene holds; empty of most.
template <class L>
image::Image imageOf(const L&) {
    return {};
}
image::Image imageOf(const scene::SkyDescription& sky) { return scene::partsOf(sky).image; }
image::Image imageOf(const scene::EnvironmentDescription& environment) {
    if (!environment.graded()) return {};
    return {light::gradedImageWidth, light::gradedImageHeight, scene::gradedImageOf(environment)};
}

// ---- camera and settings

json cameraJson(const scene::SceneDescription& scene) {
    const scene::CameraDescription& camera = scene.camera;
    const bool orthographic = camera.kind == scene::CameraDescription::Kind::Orthographic;
    json out{{"type", orthographic ? "orthographic" : "perspective"},
             {"matrix", toJson(scene::worldFromCamera(*camera.pose))},
             {"shift", camera.shift},
             {"clip_start", 1e-6},
             {"clip_end", 1e9}};
    const camera::Shutter& shutter = camera.shutter;
    if (shutter.open != -shutter.close)
        throw cyclesRefusal(
            scene::findPlace(scene.places, "camera." + scene::keyName(camera, camera.shutter)),
            "a shutter that is not open for as long before the frame as after it, [{}, {}]",
            shutter.open, shutter.close);
    out["shutter"] = shutter.length();
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

void writeCyclesSkies(const std::filesystem::path& directory,
                      const scene::SceneDescription& scene) {
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const image::Image image =
            std::visit([](const auto& light) { return imageOf(light); }, scene.lights[i].light);
        if (image.rgb.empty()) continue;
        image::Film film(image.width, image.height, {0, 0, image.width, image.height});
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                film.add(x, y, image::FilmSample{.radiance = image.at(x, y), .alpha = 1});
        image::writeExr(directory / skyFile(i), film, {}, {});
    }
}

std::string cyclesScene(const scene::SceneDescription& scene, const scene::LoadedScene& loaded,
                        const CyclesSettings& settings) {
    if (scene.render.approximations.transparentShadows)
        throw cyclesRefusal(placeInRender(scene, scene.render.approximations.transparentShadows),
                            "Woodcock's transparent shadows");
    if (scene.camera.shutter.length() > 0 && !scene.animation.empty())
        throw cyclesRefusal(scene::findPlace(scene.places, "camera.shutter"),
                            "animated values while the shutter is open");
    json volumes = json::array(), lights = json::array();
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        VolumeWriter(scene, loaded, i).addTo(volumes);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        json light = std::visit(
            [&]<class L>(const L& described) -> json {
                return lightJson(described, PlacesOfLight<L>{scene.places, i, described});
            },
            scene.lights[i].light);
        if (!light.is_array()) light = json::array({std::move(light)});
        for (json& part : light) lights.push_back(std::move(part));
    }
    const json out{{"volumes", std::move(volumes)},
                   {"lights", std::move(lights)},
                   {"surfaces", cyclesSurfaces(scene, loaded)},
                   {"camera", cameraJson(scene)},
                   {"render", renderJson(scene, settings)},
                   {"save", settings.save}};
    return out.dump(1);
}

}  // namespace woodcock::tool
