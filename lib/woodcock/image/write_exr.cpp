// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/write_exr.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/base/version.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/openimageio_input.h"

namespace woodcock::image {

namespace {

constexpr float largestHalf = 65504.0f;

constexpr std::array<std::pair<const char*, bool ExrLayers::*>, 7> knownLayers{
    {{"depth", &ExrLayers::depth},
     {"albedo", &ExrLayers::albedo},
     {"normal", &ExrLayers::normal},
     {"transmittance", &ExrLayers::transmittance},
     {"samples", &ExrLayers::samples},
     {"error", &ExrLayers::error},
     {"variance", &ExrLayers::variance}}};

/// A few neighbouring channels of one type and how a pixel fills them.
struct ChannelGroup {
    std::vector<std::string> names;
    PixelType type;
    std::function<void(int x, int y, float* to)> fill;
};

void copy(Rgb from, float* to) { std::copy(from.c.begin(), from.c.end(), to); }

std::vector<ChannelGroup> channelGroups(const Film& film, const ExrSettings& settings) {
    const bool half = settings.half;
    std::vector<ChannelGroup> groups;
    groups.push_back({{"R", "G", "B", "A"},
                      half ? PixelType::Half : PixelType::Float,
                      [&film, half](int x, int y, float* to) {
                          copy(film.radiance(x, y), to);
                          to[3] = film.alpha(x, y);
                          // Beyond its range a half is infinite, which no later program can repair.
                          if (half)
                              for (int i = 0; i < 4; ++i)
                                  to[i] = std::clamp(to[i], -largestHalf, largestHalf);
                      }});
    const ExrLayers& layers = settings.layers;
    if (layers.depth)
        groups.push_back({{"Z"}, PixelType::Float, [&film](int x, int y, float* to) {
                              *to = film.depth(x, y);
                          }});
    if (layers.albedo)
        groups.push_back({{"albedo.R", "albedo.G", "albedo.B"},
                          PixelType::Float,
                          [&film](int x, int y, float* to) { copy(film.albedo(x, y), to); }});
    if (layers.normal)
        groups.push_back({{"normal.X", "normal.Y", "normal.Z"},
                          PixelType::Float,
                          [&film](int x, int y, float* to) {
                              const Vec3f n = film.normal(x, y);
                              to[0] = n.x, to[1] = n.y, to[2] = n.z;
                          }});
    if (layers.transmittance)
        groups.push_back(
            {{"transmittance.R", "transmittance.G", "transmittance.B"},
             PixelType::Float,
             [&film](int x, int y, float* to) { copy(film.transmittance(x, y), to); }});
    if (layers.samples)
        groups.push_back({{"samples"}, PixelType::Float, [&film](int x, int y, float* to) {
                              *to = static_cast<float>(film.at(x, y).samples);
                          }});
    if (layers.error)
        groups.push_back(
            {{"error.R", "error.G", "error.B"}, PixelType::Float, [&film](int x, int y, float* to) {
                 copy(film.standardError(x, y), to);
             }});
    if (layers.variance)
        groups.push_back({{"variance.R", "variance.G", "variance.B"},
                          PixelType::Float,
                          [&film](int x, int y, float* to) { copy(film.variance(x, y), to); }});
    return groups;
}

/// In float, whatever the colour is in: ids are bits.
void addMattes(const MatteFilm& mattes, const Film& film, std::vector<ChannelGroup>& groups) {
    for (std::size_t layer = 0; layer < mattes.layers().size(); ++layer)
        groups.push_back(
            {matteChannels(mattes.layers()[layer]), PixelType::Float,
             [&mattes, &film, layer](int x, int y, float* to) {
                 mattes.ranks(layer, x, y, film.at(x, y).samples, {to, 2 * matteRanks});
             }});
}

ImageHeader header(const Film& film, const RenderMetadata& metadata, const ExrSettings& settings,
                   const std::vector<ChannelGroup>& groups) {
    ImageHeader h{"openexr", film.crop(), film.width(), film.height(), {}, {}};
    for (const ChannelGroup& group : groups)
        for (const std::string& name : group.names) h.channels.push_back({name, group.type});

    const auto set = [&](const char* name, ImageAttribute value) {
        h.attributes.emplace_back(name, std::move(value));
    };
    set("compression", "zip");
    set("Software", fmt::format("woodcock {}", version()));
    if (settings.chromaticities)
        set("chromaticities",
            std::vector<float>(settings.chromaticities->begin(), settings.chromaticities->end()));
    set("woodcock/version", std::string(version()));
    set("woodcock/samples", metadata.endSample - metadata.firstSample);
    set("woodcock/sampleRange", fmt::format("{}:{}", metadata.firstSample, metadata.endSample));
    // After an interrupted pass, and in an adaptive render, pixels have different numbers of
    // samples: such a file cannot be merged by its range only.
    if (const auto most = static_cast<int>(film.mostSamples());
        most > metadata.endSample - metadata.firstSample)
        set("woodcock/samplesAtMost", most);
    if (metadata.adaptive) set("woodcock/adaptive", 1);
    set("woodcock/samplesMean", static_cast<float>(film.meanSamples()));
    if (const double noise = film.noise(); std::isfinite(noise))
        set("woodcock/noise", static_cast<float>(noise));
    // EXR has no integer of 64 bits.
    set("woodcock/seed", fmt::format("{}", metadata.seed));
    set("woodcock/nonFinite", fmt::format("{}", film.nonFiniteCount()));
    set("woodcock/sceneDigest", metadata.sceneDigest);
    set("woodcock/renderSeconds", static_cast<float>(metadata.renderSeconds));
    if (!metadata.commandLine.empty()) set("woodcock/commandLine", metadata.commandLine);
    return h;
}

}  // namespace

std::vector<std::string> layerNames() {
    std::vector<std::string> names;
    for (const auto& [name, layer] : knownLayers) names.emplace_back(name);
    return names;
}

ExrLayers layersFromNames(const std::vector<std::string>& names) {
    ExrLayers layers;
    for (const std::string& name : names) {
        const auto known = std::find_if(knownLayers.begin(), knownLayers.end(),
                                        [&](const auto& layer) { return layer.first == name; });
        if (known == knownLayers.end())
            throw usageError("unknown layer '{}'{}", name,
                             suggestName(name, "known layers", layerNames()));
        layers.*known->second = true;
    }
    return layers;
}

double exrBytesPerPixel(const ExrSettings& settings) {
    const ExrLayers& l = settings.layers;
    const int floats =
        l.depth + l.samples + 3 * (l.albedo + l.normal + l.transmittance + l.error + l.variance);
    constexpr int ofFloat = sizeof(float);
    return ofFloat * (4 + floats) + (settings.half ? 2 : ofFloat) * 4 + ofFloat * floats;
}

void writeExr(const std::filesystem::path& file, const Film& film, const RenderMetadata& metadata,
              const ExrSettings& settings, const FilmState* state, const MatteFilm* mattes) {
    std::vector<ChannelGroup> groups = channelGroups(film, settings);
    if (mattes) addMattes(*mattes, film, groups);
    ImageHeader h = header(film, metadata, settings, groups);
    if (mattes)
        for (const MatteLayer& layer : mattes->layers())
            for (auto& [name, text] : matteAttributes(layer)) h.attributes.emplace_back(name, text);
    const Film::Window crop = film.crop();
    std::vector<float> pixels(static_cast<std::size_t>(crop.width()) *
                              static_cast<std::size_t>(crop.height()) * h.channels.size());
    float* to = pixels.data();
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x)
            for (const ChannelGroup& group : groups) {
                group.fill(x, y, to);
                to += group.names.size();
            }
    const std::vector<unsigned char> bytes = encodeImage(h, pixels);
    state ? writeWithState(file, bytes, *state) : writeWholeFile(file, bytes);
}

void annotateExr(const std::filesystem::path& from, const std::filesystem::path& to,
                 const std::vector<std::pair<std::string, ImageAttribute>>& attributes) {
    OpenImage input(from);
    const OIIO::ImageSpec& spec = input.spec();
    std::vector<float> pixels(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
    input.read(pixels.data());

    ImageHeader header{"openexr",
                       {spec.x, spec.y, spec.x + spec.width, spec.y + spec.height},
                       spec.full_width,
                       spec.full_height,
                       {},
                       {{"compression", "zip"}}};
    for (const std::string& name : spec.channelnames) header.channels.push_back({name});
    header.attributes.insert(header.attributes.end(), attributes.begin(), attributes.end());
    writeWholeFile(to, encodeImage(header, pixels));
}

}  // namespace woodcock::image
