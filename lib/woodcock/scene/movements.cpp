// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/movements.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "woodcock/scene/animation.h"
#include "woodcock/scene/build.h"

namespace woodcock::scene {
namespace {

/// A description at the times of its shutter, each looked up once.
class Shot {
public:
    explicit Shot(const SceneDescription& description)
        : description_(description), keys_(keyFrames(description)) {
        const camera::Shutter& shutter = description.camera.shutter;
        breaks_.push_back(0);
        for (const double key : keys_) {
            const double u = (key - description.frame - shutter.open) / shutter.length();
            if (u > breaks_.back() && u < 1) breaks_.push_back(u);
        }
        breaks_.push_back(1);
    }

    /// From time u on.
    const SceneDescription& at(double u) { return atFrame(frameOf(u)); }
    /// Until time u.
    const SceneDescription& before(double u) { return atFrame(std::nextafter(frameOf(u), -1e300)); }

    template <class PlaceOf>
    std::shared_ptr<const MovingTransform> follow(PlaceOf placeOf, Vec3d centre) {
        return MovingTransform::follow([&](double u) { return placeOf(at(u)); },
                                       [&](double u) { return placeOf(before(u)); }, breaks_,
                                       centre);
    }

    /// From `rest` to placeOf(..), turning about the origin of what is placed.
    template <class PlaceOf>
    std::shared_ptr<const MovingTransform> followFrom(const Affine3d& rest, PlaceOf placeOf) {
        const Affine3d restFromWorld = rest.inverse();
        return follow([&](const SceneDescription& scene) { return placeOf(scene) * restFromWorld; },
                      rest.translation);
    }

    template <class NumbersOf>
    auto followNumbers(NumbersOf numbersOf) {
        constexpr std::size_t count =
            std::tuple_size_v<std::invoke_result_t<NumbersOf, const SceneDescription&>>;
        return MovingNumbers<count>::follow([&](double u) { return numbersOf(at(u)); },
                                            [&](double u) { return numbersOf(before(u)); },
                                            breaks_);
    }

private:
    /// At a break, the key's own frame.
    double frameOf(double u) const {
        const camera::Shutter& shutter = description_.camera.shutter;
        const double frame = description_.frame + shutter.frames(u);
        for (const double key : keys_)
            if (std::abs(key - frame) <= 1e-12 * std::max(1.0, std::abs(key))) return key;
        return frame;
    }
    const SceneDescription& atFrame(double frame) {
        const auto found = known_.find(frame);
        if (found != known_.end()) return found->second;
        return known_.emplace(frame, scene::atFrame(description_, frame)).first->second;
    }

    const SceneDescription& description_;
    std::vector<double> keys_, breaks_;
    std::map<double, SceneDescription> known_;
};

std::string tableName(const char* list, std::size_t i) { return fmt::format("{}[{}]", list, i); }

std::vector<std::shared_ptr<const MovingTransform>> surfaceMovements(
    const SceneDescription& description, const LoadedSurface& loaded, std::size_t index,
    Shot& shot) {
    const std::string table = tableName("surface", index);
    std::vector<std::shared_ptr<const MovingTransform>> moves;
    if (!isAnimated(description, table)) return moves;
    bool any = false;
    for (std::size_t k = 0; k < loaded.instances.size(); ++k) {
        const auto placeOf = [&](const SceneDescription& scene) {
            const SurfaceDescription& surface = scene.surfaces[index];
            const Affine3d& instance =
                k < surface.instances.size() ? surface.instances[k] : loaded.instances[k];
            return surface.worldFromObject * instance;
        };
        moves.push_back(shot.followFrom(placeOf(description), placeOf));
        any |= moves.back() != nullptr;
    }
    if (!any) return {};
    return moves;
}

// The rotation and translation that take a local light from one place to another.

Affine3d poseOf(const PointDescription& point) {
    return {point.ies.empty() ? Affine3d().column : point.axes().column, point.position};
}
Affine3d poseOf(const SphereDescription& sphere) { return Affine3d::translate(sphere.position); }
Affine3d poseOf(const FlatDescription& flat) {
    const auto& [x, y, z] = flat.worldFromLight.column;
    const Vec3d nx = normalize(x), ny = normalize(y);
    return {{nx, ny, cross(nx, ny)}, flat.worldFromLight.translation};
}

template <class Light>
Vec3d positionOf(const Light& light) {
    if constexpr (std::is_base_of_v<FlatDescription, Light>)
        return light.worldFromLight.translation;
    else
        return light.position;
}

template <class Light>
Affine3d wayBetween(const Light& rest, const Light& there) {
    return poseOf(there) * poseOf(rest).inverse();
}
/// A cone looks the same however it is rolled: the smallest turn will do.
Affine3d wayBetween(const SpotDescription& rest, const SpotDescription& there) {
    const Vec3d a = normalize(rest.direction), b = normalize(there.direction);
    PolarMap turn;
    turn.rotation = {1 + dot(a, b), cross(a, b)};
    double size = std::hypot(turn.rotation.w, length(turn.rotation.v));
    if (size < 1e-9) {  // half a turn, about any axis across it
        Vec3d across, other;
        orthonormalBasis(a, across, other);
        turn.rotation = {0, across}, size = 1;
    }
    turn.rotation = {turn.rotation.w / size, turn.rotation.v * (1 / size)};
    return Affine3d::translate(there.position) * turn.map() * Affine3d::translate(-rest.position);
}

light::LightMotion lightMotion(const SceneDescription& description, std::size_t index, Shot& shot) {
    if (!isAnimated(description, tableName("light", index))) return {};
    const auto follow = [&](const auto& light) -> light::LightMotion {
        using L = std::remove_cvref_t<decltype(light)>;
        constexpr bool distant = std::is_same_v<L, SunDescription> ||
                                 std::is_same_v<L, SkyDescription> ||
                                 std::is_same_v<L, EnvironmentDescription>;
        if constexpr (distant) {
            return {};
        } else {
            const auto wayIn = [&](const SceneDescription& scene) {
                return wayBetween(light, std::get<L>(scene.lights[index].light));
            };
            return {shot.follow(wayIn, positionOf(light)),
                    shot.followNumbers([&](const SceneDescription& scene) {
                        return formOf(scene.lights[index]);
                    })};
        }
    };
    return std::visit(follow, description.lights[index].light);
}

std::shared_ptr<const camera::CameraMotion> cameraMovement(const SceneDescription& description,
                                                           Shot& shot) {
    if (!isAnimated(description, "camera") || !description.camera.pose) return nullptr;
    auto motion = std::make_shared<camera::CameraMotion>();
    motion->pose = shot.follow(
        [](const SceneDescription& scene) { return worldFromCamera(*scene.camera.pose); }, {});
    motion->lens = shot.followNumbers([](const SceneDescription& scene) {
        const CameraDescription& c = scene.camera;
        return camera::Lens{c.fovY, c.height.value_or(1), c.shift[0], c.shift[1]}.numbers();
    });
    return motion->pose || motion->lens ? motion : nullptr;
}

}  // namespace

Movements findMovements(const SceneDescription& description, const LoadedScene& loaded) {
    Movements moves;
    moves.volumes.resize(description.volumes.size());
    moves.surfaces.resize(description.surfaces.size());
    if (description.animation.empty() || !(description.camera.shutter.length() > 0)) return moves;
    Shot shot(description);
    for (std::size_t i = 0; i < description.volumes.size(); ++i) {
        if (!isAnimated(description, tableName("volume", i))) continue;
        moves.volumes[i] = shot.followFrom(
            description.volumes[i].worldFromObject,
            [&](const SceneDescription& scene) { return scene.volumes[i].worldFromObject; });
    }
    for (std::size_t i = 0; i < description.surfaces.size(); ++i)
        moves.surfaces[i] = surfaceMovements(description, loaded.surfaces[i], i, shot);
    for (std::size_t i = 0; i < description.lights.size(); ++i)
        moves.lights.push_back(lightMotion(description, i, shot));
    moves.camera = cameraMovement(description, shot);
    return moves;
}

}  // namespace woodcock::scene
