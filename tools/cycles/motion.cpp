// SPDX-License-Identifier: Apache-2.0
#include "tools/cycles/motion.h"

#include <nlohmann/json.hpp>

#include "tools/cycles/json.h"

namespace woodcock::tool {

std::string cyclesShutterPosition(const camera::Shutter& shutter) {
    if (shutter.open == -shutter.close) return "CENTER";
    if (shutter.open == 0) return "START";
    return shutter.close == 0 ? "END" : "";
}

std::vector<double> cyclesTimes(const camera::Shutter& shutter) {
    std::vector<double> times;
    for (int i = 0; i <= cyclesMotionPieces; ++i)
        times.push_back(shutter.frames(double(i) / cyclesMotionPieces));
    return times;
}

std::string placeOfKeys(const scene::SceneDescription& scene, const std::string& table) {
    for (const scene::AnimatedValue& value : scene.animation)
        if (value.table == table)
            if (std::string place = scene::findPlace(scene.places, table + "." + value.key);
                !place.empty())
                return place;
    return "";
}

nlohmann::json cyclesMotion(const scene::Movements::Movement& movement, const Affine3d& rest,
                            const scene::SceneDescription& scene, const std::string& table) {
    if (!movement) return nullptr;
    if (movement->jumps())
        throw cyclesRefusal(placeOfKeys(scene, table), "that '{}' jumps while the shutter is open",
                            table);
    nlohmann::json places = nlohmann::json::array();
    for (int i = 0; i <= cyclesMotionPieces; ++i)
        places.push_back(toJson(movement->at(double(i) / cyclesMotionPieces) * rest));
    return places;
}

}  // namespace woodcock::tool
