// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/render/scene.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/description.h"
#include "woodcock/scene/load.h"

namespace woodcock::tool {

/// Why a picture shows nothing, before it is drawn and after.
class PictureWarnings {
public:
    /// `loaded` is what `scene` will be built of; both as long as this.
    PictureWarnings(const scene::SceneDescription& description, const scene::LoadedScene& loaded);

    /// That the camera stands inside of something dense; empty: it does not.
    std::string ofCamera(const render::Scene& scene);
    /// Of each volume, that something moves further than the volume is wide: what that costs.
    std::vector<std::string> ofMotion(const render::Scene& scene) const;
    /// That the finished picture is black, and the likeliest reason; empty: it is not.
    std::string ofPicture(const render::Scene& scene, const render::RenderResult& result) const;

private:
    std::string whyNoLight(const render::Scene& scene, const render::RenderResult& result,
                           float alpha) const;
    std::string volumeName(std::size_t part) const;

    const scene::SceneDescription& description_;
    std::vector<std::size_t> volumesOfParts_;
    std::string camera_;  // where it stands, once it is known to be inside
};

/// "noise 1.25 %", or why it is unknown.
std::string noiseOf(const render::RenderResult& result);

}  // namespace woodcock::tool
