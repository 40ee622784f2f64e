// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/choose_glow.h"

#include <fmt/format.h>

#include <cmath>

#include "woodcock/medium/blackbody.h"
#include "woodcock/scene/choose_camera.h"

namespace woodcock::scene {
namespace {

constexpr double leastKelvins = 200;  // what goes beyond is no relative number
constexpr double leastFire = 1300;    // kelvins: what is colder shows, if at all, a dull red
constexpr double sootAlbedo = 0.6;

/// The grid that means fire, and how it becomes kelvins.
struct Fire {
    std::string grid;
    double largest = 0, scale = 0;

    explicit Fire(const LoadedVolume& loaded) {
        const double hottest = double{loaded.hottest};
        const bool cold = hottest >= leastKelvins && hottest < leastFire;
        const bool flames = cold || !(hottest > 0);
        const bool kelvins = !flames && hottest >= leastFire;
        grid = flames ? loaded.flames : loaded.temperatures;
        largest = double{flames ? loaded.brightest : loaded.hottest};
        const double exact = fireTemperature / largest;
        scale = kelvins ? 1 : roundTo(exact, magnitude(exact) - 1);
    }
    bool burns() const { return largest > 0 && std::isfinite(scale); }
};

/// Where it is hottest, a tenth of the volume's size has a radiance of this.
constexpr double brightness = 100;

double intensityOf(const Fire& fire, double size) {
    const double hottest = fire.scale * fire.largest;
    return 10 * brightness / (size * double{medium::blackbodyRadiance(hottest).maximum()});
}

}  // namespace

std::string chooseGlow(SceneDescription& scene, const LoadedVolume& loaded, size_t index) {
    VolumeDescription& volume = scene.volumes[index];
    const auto given = [&](const char* key) {
        return !findPlace(scene.places, fmt::format("volume[{}].{}", index, key)).empty();
    };
    if (volume.file.empty() || given("file") || volume.emission || volume.blackbody ||
        !loaded.density)
        return {};
    const Fire fire(loaded);
    if (!fire.burns()) return {};
    const Affine3d world = volume.worldFromObject * loaded.density.objectFromIndex;
    const double exact =
        intensityOf(fire, length(world.box(loaded.density.field->support()).size()));
    if (!(exact > 0) || !std::isfinite(exact) || exact > 1e14) return {};
    volume.blackbody = {.temperature = fire.grid,
                        .scale = fire.scale,
                        .intensity = roundTo(exact, magnitude(exact) - 1)};
    if (auto* c = std::get_if<DensityCoefficients>(&volume.coefficients); c && !given("albedo"))
        c->albedo = Vec3d{1, 1, 1} * sootAlbedo;
    return fmt::format("its '{}' glows, whose largest value, {:.4g}, is {:.0f} K", fire.grid,
                       fire.largest, fire.scale * fire.largest);
}

}  // namespace woodcock::scene
