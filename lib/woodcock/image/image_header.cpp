// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/image_header.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>

#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"

namespace woodcock::image {

namespace {

using namespace std::string_view_literals;

/// The first bytes of an image file. They hold the size in all formats but EXR, JPEG and TIFF.
constexpr std::size_t headBytes = 4096;

constexpr double bestDeflate = 1032;  // RFC 1951: 258 bytes in two bits

template <class T>
T numberAt(std::string_view bytes, std::size_t at, bool bigEndian) {
    T v = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        const std::size_t from = bigEndian ? i : sizeof(T) - 1 - i;
        v = static_cast<T>(v << 8 | static_cast<unsigned char>(bytes[at + from]));
    }
    return v;
}

void requireHead(const RegularFile& file, std::string_view head, std::size_t bytes) {
    if (head.size() < bytes) throw file.unreadable("it is cut short: its header has no end");
}

Error damaged(const RegularFile& file, std::string_view what) {
    return file.unreadable(fmt::format("it is damaged: {}", what));
}

void checkPng(const RegularFile& file, std::string_view head) {
    requireHead(file, head, 33);
    const double width = numberAt<std::uint32_t>(head, 16, true),
                 height = numberAt<std::uint32_t>(head, 20, true);
    constexpr std::array<double, 7> channels{1, 0, 3, 1, 2, 0, 4};
    const auto colour = static_cast<std::size_t>(static_cast<unsigned char>(head[25]));
    if (head.substr(12, 4) != "IHDR" || colour >= channels.size() || channels[colour] == 0)
        throw damaged(file, "it does not begin with the header of a PNG");
    const double bits = static_cast<unsigned char>(head[24]) * channels[colour];
    requirePlausible(file, width, height, bits / 8, bestDeflate);
}

/// Marker after marker up to the frame's header (ITU T.81, B.2).
void checkJpeg(const RegularFile& file, std::string_view) {
    constexpr int mostSegments = 100000;
    std::uint64_t at = 2;
    for (int i = 0; i < mostSegments; ++i) {
        const std::string bytes = file.read(at, 10);
        requireHead(file, bytes, 4);
        if (static_cast<unsigned char>(bytes[0]) != 0xff)
            throw damaged(file, "its segments do not follow one another");
        const auto marker = static_cast<unsigned char>(bytes[1]);
        if (marker == 0xff) {  // filling
            at += 1;
            continue;
        }
        const bool frame =
            marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (frame) {
            requireHead(file, bytes, 10);
            const double height = numberAt<std::uint16_t>(bytes, 5, true),
                         width = numberAt<std::uint16_t>(bytes, 7, true);
            constexpr double bestHuffman = 2048;  // a block of 64 in a bit or two
            return requirePlausible(file, width, height, static_cast<unsigned char>(bytes[9]),
                                    bestHuffman);
        }
        const bool bare = marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8);
        if (marker == 0xd9 || marker == 0xda) break;
        at += 2 + (bare ? 0u : std::max<std::uint16_t>(numberAt<std::uint16_t>(bytes, 2, true), 2));
    }
    throw damaged(file, "it has no header of a frame");
}

/// Number after number of a text; -1 where there is none.
class Words {
public:
    explicit Words(std::string_view text) : text_(text) {}
    double number() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) {
            ++at_;
            while (at_ < text_.size() && text_[at_] == '#')
                at_ = std::min(text_.find('\n', at_), text_.size());
        }
        std::uint32_t value = 0;
        const auto [end, error] =
            std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (error != std::errc()) return -1;
        at_ = static_cast<std::size_t>(end - text_.data());
        return value;
    }
    bool skip(std::string_view word) {
        if (!text_.substr(std::min(at_, text_.size())).starts_with(word)) return false;
        at_ += word.size();
        return true;
    }

private:
    std::string_view text_;
    std::size_t at_ = 0;
};

void checkRadiance(const RegularFile& file, std::string_view head) {
    const std::size_t end = head.find("\n\n");
    if (end == std::string_view::npos) throw damaged(file, "its header has no end");
    Words words(head.substr(end + 2));
    double first = -1, second = -1;
    if (words.skip("-Y ") || words.skip("+Y ") || words.skip("+X ") || words.skip("-X ")) {
        first = words.number();
        words.skip(" ");
        if (words.skip("+X ") || words.skip("-X ") || words.skip("-Y ") || words.skip("+Y "))
            second = words.number();
    }
    if (first < 1 || second < 1) throw damaged(file, "its header names no size");
    constexpr double bestRuns = 64;  // 127 bytes in two
    requirePlausible(file, second, first, 4, bestRuns);
}

void checkWebp(const RegularFile& file, std::string_view head) {
    requireHead(file, head, 30);
    const auto part = [&](std::size_t at) { return numberAt<std::uint32_t>(head, at, false); };
    const std::string_view kind = head.substr(12, 4);
    double width = 0, height = 0;
    if (kind == "VP8 ")
        width = numberAt<std::uint16_t>(head, 26, false) & 0x3fff,
        height = numberAt<std::uint16_t>(head, 28, false) & 0x3fff;
    else if (kind == "VP8L")
        width = (part(21) & 0x3fff) + 1, height = (part(21) >> 14 & 0x3fff) + 1;
    else if (kind == "VP8X")
        width = (part(24) & 0xffffff) + 1, height = (part(26) >> 8) + 1;
    else
        throw damaged(file, "its first part is not known");
    constexpr double bestCopies = 8192;  // 4096 pixels in two bytes
    requirePlausible(file, width, height, 4, bestCopies);
}

void checkBmp(const RegularFile& file, std::string_view head) {
    requireHead(file, head, 30);
    double width = 0, height = 0, bits = 0;
    if (numberAt<std::uint32_t>(head, 14, false) == 12) {
        width = numberAt<std::uint16_t>(head, 18, false);
        height = numberAt<std::uint16_t>(head, 20, false);
        bits = numberAt<std::uint16_t>(head, 24, false);
    } else {
        width = static_cast<std::int32_t>(numberAt<std::uint32_t>(head, 18, false));
        height =
            std::abs(double(static_cast<std::int32_t>(numberAt<std::uint32_t>(head, 22, false))));
        bits = numberAt<std::uint16_t>(head, 28, false);
    }
    if (bits < 1 || bits > 32) throw damaged(file, fmt::format("its pixels have {} bits", bits));
    constexpr double bestRuns = 128;
    requirePlausible(file, width, height, bits / 8, bestRuns);
}

void checkTga(const RegularFile& file, std::string_view head) {
    requireHead(file, head, 18);
    const double bits = static_cast<unsigned char>(head[16]);
    if (bits < 1 || bits > 32) throw damaged(file, fmt::format("its pixels have {} bits", bits));
    constexpr double bestRuns = 128;
    requirePlausible(file, numberAt<std::uint16_t>(head, 12, false),
                     numberAt<std::uint16_t>(head, 14, false), bits / 8, bestRuns);
}

void checkPnm(const RegularFile& file, std::string_view head) {
    Words words(head.substr(2));
    const double width = words.number(), height = words.number();
    if (width < 1 || height < 1) throw damaged(file, "its header names no size");
    const char kind = head[1];
    const double channels = kind == '3' || kind == '6' || kind == 'F' ? 3 : 1;
    const bool bits = kind == '1' || kind == '4', floats = kind == 'F' || kind == 'f';
    requirePlausible(file, width, height, channels * (bits ? 0.125 : floats ? 4 : 1), 1);
}

/// libtiff reads its directories within bounds, and before anything is decoded: OpenImage checks
/// them there.
void checkTiff(const RegularFile&, std::string_view) {}

struct KnownFormat {
    const char* words;
    const char* name;  ///< OpenImageIO's
    bool (*begins)(std::string_view head);
    void (*check)(const RegularFile&, std::string_view head);
};

const std::array<KnownFormat, 9> known{{
    {"OpenEXR", "openexr", [](auto h) { return h.starts_with("\x76\x2f\x31\x01"sv); },
     [](const RegularFile& file, std::string_view) { checkExrHeader(file); }},
    {"PNG", "png", [](auto h) { return h.starts_with("\x89PNG\r\n\x1a\n"sv); }, checkPng},
    {"JPEG", "jpeg", [](auto h) { return h.starts_with("\xff\xd8\xff"sv); }, checkJpeg},
    {"TIFF", "tiff",
     [](auto h) {
         return h.starts_with("II*\0"sv) || h.starts_with("MM\0*"sv) || h.starts_with("II+\0"sv) ||
                h.starts_with("MM\0+"sv);
     },
     checkTiff},
    {"Radiance HDR", "hdr",
     [](auto h) { return h.starts_with("#?RADIANCE"sv) || h.starts_with("#?RGBE"sv); },
     checkRadiance},
    {"WebP", "webp",
     [](auto h) { return h.starts_with("RIFF"sv) && h.substr(0, 12).ends_with("WEBP"sv); },
     checkWebp},
    {"PNM, PFM", "pnm",
     [](auto h) {
         return h.size() > 2 && h[0] == 'P' && "123456Ff"sv.find(h[1]) != h.npos &&
                std::isspace(static_cast<unsigned char>(h[2]));
     },
     checkPnm},
    {"BMP", "bmp", [](auto h) { return h.starts_with("BM"sv); }, checkBmp},
    {"TGA", "targa",
     [](auto h) {
         constexpr auto kinds = "\x01\x02\x03\x09\x0a\x0b"sv;
         return h.size() >= 18 && static_cast<unsigned char>(h[1]) < 2 &&
                kinds.find(h[2]) != std::string_view::npos;
     },
     checkTga},
}};

/// Extensions of formats that are not read, although libraries may read them.
std::string adviceFor(const std::string& head) {
    if (head.size() > 132 && head.compare(128, 4, "DICM") == 0)
        return "it is a DICOM image, which woodcock does not read; convert its series to NRRD by "
               "3D Slicer or dcm2niix -e y";
    return fmt::format(
        "its format is not one that woodcock reads ({}); oiiotool and most image editors convert "
        "others",
        imageFormatsRead());
}

bool isNamedTga(const std::filesystem::path& name) {
    std::string ending = name.extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return ending == ".tga" || ending == ".tpic";
}

}  // namespace

std::string imageFormatsRead() {
    std::string names;
    for (const KnownFormat& format : known)
        names += (names.empty() ? "" : ", ") + std::string(format.words);
    return names;
}

std::string checkImageHeader(const RegularFile& file, const std::filesystem::path& name) {
    const std::string head = file.read(0, headBytes);
    if (head.empty()) throw file.unreadable("it is empty");
    for (const KnownFormat& format : known) {
        if (!format.begins(head)) continue;
        if (format.name == "targa"sv && !isNamedTga(name)) continue;
        format.check(file, head);
        return format.name;
    }
    throw file.unreadable(adviceFor(head));
}

void requirePlausible(const RegularFile& file, double width, double height, double pixelBytes,
                      double bestRatio) {
    if (!(width >= 1 && height >= 1 && pixelBytes > 0))
        throw damaged(file, fmt::format("its header says {} x {} pixels", width, height));
    constexpr double alwaysBelieved = 64 << 20;
    const double bytes = width * height * pixelBytes, size = static_cast<double>(file.size());
    if (bytes > alwaysBelieved + bestRatio * size)
        throw damaged(file, fmt::format("its header says {} x {} pixels, {} of memory, and {} "
                                        "bytes cannot hold so much",
                                        width, height, formatGiB(bytes), file.size()));
}

}  // namespace woodcock::image
