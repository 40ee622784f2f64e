// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/render/options.h"
#include "woodcock/denoise/denoiser.h"
#include "woodcock/image/outputs.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/description.h"

namespace woodcock::tool {

// What is made of options and a scene's description before anything is rendered.

/// "-" stands for stdout.
bool isStdout(const std::filesystem::path& file);

/// The scene with what options change in it. `frame`: that of a scene file whose name holds its
/// number.
scene::SceneDescription describeScene(const RenderOptions& options, std::optional<int> frame = {});

/// Nothing that is read may be written over, and nothing that is written may be written twice.
/// `scene` is that of a frame, or of no sequence. Throws Error{Usage}.
void checkFiles(const scene::SceneDescription& scene, const RenderOptions& options);

/// Makes folders where that is asked for, and checks what is to be written. Throws Error{Usage} or
/// Error{Input} with the place in the scene.
image::Outputs prepareOutputs(const scene::SceneDescription& scene, const RenderOptions& options);

/// Where `file`, a member of scene.output, was named.
std::string placeOfLayerFile(const scene::SceneDescription& scene,
                             const std::filesystem::path& file);

/// The layers of Cryptomatte that a scene asks for.
std::vector<image::MatteLayer> mattesOf(const scene::SceneDescription& scene,
                                        std::vector<std::string>* notes = nullptr);

/// Refuses mattes and deep pixels that could not be right, or would go nowhere.
void checkCompositing(const scene::SceneDescription& scene, const RenderOptions& options);

/// The denoiser of a scene's pictures, as of scene::settleDenoising(). Parts of pictures have none.
std::optional<denoise::Denoiser> denoiserOf(scene::SceneDescription& scene,
                                            const RenderOptions& options,
                                            std::vector<std::string>* notes = nullptr);

/// Throws where the image's sums would not fit into memory.
render::RenderSettings renderSettings(const scene::SceneDescription& scene,
                                      const RenderOptions& options);

/// The pixels that the picture has, of which a tile is a part.
image::Film::Window pictureOf(const scene::RenderDescription& render, const RenderOptions& options);

/// Memory that the film holds for each pixel.
double filmBytesPerPixel(const render::RenderSettings& settings,
                         const scene::SceneDescription& scene);

/// Memory for each pixel that denoising and writing take beside that.
double writingBytesPerPixel(const render::RenderSettings& settings,
                            const scene::SceneDescription& scene, const image::Outputs& outputs);

/// Throws where the sums do not fit into what is left of memory once the scene stands. `copies`:
/// checkpoints are written of copies. `beside`: bytes that rendering takes beside the picture.
void checkMemoryLeft(const render::RenderSettings& settings, const scene::SceneDescription& scene,
                     const image::Outputs& outputs, bool copies, double beside);

}  // namespace woodcock::tool
