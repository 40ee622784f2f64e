// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "woodcock/base/affine.h"
#include "woodcock/base/spectrum.h"
#include "woodcock/light/solar_position.h"

namespace woodcock::scene {

// The lights of a scene file, a structure a type. Each says what is asked of all of them below, in
// LightDescription.

enum class UpAxis { Y, Z };

/// Where the sun stands, in degrees: azimuth 0 is -z (y up) or +y (z up), 90 is +x.
struct SunPlace {
    double elevation = 0, azimuth = 0;
    UpAxis up = UpAxis::Y;
    bool operator==(const SunPlace&) const = default;

    /// The way its light travels.
    Vec3d direction() const;
};

struct SunDescription {
    Vec3d direction{0, -1, 0};           ///< the way its light travels, of any length
    Rgb irradiance{1.0f};                ///< on a surface perpendicular to it
    double angularDiameter = 0;          ///< degrees; 0: parallel rays
    bool visible = false;                ///< to camera rays (needs an angular diameter)
    std::optional<SunPlace> place = {};  ///< where `direction` follows from it: so it is written
    bool operator==(const SunDescription&) const = default;

    Rgb brightness() const { return irradiance; }
    bool glows() const { return visible; }
};

struct EnvironmentDescription {
    Rgb radiance{1.0f};                ///< multiplies the image where there is one
    std::filesystem::path image = {};  ///< lat-long, scene-linear; empty: constant
    UpAxis up = UpAxis::Y;             ///< Y: the image's centre is towards -z; Z: towards +y
    double rotation = 0;               ///< degrees about the up axis, counter-clockwise from above
    bool visible = true;               ///< to camera rays
    /// Radiance straight up and straight down; where one is there, `radiance` is the horizon's. See
    /// light::gradedImage(). Not with an image.
    std::optional<Rgb> above = {}, below = {};
    bool operator==(const EnvironmentDescription&) const = default;

    bool graded() const { return above || below; }
    Rgb brightness() const {
        const Rgb top = above.value_or(radiance), bottom = below.value_or(radiance);
        return Rgb::map([&](int c) { return std::max({radiance[c], top[c], bottom[c]}); });
    }
    bool glows() const { return false; }
};

/// Where on Earth a sky is seen, and when.
struct SkyMoment {
    light::EarthPlace place;
    light::CivilTime time;
    bool operator==(const SkyMoment&) const = default;
};

/// The clear sky of a light::SkyModel, and its sun.
struct SkyDescription {
    SunPlace place = {};                   ///< of the sun
    std::optional<SkyMoment> moment = {};  ///< where `place` follows from it: so it is written
    double turbidity = 3;
    Rgb groundAlbedo{0.2f};
    bool ground = true;      ///< seen below the horizon; else there is nothing
    bool sun = true;         ///< beside the sky
    double sunSize = 0.53;   ///< degrees
    double sunStrength = 1;  ///< multiplies the sun alone
    double strength = 0.03;  ///< multiplies the model's W / (m^2 sr)
    bool visible = true;     ///< to camera rays
    bool operator==(const SkyDescription&) const = default;

    Rgb brightness() const { return Rgb(static_cast<float>(strength)); }
    bool glows() const { return visible && sun && sunSize > 0; }
};

/// The axes of a lamp that shines along `direction` (world, of any length): its column y is that
/// direction, its column x lies level, across the up axis, or towards +x where the lamp shines up
/// or down. Turned by `roll` degrees about the direction, counter-clockwise for who looks into the
/// light. All are unit.
Affine3d lampAxes(Vec3d direction, UpAxis up, double roll);

struct PointDescription {
    Vec3d position;
    Rgb intensity{1.0f};             ///< radiance x area: power per solid angle
    std::filesystem::path ies = {};  ///< a photometric file that multiplies it; empty: none
    Vec3d direction{0, -1, 0};       ///< where the file's vertical angle 0 points
    UpAxis up = UpAxis::Y;           ///< as lampAxes() has it; so has `roll`
    double roll = 0;
    bool operator==(const PointDescription&) const = default;

    Rgb brightness() const { return intensity; }
    bool glows() const { return false; }
    Affine3d axes() const { return lampAxes(direction, up, roll); }
};

struct SpotDescription {
    Vec3d position;
    Vec3d direction{0, -1, 0};  ///< of the cone's axis, of any length
    Rgb intensity{1.0f};        ///< along the axis: power per solid angle
    double cone = 45;           ///< degrees from edge to edge
    double blend = 0.15;        ///< the part of it, by 1 - cos, that the soft edge takes
    bool operator==(const SpotDescription&) const = default;

    Rgb brightness() const { return intensity; }
    bool glows() const { return false; }
};

struct SphereDescription {
    Vec3d position;
    double radius = 1;
    Rgb radiance{1.0f};
    bool visible = true;  ///< to camera rays
    bool operator==(const SphereDescription&) const = default;

    Rgb brightness() const { return radiance; }
    bool glows() const { return visible; }
};

/// What rectangles and disks have in common. They lie in y = 0 of their own space, and shine
/// towards +y.
struct FlatDescription {
    Rgb radiance{1.0f};       ///< power per area and pi
    Affine3d worldFromLight;  ///< its axes are perpendicular
    double spread = 180;      ///< degrees: the whole angle within which it shines; 180: evenly
    bool twoSided = false;
    bool visible = true;  ///< to camera rays
    bool operator==(const FlatDescription&) const = default;

    Rgb brightness() const { return radiance; }
    bool glows() const { return visible; }
};

struct RectangleDescription : FlatDescription {
    std::array<double, 2> size{1, 1};  ///< along x and z of its own space
    bool operator==(const RectangleDescription&) const = default;
};

struct DiskDescription : FlatDescription {
    double radius = 1;  ///< in its own space
    bool operator==(const DiskDescription&) const = default;
};

template <class L>
concept IsLightDescription = std::equality_comparable<L> && requires(const L& l) {
    { l.brightness() } -> std::same_as<Rgb>;
    { l.glows() } -> std::same_as<bool>;
};

/// A light of any type.
struct LightDescription {
    std::variant<SunDescription, PointDescription, SpotDescription, SphereDescription,
                 RectangleDescription, DiskDescription, EnvironmentDescription, SkyDescription>
        light;
    std::string group = {};  ///< of lights: see lightGroups(); empty: none
    bool operator==(const LightDescription&) const = default;

    /// How bright it is, in its own unit; 0: it is dark.
    Rgb brightness() const {
        return std::visit([]<IsLightDescription L>(const L& l) { return l.brightness(); }, light);
    }
    /// Whether camera rays see it where nothing covers; environments are no such thing.
    bool glows() const {
        return std::visit([]<IsLightDescription L>(const L& l) { return l.glows(); }, light);
    }
};

}  // namespace woodcock::scene
