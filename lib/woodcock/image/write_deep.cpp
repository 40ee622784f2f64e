// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/write_deep.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "woodcock/base/error.h"
#include "woodcock/base/version.h"
#include "woodcock/base/whole_file.h"

namespace woodcock::image {

namespace {

/// A file in memory: OpenEXR closes its own in a destructor, which hides a full disk.
class MemoryStream final : public Imf::OStream {
public:
    MemoryStream() : Imf::OStream("memory") {}
    void write(const char bytes[], int count) override {
        const auto n = static_cast<std::size_t>(count);
        if (at_ + n > bytes_.size()) bytes_.resize(at_ + n);
        std::memcpy(bytes_.data() + at_, bytes, n);
        at_ += n;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = static_cast<std::size_t>(at); }
    const std::vector<unsigned char>& bytes() const { return bytes_; }

private:
    std::vector<unsigned char> bytes_;
    std::size_t at_ = 0;
};

constexpr std::array<const char*, 6> channelNames{"R", "G", "B", "A", "Z", "ZBack"};

Imf::Header headerOf(const DeepFilm& deep, const Film& film, const RenderMetadata& metadata,
                     const std::optional<Chromaticities>& chromaticities) {
    const Film::Window crop = film.crop();
    Imf::Header header(Imath::Box2i({0, 0}, {film.width() - 1, film.height() - 1}),
                       Imath::Box2i({crop.x0, crop.y0}, {crop.x1 - 1, crop.y1 - 1}));
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    for (const char* name : channelNames) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    Imf::addDeepImageState(header, Imf::DIS_TIDY);
    if (chromaticities) {
        const Chromaticities& c = *chromaticities;
        Imf::addChromaticities(header, {{c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}, {c[6], c[7]}});
    }
    const auto text = [&](const char* name, const std::string& value) {
        header.insert(name, Imf::StringAttribute(value));
    };
    text("Software", fmt::format("woodcock {}", version()));
    text("woodcock/version", std::string(version()));
    text("woodcock/deepDepth", "Z and ZBack are along the camera's axis, in world units");
    header.insert("woodcock/deepError", Imf::FloatAttribute(static_cast<float>(deep.error())));
    header.insert("woodcock/samplesMean",
                  Imf::FloatAttribute(static_cast<float>(film.meanSamples())));
    text("woodcock/sampleRange", fmt::format("{}:{}", metadata.firstSample, metadata.endSample));
    text("woodcock/seed", fmt::format("{}", metadata.seed));
    text("woodcock/sceneDigest", metadata.sceneDigest);
    if (!metadata.commandLine.empty()) text("woodcock/commandLine", metadata.commandLine);
    return header;
}

/// The samples of all pixels as EXR wants them: by channel.
struct DeepPixels {
    std::vector<unsigned> counts;
    std::array<std::vector<float>, channelNames.size()> values;
    std::array<std::vector<float*>, channelNames.size()> pointers;

    DeepPixels(const DeepFilm& deep, const Film& film) {
        const Film::Window crop = film.crop();
        for (int y = crop.y0; y < crop.y1; ++y)
            for (int x = crop.x0; x < crop.x1; ++x) {
                const std::vector<DeepSample> samples = deep.samples(x, y, film);
                counts.push_back(static_cast<unsigned>(samples.size()));
                for (const DeepSample& s : samples) {
                    const std::array<float, 6> all{s.colour[0], s.colour[1], s.colour[2],
                                                   s.alpha,     s.near,      s.far};
                    for (std::size_t c = 0; c < all.size(); ++c) values[c].push_back(all[c]);
                }
            }
        for (std::size_t c = 0; c < values.size(); ++c) {
            float* to = values[c].data();
            for (const unsigned count : counts) pointers[c].push_back(to), to += count;
        }
    }
};

}  // namespace

void writeDeep(const std::filesystem::path& file, const DeepFilm& deep, const Film& film,
               const RenderMetadata& metadata,
               const std::optional<Chromaticities>& chromaticities) {
    const Film::Window crop = film.crop();
    DeepPixels pixels(deep, film);
    MemoryStream stream;
    try {
        Imf::DeepScanLineOutputFile output(stream, headerOf(deep, film, metadata, chromaticities));
        const auto width = static_cast<std::size_t>(crop.width());
        const std::ptrdiff_t origin =
            crop.x0 + std::ptrdiff_t{crop.y0} * static_cast<std::ptrdiff_t>(width);
        const auto slice = [&](auto* first) {
            return reinterpret_cast<char*>(first) -
                   origin * static_cast<std::ptrdiff_t>(sizeof(*first));
        };
        Imf::DeepFrameBuffer buffer;
        buffer.insertSampleCountSlice(Imf::Slice(Imf::UINT, slice(pixels.counts.data()),
                                                 sizeof(unsigned), sizeof(unsigned) * width));
        for (std::size_t c = 0; c < channelNames.size(); ++c)
            buffer.insert(channelNames[c],
                          Imf::DeepSlice(Imf::FLOAT, slice(pixels.pointers[c].data()),
                                         sizeof(float*), sizeof(float*) * width, sizeof(float)));
        output.setFrameBuffer(buffer);
        output.writePixels(crop.height());
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        throw failure("cannot encode deep pixels: {}", e.what());
    }
    writeWholeFile(file, stream.bytes());
}

}  // namespace woodcock::image
