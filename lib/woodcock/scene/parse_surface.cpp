// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "woodcock/base/nearest_name.h"
#include "woodcock/scene/parse_sections.h"
#include "woodcock/scene/parse_values.h"

namespace woodcock {
namespace {

using Base = const std::filesystem::path&;

const std::vector<std::string> shapeKeys{"file",  "sphere", "box",   "disk",
                                         "plane", "lathe",  "facets"};
constexpr int mostPriority = 1'000'000, mostSegments = 100'000, mostFacets = 1000;

MeshShape parseMesh(const TomlTable& surface, Base base) {
    const TomlValue file = *surface.find("file");
    MeshShape shape{file.path(base), {}};
    if (const auto v = surface.find("level_set")) {
        if (shape.file.extension() != ".vdb" && shape.file.extension() != ".nvdb")
            throw v->error("names a grid of a VDB file, but file is '{}'", shape.file.string());
        shape.levelSet = v->text();
    }
    return shape;
}

SphereShape parseSphere(const TomlValue& value) {
    const TomlTable table = value.table();
    table.allowOnly({"centre", "radius"}, value.name());
    SphereShape shape;
    if (const auto v = table.find("centre")) shape.centre = v->vector();
    if (const auto v = table.find("radius")) shape.radius = v->number(positive);
    return shape;
}

DiskShape parseDisk(const TomlValue& value) {
    const TomlTable table = value.table();
    table.allowOnly({"radius"}, value.name());
    DiskShape shape;
    if (const auto v = table.find("radius")) shape.radius = v->number(positive);
    return shape;
}

PlaneShape parsePlane(const TomlValue& value) {
    const TomlTable table = value.table();
    table.allowOnly({"size"}, value.name());
    PlaneShape shape;
    if (const auto v = table.find("size")) {
        const auto sides = v->elements("[width, depth]", 2);
        shape.size = {sides[0].number(positive), sides[1].number(positive)};
    }
    return shape;
}

LatheShape parseLathe(const TomlValue& value) {
    const TomlTable table = value.table();
    table.allowOnly({"profile", "segments"}, value.name());
    LatheShape shape;
    const TomlValue profile = table.need("profile", "profile = [[0, 0], [1, 0], [1, 2], [0, 2]]");
    for (const TomlValue& point : profile.elements("a list of [radius, height]")) {
        const auto pair = point.elements("[radius, height]", 2);
        shape.profile.push_back({pair[0].number(notNegative), pair[1].number()});
    }
    if (shape.profile.size() < 2)
        throw profile.error("has {} points; a lathe needs two at least", shape.profile.size());
    if (const auto v = table.find("segments")) shape.segments = v->integer(3, mostSegments);
    return shape;
}

FacetShape parseFacets(const TomlValue& value) {
    FacetShape shape;
    for (const TomlValue& element : value.elements("a list of rings of facets")) {
        const TomlTable table = element.table();
        table.allowOnly({"angle", "count", "distance", "turn"}, element.name());
        FacetRing ring;
        ring.angle = table.need("angle", "angle = 34.5").number({0, 180});
        ring.distance = table.need("distance", "distance = 1").number(positive);
        if (const auto v = table.find("count")) ring.count = v->integer(1, mostFacets);
        if (const auto v = table.find("turn")) ring.turn = v->number();
        shape.rings.push_back(ring);
    }
    return shape;
}

auto parseShape(const TomlTable& table, Base base) -> decltype(SurfaceDescription::shape) {
    std::vector<std::string> given;
    for (const std::string& key : shapeKeys)
        if (table.has(key)) given.push_back(key);
    if (given.empty())
        throw table.error(
            "has no shape; give one of {}, such as file = \"mesh.obj\" or "
            "sphere = {{ centre = [0, 0, 0], radius = 1 }}",
            joinNames(shapeKeys));
    if (given.size() > 1)
        table.exclude(given[1], given[0], "a surface has one shape, and others are surfaces too");
    if (const auto v = table.find("level_set"); v && given[0] != "file")
        throw v->error("needs a file: it names a grid of a VDB file");
    const TomlValue value = *table.find(given[0]);
    if (given[0] == "file") return parseMesh(table, base);
    if (given[0] == "sphere") return parseSphere(value);
    if (given[0] == "box") return BoxShape{parseBounds(value)};
    if (given[0] == "disk") return parseDisk(value);
    if (given[0] == "plane") return parsePlane(value);
    if (given[0] == "facets") return parseFacets(value);
    return parseLathe(value);
}

/// An angle in degrees, "flat", or "file".
std::optional<double> parseSmooth(const TomlValue& value, const SurfaceDescription& surface) {
    const bool file = std::holds_alternative<MeshShape>(surface.shape);
    if (!file && !std::holds_alternative<LatheShape>(surface.shape))
        throw value.error("is for surfaces of a file or a lathe; this one is as smooth as it is");
    if (!value.isText()) return value.number({0, 180});
    const std::array<std::string, 2> words{"flat", "file"};
    if (value.choice("smoothing", words) == 0) return 0;
    if (!file) throw value.error("is \"file\", but the surface is a lathe");
    return std::nullopt;
}

void parseInstances(const TomlValue& value, Base base, SurfaceDescription& surface) {
    if (value.isText()) {
        surface.instanceFile = value.path(base);
        return;
    }
    for (const TomlValue& element :
         value.elements("a list of transforms and matrices, or a file's name"))
        surface.instances.push_back(element.isTable() ? parseTransform(element, "surface")
                                                      : element.affine());
    if (surface.instances.empty())
        throw value.error("is empty; leave it out, and the surface stands there once");
}

/// What absorbs so that light of all colours becomes `colour` over `distance`.
Rgb absorptionOf(const TomlTable& medium, const TomlValue& colour) {
    for (const char* key : {"sigma_a", "scale", "albedo"})
        medium.exclude("colour", key, "both say how much the medium absorbs");
    const Vec3d rgb = colour.exactColour(zeroToOne);
    for (int i = 0; i < 3; ++i)
        if (rgb[i] == 0)
            throw colour.error(
                "is 0 in its {} channel, which would need infinite absorption; give what little "
                "comes through, such as 0.001",
                std::array{"red", "green", "blue"}[static_cast<size_t>(i)]);
    const auto distance = medium.find("distance");
    if (!distance)
        throw colour.error("needs a distance beside it: how far light goes to become so");
    const double d = distance->number(positive);
    const Rgb sigma =
        Rgb::map([&](int i) { return static_cast<float>(-std::log(rgb[i]) / d + 0.0); });
    if (!sigma.isFinite()) throw distance->error("is {}: too short for a float's sigma_a", d);
    return sigma;
}

InteriorDescription parseInterior(const TomlValue& value) {
    const TomlTable table = value.table();
    table.allowOnly(
        {"sigma_a", "sigma_s", "scale", "albedo", "colour", "distance", "g", "emission"},
        value.name());
    InteriorDescription interior;
    const auto colour = table.find("colour"), distance = table.find("distance");
    if (distance && !colour)
        throw distance->error("needs a colour beside it: what light becomes over that distance");
    if (table.keys().empty() || (table.has("g") && table.keys().size() == 1))
        throw value.error(
            "holds nothing; give sigma_a and sigma_s, scale and albedo, colour and distance, or "
            "emission, or leave it out");
    std::tie(interior.sigmaA, interior.sigmaS) = parseCoefficients(table);
    if (colour) interior.sigmaA = absorptionOf(table, *colour);
    if (const auto v = table.find("g")) interior.g = parseG(*v);
    if (const auto v = table.find("emission")) interior.emission = v->colour(notNegative);
    return interior;
}

void parseCompositing(const TomlTable& table, SurfaceDescription& surface) {
    if (const auto v = table.find("camera_visible")) surface.cameraVisible = v->flag();
    std::string chosen = surface.cameraVisible ? "" : "camera_visible = false";
    const auto flag = [&](const char* key, bool& value) {
        const auto v = table.find(key);
        if (v) value = v->flag();
        if (!value) return;
        if (!chosen.empty())
            throw v->error(
                "is true, but so is {}: each says what the camera sees of the surface, "
                "and they contradict each other",
                chosen);
        chosen = key;
    };
    flag("holdout", surface.holdout);
    flag("shadow_catcher", surface.shadowCatcher);
    flag("matte", surface.matte);
}

}  // namespace

SurfaceDescription parseSurface(const TomlTable& table, Base base) {
    table.allowOnly({"name",     "file",      "level_set",      "sphere",    "box",
                     "disk",     "plane",     "lathe",          "facets",    "material",
                     "smooth",   "transform", "matrix",         "instances", "medium",
                     "priority", "holdout",   "shadow_catcher", "matte",     "camera_visible"},
                    "[[surface]]");
    SurfaceDescription surface;
    if (const auto v = table.find("name")) surface.name = v->text();
    surface.shape = parseShape(table, base);
    if (const auto v = table.find("material")) surface.material = v->text();
    if (const auto v = table.find("smooth")) surface.smooth = parseSmooth(*v, surface);
    surface.worldFromObject = parsePlacement(table, "surface");
    if (const auto v = table.find("instances")) parseInstances(*v, base, surface);
    if (const auto v = table.find("medium")) surface.interior = parseInterior(*v);
    if (const auto v = table.find("priority"))
        surface.priority = v->integer(-mostPriority, mostPriority);
    parseCompositing(table, surface);
    return surface;
}

}  // namespace woodcock
