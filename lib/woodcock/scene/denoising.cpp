// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/denoising.h"

#include "woodcock/scene/keys/sections.h"

namespace woodcock::scene {

namespace {

/// A library that is there and does not work is told of, and then counts as absent.
std::optional<denoise::Denoiser> denoiserIfInstalled(std::vector<std::string>* notes) {
    try {
        std::optional<denoise::Denoiser> denoiser = denoise::Denoiser::find();
        if (denoiser && notes)
            notes->push_back(
                fmt::format("pictures are denoised, as {} is installed ({}); render.denoise = "
                            "false leaves them as they are",
                            denoiser->name(), denoiser->file().string()));
        return denoiser;
    } catch (const Error& e) {
        if (notes) notes->push_back(fmt::format("pictures are not denoised: {}", e.what()));
        return std::nullopt;
    }
}

}  // namespace

std::optional<denoise::Denoiser> settleDenoising(SceneDescription& scene,
                                                 std::vector<std::string>* notes) {
    RenderDescription& render = scene.render;
    std::optional<denoise::Denoiser> denoiser;
    if (render.denoise == Denoise::Always)
        denoiser = inPlace(findPlace(scene.places, "render." + keyName(render, render.denoise)),
                           [] { return denoise::Denoiser::load(); });
    if (render.denoise == Denoise::IfInstalled) denoiser = denoiserIfInstalled(notes);
    render.denoise = denoiser ? Denoise::Always : Denoise::Never;
    return denoiser;
}

}  // namespace woodcock::scene
