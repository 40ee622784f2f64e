// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/write_exr.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

#include "woodcock/base/error.h"
#include "woodcock/base/version.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/exr_parts.h"
#include "woodcock/image/openimageio_input.h"

namespace woodcock::image {

namespace {

constexpr float largestHalf = 65504.0f;

/// Channels of one type in one part, and how a pixel fills them.
struct ChannelGroup {
    std::string part;
    std::vector<std::string> names;
    bool half;
    std::function<void(const Film&, int x, int y, float* to)> fill;
};

void putColour(const Rgb& from, float* to) { std::copy(from.c.begin(), from.c.end(), to); }

/// The film's own R, G and B, beside the denoised ones.
ChannelGroup noisyGroup(const ExrSettings& settings) {
    ChannelGroup group{
        settings.multipart ? noisyLayer : "",
        {"R", "G", "B"},
        settings.half,
        [](const Film& film, int x, int y, float* to) { putColour(film.radiance(x, y), to); }};
    if (!settings.multipart)
        for (std::string& name : group.names) name = fmt::format("{}.{}", noisyLayer, name);
    return group;
}

std::vector<ChannelGroup> channelGroups(const ExrSettings& settings,
                                        const DenoisedPicture* denoised) {
    std::vector<ChannelGroup> groups;
    groups.push_back({settings.multipart ? "rgba" : "",
                      {"R", "G", "B", "A"},
                      settings.half,
                      [denoised](const Film& film, int x, int y, float* to) {
                          putColour(denoised ? denoised->radiance(x, y) : film.radiance(x, y), to);
                          to[3] = film.alpha(x, y);
                      }});
    if (settings.denoised) groups.push_back(noisyGroup(settings));
    for (const auto& [layer, half] : settings.layers) {
        ChannelGroup group{"", layer.channels, half, layer.fill};
        if (settings.multipart) {
            group.part = layer.name;
            for (std::string& name : group.names) name = layer.nameInPart(name);
        }
        groups.push_back(std::move(group));
    }
    return groups;
}

/// In float, whatever the colour is in: ids are bits.
void addMattes(const MatteFilm& mattes, bool multipart, std::vector<ChannelGroup>& groups) {
    for (std::size_t layer = 0; layer < mattes.layers().size(); ++layer)
        groups.push_back(
            {multipart ? mattes.layers()[layer].name : "", matteChannels(mattes.layers()[layer]),
             false, [&mattes, layer](const Film& film, int x, int y, float* to) {
                 mattes.ranks(layer, x, y, film.at(x, y).samples, {to, 2 * matteRanks});
             }});
}

ImageHeader headerOfAnyPart(const Film& film, const ExrSettings& settings) {
    ImageHeader h{"openexr", film.crop(), film.width(), film.height(), {}, {}};
    h.attributes.emplace_back("compression", "zip");
    // All parts must agree in it.
    if (settings.chromaticities)
        h.attributes.emplace_back(
            "chromaticities",
            std::vector<float>(settings.chromaticities->begin(), settings.chromaticities->end()));
    return h;
}

/// The standard attributes that are known.
void describeShot(ImageHeader& h, const RenderMetadata& metadata, const ExrSettings& settings) {
    const auto set = [&](const char* name, ImageAttribute value) {
        h.attributes.emplace_back(name, std::move(value));
    };
    if (!settings.interopId.empty()) set("colorInteropID", settings.interopId);
    if (metadata.worldToCamera) set("worldToCamera", *metadata.worldToCamera);
    if (metadata.worldToNdc) set("worldToNDC", *metadata.worldToNdc);
    if (!metadata.framesPerSecond) return;
    const Rational rate = *metadata.framesPerSecond;
    set("framesPerSecond", rate);
    if (metadata.shutter > 0) {
        const double seconds = metadata.shutter * rate.denominator / rate.numerator;
        set("expTime", static_cast<float>(seconds));
        set("shutterAngle", static_cast<float>(360 * metadata.shutter));
    }
}

/// How the picture was made.
void describeRender(ImageHeader& h, const Film& film, const RenderMetadata& metadata,
                    const DenoisedPicture* denoised) {
    const auto set = [&](const char* name, ImageAttribute value) {
        h.attributes.emplace_back(name, std::move(value));
    };
    set("Software", fmt::format("woodcock {}", version()));
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
        set(denoised ? "woodcock/noiseBeforeDenoising" : "woodcock/noise",
            static_cast<float>(noise));
    if (denoised) {
        set("woodcock/denoiser", denoised->denoiser);
        set("woodcock/denoised",
            fmt::format("R, G and B: {}. As rendered: the layer {}", denoised->method, noisyLayer));
    }
    // EXR has no integer of 64 bits.
    set("woodcock/seed", fmt::format("{}", metadata.seed));
    set("woodcock/nonFinite", fmt::format("{}", film.nonFiniteCount()));
    set("woodcock/sceneDigest", metadata.sceneDigest);
    set("woodcock/renderSeconds", static_cast<float>(metadata.renderSeconds));
    if (!metadata.commandLine.empty()) set("woodcock/commandLine", metadata.commandLine);
}

/// Pixels of the crop, row by row, of a part whose header has the channels of these groups.
std::vector<float> pixelsOf(const Film& film, std::span<const ChannelGroup> groups,
                            std::size_t channels) {
    const Film::Window crop = film.crop();
    std::vector<float> pixels(film.pixelCount() * channels);
    float* to = pixels.data();
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x)
            for (const ChannelGroup& group : groups) {
                group.fill(film, x, y, to);
                // Beyond its range a half is infinite, which no later program can repair.
                if (group.half)
                    for (std::size_t i = 0; i < group.names.size(); ++i)
                        to[i] = std::clamp(to[i], -largestHalf, largestHalf);
                to += group.names.size();
            }
    return pixels;
}

}  // namespace

double exrBytesPerPixel(const ExrSettings& settings) {
    double bytes = 0;
    for (const ChannelGroup& group : channelGroups(settings, nullptr))
        bytes += double(group.names.size()) * (sizeof(float) + (group.half ? 2 : sizeof(float)));
    return bytes;
}

void writeExr(const std::filesystem::path& file, const Film& film, const RenderMetadata& metadata,
              const ExrSettings& settings, const FilmState* state, const BesideFilm& beside) {
    const MatteFilm* const mattes = beside.mattes;
    ExrSettings written = settings;
    written.denoised = beside.denoised != nullptr;
    std::vector<ChannelGroup> groups = channelGroups(written, beside.denoised);
    if (mattes) addMattes(*mattes, settings.multipart, groups);
    std::vector<ExrPart> parts;
    for (auto first = groups.begin(); first != groups.end();) {
        const auto end = std::find_if(first, groups.end(), [&](const ChannelGroup& group) {
            return group.part != first->part;
        });
        ImageHeader header = headerOfAnyPart(film, settings);
        describeShot(header, metadata, settings);
        if (first == groups.begin()) describeRender(header, film, metadata, beside.denoised);
        if (mattes)
            for (const MatteLayer& layer : mattes->layers())
                if (!settings.multipart || first->part == layer.name)
                    for (auto& [name, text] : matteAttributes(layer))
                        header.attributes.emplace_back(name, text);
        for (auto group = first; group != end; ++group)
            for (const std::string& name : group->names)
                header.channels.push_back({name, group->half ? PixelType::Half : PixelType::Float});
        parts.push_back({first->part, encodeImage(header, pixelsOf(film, {first, end},
                                                                   header.channels.size()))});
        first = end;
    }
    const std::vector<unsigned char> bytes =
        settings.multipart ? joinExrParts(parts) : std::move(parts.front().file);
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
