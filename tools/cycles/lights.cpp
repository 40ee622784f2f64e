// SPDX-License-Identifier: Apache-2.0
#include "tools/cycles/lights.h"

#include <spdlog/spdlog.h>

#include <nlohmann/json.hpp>

#include "tools/cycles/json.h"
#include "tools/cycles/motion.h"
#include "woodcock/image/film.h"
#include "woodcock/image/write_exr.h"
#include "woodcock/light/graded_image.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/sky.h"

namespace woodcock::tool {

namespace {

using nlohmann::json;

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
            {"visible", sphere.visible},
            {"motion", nullptr}};
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

/// Cycles blurs objects, and so spheres, which are meshes there; it takes its own lights as they
/// are at the frame.
void addMotion(json& light, const scene::SceneDescription& scene, const light::LightMotion& motion,
               std::size_t index) {
    const std::string table = fmt::format("light[{}]", index), place = placeOfKeys(scene, table);
    const auto* sphere = std::get_if<scene::SphereDescription>(&scene.lights[index].light);
    if (motion.form)
        throw cyclesRefusal(place,
                            "a light whose size or brightness changes while the shutter is "
                            "open");
    if (motion.place && !sphere)
        throw cyclesRefusal(
            place, "a {} light that moves while the shutter is open; a sphere may",
            !light.contains("shape") ? light["type"].get<std::string>() : "rectangle or disk");
    if (sphere)
        light["motion"] =
            cyclesMotion(motion.place, Affine3d::translate(sphere->position), scene, table);
}

}  // namespace

json cyclesLight(const scene::SceneDescription& scene, const scene::Movements& movements,
                 std::size_t index) {
    json light = std::visit(
        [&]<class L>(const L& described) -> json {
            return lightJson(described, PlacesOfLight<L>{scene.places, index, described});
        },
        scene.lights[index].light);
    if (index < movements.lights.size()) addMotion(light, scene, movements.lights[index], index);
    if (!light.is_array()) light = json::array({std::move(light)});
    return light;
}

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

}  // namespace woodcock::tool
