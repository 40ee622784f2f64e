// SPDX-License-Identifier: Apache-2.0
#include "woodcock/denoise/denoiser.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <system_error>
#include <vector>

#include "woodcock/base/error.h"
#include "woodcock/denoise/library.h"
#include "woodcock/denoise/library_search.h"

namespace woodcock::denoise {

namespace fs = std::filesystem;

namespace {

/// Three numbers for each pixel, as Open Image Denoise takes them.
using Image = std::vector<float>;

template <class Value>
Image imageOf(const image::Film& film, Value (image::Film::*value)(int, int) const, float lower,
              float upper) {
    const image::Film::Window crop = film.crop();
    Image pixels;
    pixels.reserve(3 * film.pixelCount());
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            const Value v = (film.*value)(x, y);
            for (int c = 0; c < 3; ++c) pixels.push_back(std::clamp(v[c], lower, upper));
        }
    return pixels;
}

/// Open Image Denoise works in tiles where it would take more. It takes 1.5 GB for a picture of
/// 1920 x 1080 pixels that is one tile.
constexpr int mostMegabytes = 1024;

struct NamedImage {
    const char* name;
    Image& pixels;
};

/// Runs one filter of the kind "RT". `output` may be one of the images.
void filter(const Functions& functions, const Device& device, const image::Film::Window& crop,
            const std::vector<NamedImage>& images, Image& output,
            const std::vector<const char*>& flags) {
    const FilterHandle filter = functions.newFilter(device.get(), "RT");
    device.check();
    const auto set = [&](const char* name, Image& pixels) {
        functions.setFilterImage(filter, name, pixels.data(), threeFloats,
                                 static_cast<std::size_t>(crop.width()),
                                 static_cast<std::size_t>(crop.height()), 0, 0, 0);
    };
    for (const NamedImage& image : images) set(image.name, image.pixels);
    set("output", output);
    for (const char* flag : flags) functions.setFilterBool(filter, flag, true);
    functions.setFilterInt(filter, "maxMemoryMB", mostMegabytes);
    functions.commitFilter(filter);
    functions.executeFilter(filter);
    functions.releaseFilter(filter);
    device.check();
}

std::string howToInstall() {
    return fmt::format("'pip install pyoidn' brings it; or let {} name {}, or its folder",
                       libraryVariable, libraryName);
}

Error notInstalled() {
    std::string below;
    for (const fs::path& prefix : prefixes())
        below += (below.empty() ? "" : ", ") + prefix.string();
    return usageError(
        "Open Image Denoise is not installed: {}. It was looked for where the loader looks "
        "($LD_LIBRARY_PATH, the system's folders), and in lib and the packages of Python below {}",
        howToInstall(), below);
}

/// What $WOODCOCK_OIDN names, which is `named`.
fs::path chosenFile(const fs::path& named) {
    std::error_code ignored;
    if (!fs::exists(named, ignored))
        throw usageError("{} names '{}', which is not there", libraryVariable, named.string());
    if (!fs::is_directory(named, ignored)) return fs::absolute(named);
    const fs::path file = libraryIn(fs::absolute(named));
    if (file.empty())
        throw usageError("{} names the folder '{}', which holds no {}", libraryVariable,
                         named.string(), libraryName);
    return file;
}

}  // namespace

std::string searchText() {
    return fmt::format(
        "It is looked for where {} says (a library, or its folder), else where the loader looks, "
        "else in pyoidn of the Python environments that are active, on $PATH, or usual",
        libraryVariable);
}

struct Denoiser::Library {
    Functions functions;
    std::string name;
};

Denoiser::Denoiser(std::shared_ptr<const Library> library) : library_(std::move(library)) {}

std::optional<Denoiser> Denoiser::search(bool needed) {
    const fs::path named = namedLibrary();
    std::vector<fs::path> files{libraryName};
    if (named.empty()) {
        const std::vector<fs::path> installed = installedLibraries();
        files.insert(files.end(), installed.begin(), installed.end());
    } else {
        std::error_code ignored;
        if (!needed && !fs::exists(named, ignored)) return std::nullopt;
        files = {chosenFile(named)};
    }
    std::string flaws;
    for (const fs::path& file : files) {
        bool missing = false;
        try {
            Functions functions = loadFunctions(file, missing);
            std::string name = fmt::format("Open Image Denoise {}", functions.version);
            return Denoiser(
                std::make_shared<const Library>(Library{std::move(functions), std::move(name)}));
        } catch (const Error& e) {
            if (!missing) flaws += (flaws.empty() ? "" : "; ") + std::string(e.what());
        }
    }
    if (!flaws.empty()) throw usageError("{}", flaws);
    if (needed) throw notInstalled();
    return std::nullopt;
}

Denoiser Denoiser::load() { return *search(true); }
std::optional<Denoiser> Denoiser::find() { return search(false); }

const std::string& Denoiser::name() const { return library_->name; }
const fs::path& Denoiser::file() const { return library_->functions.file; }

image::DenoisedPicture Denoiser::denoise(const image::Film& film, int threads) const {
    const auto start = std::chrono::steady_clock::now();
    constexpr float most = std::numeric_limits<float>::max();
    const image::Film::Window crop = film.crop();
    // Light of a colour that the primaries do not hold is below 0 in a channel; it becomes 0.
    Image colour = imageOf(film, &image::Film::radiance, 0, most);
    Image albedo = imageOf(film, &image::Film::albedo, 0, 1);
    Image normal = imageOf(film, &image::Film::normal, -1, 1);

    const Functions& f = library_->functions;
    const Device device(f, threads);
    filter(f, device, crop, {{"albedo", albedo}}, albedo, {});
    filter(f, device, crop, {{"normal", normal}}, normal, {});
    filter(f, device, crop, {{"color", colour}, {"albedo", albedo}, {"normal", normal}}, colour,
           {"hdr", "cleanAux"});
    if (!std::all_of(colour.begin(), colour.end(), [](float v) { return std::isfinite(v); }))
        throw failure("Open Image Denoise fails: its picture holds numbers that are not finite");
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    return {crop, std::move(colour), name(), "HDR, with filtered albedo and normal",
            seconds.count()};
}

double bytesToDenoise(double pixels) {
    constexpr double held = 3 * 3 * sizeof(float), used = 750, weights = 64 << 20;
    constexpr double most = 1.2 * mostMegabytes * (1 << 20);
    return held * pixels + std::min(used * pixels, most) + weights;
}

}  // namespace woodcock::denoise
