// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/next_frame.h"

#include <algorithm>

#include "woodcock/grid/motion.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/light_groups.h"
#include "woodcock/scene/movements.h"

namespace woodcock::scene {
namespace {

using Way = render::NextFrame::Way;

/// Where the keys of a thing lead by the end of the shutter; null: they lead nowhere.
Way wayOf(const Movements::Movement& movement) {
    if (!movement) return {};
    return [end = movement->at(1)](Vec3d point) { return end.point(point); };
}

/// The same for a part of a medium, which its velocities move first.
Way wayOf(const medium::MediumPart::Description& part) {
    const Way byKeys = wayOf(part.movement);
    if (!part.motion) return byKeys;
    // Of a moment, so that it is the velocity at the point: of a whole frame, the source is that
    // of what comes here, and not where what is here goes.
    constexpr float moment = 1.0f / 64;
    return [byKeys, motion = part.motion, worldFromIndex = part.worldFromIndex,
            indexFromWorld = part.worldFromIndex.inverse()](Vec3d point) {
        const Vec3d index = indexFromWorld.point(point);
        const Vec3d along = (index - motion->source(index, moment)) * (1 / double{moment});
        const Vec3d moved = worldFromIndex.point(index + along);
        return byKeys ? byKeys(moved) : moved;
    };
}

std::vector<Way> waysOf(const medium::Medium& medium) {
    std::vector<Way> ways;
    for (const medium::MediumPart& part : medium.parts) ways.push_back(wayOf(part.description()));
    return ways;
}

/// What moves from this frame to the next.
Movements movementsOf(const SceneDescription& ahead, const LoadedScene& loaded) {
    try {
        return findMovements(ahead, loaded);
    } catch (const Error& e) {
        throw Error(e.kind(), fmt::format("for the layer 'motion', things are followed to the next "
                                          "frame: {}",
                                          e.what()));
    }
}

}  // namespace

bool asksForMotion(const SceneDescription& scene) {
    const image::LayerList layers = outputLayers(scene);
    return std::any_of(layers.begin(), layers.end(), [](const image::ChosenLayer& chosen) {
        return chosen.layer.name == "motion";
    });
}

std::shared_ptr<const render::NextFrame> buildNextFrame(const SceneDescription& description,
                                                        const LoadedScene& loaded) {
    SceneDescription ahead = description;
    ahead.camera.shutter = {0, 1};
    const Movements movements = movementsOf(ahead, loaded);
    auto next = std::make_shared<render::NextFrame>();
    next->now = next->then = buildCamera(description.camera);
    next->then.motion = movements.camera;
    next->then = next->then.at(1);
    const BuiltSurfaces surfaces = buildSurfaces(ahead, loaded, movements);
    next->media.push_back(waysOf(buildMedium(ahead, loaded, movements, "")));
    for (const medium::Medium& medium : surfaces.interiorMedia)
        next->media.push_back(waysOf(medium));
    for (std::size_t i = 0; i < loaded.surfaces.size(); ++i)
        for (std::size_t k = 0; k < loaded.surfaces[i].instances.size(); ++k)
            next->instances.push_back(
                movements.surfaces[i].empty() ? Way() : wayOf(movements.surfaces[i][k]));
    return next;
}

}  // namespace woodcock::scene
