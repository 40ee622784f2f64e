// SPDX-License-Identifier: Apache-2.0
#include "woodcock/woodcock.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "woodcock/base/error.h"
#include "woodcock/base/printable.h"
#include "woodcock/base/toml_reader.h"
#include "woodcock/base/toml_text.h"
#include "woodcock/base/version.h"
#include "woodcock/grid/lattice.h"
#include "woodcock/grid/vdb/load_field.h"
#include "woodcock/image/outputs.h"
#include "woodcock/render/precision.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/denoising.h"
#include "woodcock/scene/light_groups.h"
#include "woodcock/scene/load.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock {

/// A volume from memory. In the scene's text it stands under the name of a file that is not there.
struct ArrayVolume {
    grid::LatticeSource source;
    Affine3d worldFromIndex;
    std::string section;  // [[volume]] of it
};

namespace {

namespace fs = std::filesystem;

std::string arrayName(std::size_t index) { return fmt::format("array-in-memory-{}", index); }

Vec3d toVec(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

/// `phase` as a line of a scene's text, if it is one table and nothing more.
std::string phaseLine(const std::string& phase) {
    const std::string line = fmt::format("phase = {}\n", phase);
    try {
        const toml::table parsed = parseToml(line, "a phase function");
        if (parsed.size() == 1 && parsed.get("phase")->is_table()) return line;
    } catch (const Error&) {
        // The message below says what it should be.
    }
    throw inputError(
        "the phase function of a volume from memory is written as in a scene file, such as "
        "{{ type = \"mie\", diameter = 20 }}; it is: {}",
        shown(phase));
}

std::string sectionOf(const LatticeVolume& volume, const std::string& name) {
    std::string text = fmt::format("\n[[volume]]\nfile = {}\nalbedo = {}\n", tomlText(name),
                                   tomlVector(toVec(volume.albedo)));
    if (volume.phase.empty() || volume.g != 0)
        text += fmt::format("g = {}\n", tomlNumber(volume.g));
    if (!volume.phase.empty()) text += phaseLine(volume.phase);
    if (volume.scale) text += fmt::format("scale = {}\n", tomlNumber(*volume.scale));
    return text;
}

ArrayVolume arrayVolume(const LatticeVolume& volume, const std::string& name) {
    auto lattice = std::make_shared<grid::LatticeValues>();
    lattice->size = {volume.size[0], volume.size[1], volume.size[2]};
    lattice->values.assign(volume.density.begin(), volume.density.end());
    ArrayVolume array{grid::latticeSource(std::move(lattice)), {}, sectionOf(volume, name)};
    const double s = volume.voxelSize;
    array.worldFromIndex = {{Vec3d{s, 0, 0}, {0, s, 0}, {0, 0, s}}, toVec(volume.origin)};
    if (const std::string flaw = flawOf(array.worldFromIndex); !flaw.empty() || !(s > 0))
        throw inputError(
            "a volume with voxels of {} at [{}, {}, {}] cannot be placed: its size must "
            "be above 0, and all finite",
            s, volume.origin[0], volume.origin[1], volume.origin[2]);
    grid::GridStatistics statistics;
    statistics.voxels = array.source.voxels;
    if (const std::string faults = grid::describeFaults(statistics, true); !faults.empty())
        throw inputError("the values of a density must be finite and 0 or more; these hold {}",
                         faults);
    return array;
}

bool isVolumeFile(const fs::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension == ".vdb" || extension == ".nvdb";
}

/// The index of the array that the volume stands for; absent where it is a file.
std::optional<std::size_t> arrayOf(const scene::VolumeDescription& volume, std::size_t arrays) {
    for (std::size_t i = 0; i < arrays; ++i)
        if (volume.file.filename() == arrayName(i)) return i;
    return std::nullopt;
}

void requireDensityAlone(const scene::VolumeDescription& volume) {
    const auto* c = std::get_if<scene::DensityCoefficients>(&volume.coefficients);
    if (!c || !c->albedoGrid.empty() || volume.emission || volume.blackbody)
        throw usageError(
            "a volume from memory holds its density alone: it takes scale, albedo, g and phase, "
            "but no sigma_a, sigma_s, albedo_grid, emission or blackbody");
}

scene::LoadedField loadArray(const ArrayVolume& array, const scene::VolumeDescription& volume,
                             const scene::RenderDescription& render) {
    requireDensityAlone(volume);
    grid::Storage storage = volume.storage == grid::Storage::Auto ? render.storage : volume.storage;
    if (storage == grid::Storage::Auto)
        storage = array.source.voxels.exactAsHalf ? grid::Storage::Half : grid::Storage::Float;
    grid::Field field = grid::buildField(array.source.field, storage);
    field.setLookup(render.lookup);
    return {std::make_shared<grid::Field>(std::move(field)), array.worldFromIndex, "density"};
}

/// What the scene names, and the arrays.
scene::LoadedScene load(const scene::SceneDescription& scene,
                        const std::vector<ArrayVolume>& arrays) {
    scene::SceneDescription ofFiles = scene;
    for (scene::VolumeDescription& volume : ofFiles.volumes)
        if (arrayOf(volume, arrays.size())) volume.coefficients = scene::HomogeneousBox{};
    scene::LoadedScene loaded = scene::loadScene(ofFiles);
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        if (const auto array = arrayOf(scene.volumes[i], arrays.size()))
            loaded.volumes[i].density = loadArray(arrays[*array], scene.volumes[i], scene.render);
    return loaded;
}

render::RenderSettings settingsOf(const scene::SceneDescription& scene, const RenderCalls& calls) {
    render::RenderSettings settings = scene::renderSettings(scene.render);
    settings.layers = scene::layerNeeds(scene);
    settings.threads = calls.threads;
    return settings;
}

/// Goes on as long as nobody stops it.
bool tell(const RenderCalls& calls, const render::RenderProgress& now) {
    if (calls.progress)
        calls.progress({now.fraction, now.seconds, now.secondsLeft, now.samples, now.noise});
    return !calls.stop || !calls.stop();
}

render::RenderResult draw(const render::Scene& scene, const render::RenderSettings& settings,
                          const RenderCalls& calls) {
    return render::render(scene, settings,
                          [&](const render::RenderProgress& now) { return tell(calls, now); });
}

std::vector<float> pixelsOf(const image::Film& film, const image::DenoisedPicture* denoised) {
    std::vector<float> pixels;
    pixels.reserve(std::size_t(film.width()) * std::size_t(film.height()) * 4);
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            const Rgb radiance = denoised ? denoised->radiance(x, y) : film.radiance(x, y);
            pixels.insert(pixels.end(), radiance.c.begin(), radiance.c.end());
            pixels.push_back(film.alpha(x, y));
        }
    return pixels;
}

}  // namespace

struct RenderedImage::Impl {
    scene::SceneDescription scene;  // complete
    render::RenderSettings settings;
    render::RenderResult result;
    std::optional<image::DenoisedPicture> denoised;
    std::vector<float> pixels;
    std::vector<std::string> notes;
};

RenderedImage::RenderedImage(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

int RenderedImage::width() const { return impl_->result.film.width(); }
int RenderedImage::height() const { return impl_->result.film.height(); }
std::span<const float> RenderedImage::pixels() const { return impl_->pixels; }
int RenderedImage::samples() const { return impl_->result.endSample; }
bool RenderedImage::complete() const {
    return impl_->result.reason == render::StopReason::Complete;
}
double RenderedImage::seconds() const { return impl_->result.seconds; }
double RenderedImage::noise() const { return impl_->result.film.noise(); }
const std::vector<std::string>& RenderedImage::notes() const { return impl_->notes; }

void RenderedImage::write(const fs::path& file) const {
    const scene::SceneDescription& scene = impl_->scene;
    const scene::OutputDescription& output = scene.output;
    image::ColorConfig colour(scene.ocio);
    image::OutputSettings settings{
        .files = {file},
        .half = output.half,
        .layers = scene::outputLayers(scene),
        .multipart = output.multipart,
        .denoised = impl_->denoised.has_value(),
        .display = {output.display, output.view, output.look, output.exposure},
        .colour = std::move(colour),
        .withAlpha = scene::environmentIsHidden(scene),
        .glows = scene::anythingGlows(scene)};
    const render::RenderResult& result = impl_->result;
    image::RenderMetadata metadata{impl_->settings.firstSample, result.endSample,
                                   impl_->settings.seed,        result.seconds,
                                   scene::sceneDigest(scene),   "",
                                   impl_->settings.adaptive};
    scene::describeShot(scene, metadata);
    image::Outputs(std::move(settings))
        .write(result.film, metadata, {.denoised = impl_->denoised ? &*impl_->denoised : nullptr});
}

struct Renderer::Impl {
    std::string text, name;  // of the scene file; what stands for it in messages
    fs::path folder;
    bool made = false;  // around volumes: its text is nobody's
    std::vector<std::string> overrides;
    std::vector<ArrayVolume> arrays;
    std::optional<scene::LookAt> camera;
    scene::SceneDescription scene;

    void parse();
    bool isEmpty() const { return text.empty() && arrays.empty(); }

    /// A change that is taken back where the scene is wrong with it.
    template <class T>
    void add(std::vector<T>& list, T value) {
        list.push_back(std::move(value));
        try {
            parse();
        } catch (...) {
            list.pop_back();
            throw;
        }
    }
};

void Renderer::Impl::parse() {
    std::string all = isEmpty() ? "[[volume]]\nfile = \"none\"\n" : text;
    for (const ArrayVolume& array : arrays) all += array.section;
    scene::SceneDescription parsed = scene::parseSceneText(all, name, folder, overrides);
    if (isEmpty()) parsed.volumes.clear();
    if (made)
        std::erase_if(parsed.places,
                      [&](const auto& place) { return place.second.starts_with(name); });
    if (camera) {
        parsed.camera.pose = *camera;
        parsed.camera.given = {};
        parsed.camera.orbit = {};
    }
    scene = std::move(parsed);
}

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {
    impl_->name = "the scene in memory";
    impl_->made = true;
    impl_->parse();
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Renderer Renderer::open(const fs::path& file) {
    Renderer renderer;
    Impl& impl = *renderer.impl_;
    impl.made = isVolumeFile(file);
    impl.text = impl.made ? scene::defaultSceneText({file}) : readTomlFile(file, "scene file");
    impl.name = file.string();
    if (!impl.made) impl.folder = file.parent_path();
    impl.parse();
    return renderer;
}

Renderer Renderer::fromText(std::string_view toml, const fs::path& folder) {
    Renderer renderer;
    Impl& impl = *renderer.impl_;
    impl.made = false;
    impl.text = toml;
    impl.folder = folder;
    impl.parse();
    return renderer;
}

void Renderer::set(std::string_view key, std::string_view value) {
    impl_->add(impl_->overrides, fmt::format("{}={}", key, value));
}
void Renderer::setResolution(int width, int height) {
    set("render.resolution", fmt::format("[{}, {}]", width, height));
}
void Renderer::setSamples(int perPixel) { set("render.spp", fmt::format("{}", perPixel)); }
void Renderer::setSeed(std::uint64_t seed) { set("render.seed", fmt::format("{}", seed)); }

void Renderer::placeCamera(std::array<double, 3> eye, std::array<double, 3> target,
                           std::array<double, 3> up) {
    const scene::LookAt pose{toVec(eye), toVec(target), toVec(up)};
    if (!flawOf(scene::worldFromCamera(pose)).empty())
        throw usageError(
            "a camera at [{}, {}, {}] cannot look at [{}, {}, {}] with [{}, {}, {}] "
            "upwards: these must be finite, apart, and up must lead across the view",
            eye[0], eye[1], eye[2], target[0], target[1], target[2], up[0], up[1], up[2]);
    impl_->camera = pose;
    impl_->parse();
}

int Renderer::width() const { return impl_->scene.render.width; }
int Renderer::height() const { return impl_->scene.render.height; }
int Renderer::samples() const { return impl_->scene.render.spp; }
std::uint64_t Renderer::seed() const { return impl_->scene.render.seed; }

int Renderer::addVolume(const LatticeVolume& volume) {
    impl_->add(impl_->arrays, arrayVolume(volume, arrayName(impl_->arrays.size())));
    return static_cast<int>(impl_->scene.volumes.size()) - 1;
}

RenderedImage Renderer::render(const RenderCalls& calls) const {
    if (impl_->isEmpty()) throw usageError("the scene is empty: add a volume before you render it");
    scene::SceneDescription description = impl_->scene;
    std::vector<std::string> notes;
    const auto denoiser = scene::settleDenoising(description, &notes);
    const render::RenderSettings settings = settingsOf(description, calls);
    scene::LoadedScene loaded = load(description, impl_->arrays);
    const auto note = [&](std::vector<std::string> more) {
        notes.insert(notes.end(), more.begin(), more.end());
    };
    note(loaded.notes);
    note(scene::completeScene(description, loaded));
    scene::loadChosen(description, loaded);
    const render::Scene scene = scene::buildScene(description, std::move(loaded), &notes);
    note(render::precisionWarnings(scene));
    render::RenderResult result = draw(scene, settings, calls);
    std::optional<image::DenoisedPicture> denoised;
    if (denoiser) denoised = denoiser->denoise(result.film, calls.threads);
    std::vector<float> pixels = pixelsOf(result.film, denoised ? &*denoised : nullptr);
    return RenderedImage(std::make_shared<const RenderedImage::Impl>(
        RenderedImage::Impl{std::move(description), settings, std::move(result),
                            std::move(denoised), std::move(pixels), std::move(notes)}));
}

std::string Renderer::libraryVersion() { return std::string(version()); }

}  // namespace woodcock
