// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "woodcock/base/error.h"
#include "woodcock/base/printable.h"
#include "woodcock/image/exr_layout.h"
#include "woodcock/image/image_header.h"

namespace woodcock::image {

namespace {

constexpr std::size_t longestName = 255;
constexpr int mostParts = 1000, mostAttributes = 10000;

/// OpenEXR's compressions, in the order of their numbers.
struct Compression {
    int lines;     ///< of a chunk
    double ratio;  ///< the best ratio of compression, or a little more
};
// Deflate ends at 1032; PXR24 deflates three bytes of four; PIZ codes runs of up to 255 zeros in a
// few bits; B44 packs 32 bytes into 3 where they are equal; DWA keeps one number of 64 equal ones,
// and deflates those.
constexpr std::array<Compression, 10> compressions{{{1, 1},
                                                    {1, 128},
                                                    {1, 1100},
                                                    {16, 1100},
                                                    {32, 4000},
                                                    {16, 1500},
                                                    {32, 16},
                                                    {32, 16},
                                                    {32, 20000},
                                                    {256, 20000}}};

/// Reads on in the header, whose words are little-endian.
class Walk {
public:
    explicit Walk(const RegularFile& file) : file_(file) {}

    std::uint64_t position() const { return position_; }
    std::uint64_t left() const { return file_.size() - std::min(file_.size(), position_); }

    std::string bytes(std::uint64_t n) {
        if (n > left())
            throw file_.unreadable(fmt::format(
                "it is damaged or cut short: its header needs {} bytes at byte {}, and {} are left",
                n, position_, left()));
        std::string read = file_.read(position_, static_cast<std::size_t>(n));
        if (read.size() < n) throw file_.unreadable("it shrank while it was read");
        position_ += n;
        return read;
    }
    template <class T>
    T value() {
        T v;
        std::memcpy(&v, bytes(sizeof v).data(), sizeof v);
        return v;
    }
    /// Ends with a zero byte.
    std::string name() {
        const std::string text = file_.read(position_, longestName + 1);
        const std::size_t end = text.find('\0');
        if (end == std::string::npos)
            throw file_.unreadable(fmt::format(
                "it is damaged: its header has no end of a name at byte {}", position_));
        position_ += end + 1;
        return text.substr(0, end);
    }

private:
    const RegularFile& file_;
    std::uint64_t position_ = 4;
};

template <class T>
T valueAt(const std::string& bytes, std::size_t at) {
    T v;
    std::memcpy(&v, bytes.data() + at, sizeof v);
    return v;
}

/// What one part's header says of its pixels.
struct Part {
    std::optional<std::array<std::int32_t, 4>> window;
    std::optional<std::array<std::uint32_t, 2>> tile;
    std::optional<std::size_t> compression;
    double pixelBytes = 0;
    double chunkCount = 0;  ///< as in the file; 0: not there
    bool tiled = false, deep = false;
};

class HeaderCheck {
public:
    explicit HeaderCheck(const RegularFile& file) : file_(file), walk_(file) {}

    void run() {
        const auto version = walk_.value<std::uint32_t>();
        if ((version & exr::versionMask) != exr::version)
            throw file_.unreadable(
                fmt::format("it is an OpenEXR file of version {}; only version {} is known",
                            version & exr::versionMask, exr::version));
        if (version & exr::deepParts)
            throw file_.unreadable("it has deep pixels, which woodcock does not read");
        const bool parts = version & exr::severalParts;
        double chunks = 0;
        for (int part = 0; part == 0 || parts; ++part) {
            if (part > mostParts) throw damaged("its header has no end");
            std::string name = walk_.name();
            if (parts && name.empty()) break;
            chunks += check(readPart(std::move(name), version & exr::tiled));
        }
        if (8 * chunks > static_cast<double>(walk_.left()))
            throw damaged(fmt::format("its table of {:.0f} chunks does not fit in {} bytes", chunks,
                                      walk_.left()));
    }

private:
    Error damaged(const std::string& what) const {
        return file_.unreadable("it is damaged or cut short: " + what);
    }

    Part readPart(std::string name, bool tiled) {
        Part part;
        part.tiled = tiled;
        for (int count = 0; !name.empty(); ++count) {
            if (count > mostAttributes) throw damaged("its header has no end");
            const std::string type = walk_.name();
            const auto size = walk_.value<std::int32_t>();
            if (size < 0 || static_cast<std::uint64_t>(size) > walk_.left())
                throw damaged(fmt::format("attribute '{}' has {} bytes where {} are left",
                                          shown(name, 40), size, walk_.left()));
            const std::string bytes = walk_.bytes(static_cast<std::uint64_t>(size));
            checkAttribute(name, type, bytes);
            note(part, name, type, bytes);
            name = walk_.name();
        }
        return part;
    }

    /// Types whose contents hold sizes that OpenEXR would allocate.
    void checkAttribute(const std::string& name, const std::string& type,
                        const std::string& bytes) const {
        const auto fail = [&] {
            return damaged(
                fmt::format("the contents of attribute '{}' do not fit its type", shown(name, 40)));
        };
        if (type == "preview") {
            if (bytes.size() < 8) throw fail();
            const double pixels =
                double(valueAt<std::uint32_t>(bytes, 0)) * valueAt<std::uint32_t>(bytes, 4);
            if (8 + 4 * pixels != static_cast<double>(bytes.size())) throw fail();
        } else if (type == "stringvector") {
            for (std::size_t at = 0; at < bytes.size();) {
                if (bytes.size() - at < 4) throw fail();
                const auto length = valueAt<std::int32_t>(bytes, at);
                at += 4;
                if (length < 0 || static_cast<std::size_t>(length) > bytes.size() - at)
                    throw fail();
                at += static_cast<std::size_t>(length);
            }
        } else if (type == "idmanifest") {
            // A size in bytes when it is inflated, then how it is packed.
            constexpr double bestDeflate = 1100;
            if (bytes.size() < 8 || double(valueAt<std::uint64_t>(bytes, 0)) >
                                        bestDeflate * static_cast<double>(bytes.size()))
                throw fail();
        }
    }

    void note(Part& part, const std::string& name, const std::string& type,
              const std::string& bytes) const {
        const auto need = [&](const char* expected, std::size_t size) {
            if (type != expected || bytes.size() != size)
                throw damaged(fmt::format("attribute '{}' is not a {}", name, expected));
        };
        if (name == "dataWindow") {
            need("box2i", 16);
            part.window.emplace();
            for (std::size_t i = 0; i < 4; ++i)
                (*part.window)[i] = valueAt<std::int32_t>(bytes, 4 * i);
        } else if (name == "compression") {
            need("compression", 1);
            part.compression = static_cast<unsigned char>(bytes[0]);
        } else if (name == "tiles") {
            need("tiledesc", 9);
            part.tile = {valueAt<std::uint32_t>(bytes, 0), valueAt<std::uint32_t>(bytes, 4)};
        } else if (name == "chunkCount") {
            need("int", 4);
            part.chunkCount = valueAt<std::int32_t>(bytes, 0);
        } else if (name == "type") {
            part.tiled |= bytes == "tiledimage";
            part.deep |= bytes.starts_with("deep");
        } else if (name == "channels") {
            part.pixelBytes = channelBytes(bytes);
        }
    }

    /// Bytes of a pixel, if no channel is coarser than the image.
    double channelBytes(const std::string& bytes) const {
        double sum = 0;
        std::size_t at = 0;
        while (at < bytes.size() && bytes[at] != '\0') {
            const std::size_t end = bytes.find('\0', at);
            if (end == std::string::npos || bytes.size() - end < 17)
                throw damaged("its list of channels has no end");
            sum += valueAt<std::int32_t>(bytes, end + 1) == 1 ? 2 : 4;
            at = end + 17;
        }
        return sum;
    }

    /// The number of its chunks.
    double check(const Part& part) const {
        if (part.deep) throw file_.unreadable("it has deep pixels, which woodcock does not read");
        if (!part.window || !part.compression || part.pixelBytes == 0)
            throw damaged("its header lacks the window of pixels, the channels or the compression");
        if (*part.compression >= compressions.size())
            throw file_.unreadable(
                fmt::format("its compression, number {}, is not known", *part.compression));
        const auto& [x0, y0, x1, y1] = *part.window;
        const double width = double(x1) - x0 + 1, height = double(y1) - y0 + 1;
        if (width < 1 || height < 1) throw damaged("its window of pixels is empty");
        const Compression& compression = compressions[*part.compression];
        requirePlausible(file_, width, height, part.pixelBytes, compression.ratio);
        if (part.tiled) {
            if (!part.tile || (*part.tile)[0] == 0 || (*part.tile)[1] == 0)
                throw damaged("it is tiled, and its header does not describe tiles");
            const double x = (*part.tile)[0], y = (*part.tile)[1];
            requirePlausible(file_, x, y, part.pixelBytes, compression.ratio);
            return std::max(part.chunkCount, std::ceil(width / x) * std::ceil(height / y));
        }
        // All lines of a chunk take memory, also where the image has fewer.
        requirePlausible(file_, width, std::max<double>(height, compression.lines), part.pixelBytes,
                         compression.ratio);
        return std::max(part.chunkCount, std::ceil(height / compression.lines));
    }

    const RegularFile& file_;
    Walk walk_;
};

}  // namespace

void checkExrHeader(const RegularFile& file) { HeaderCheck(file).run(); }

}  // namespace woodcock::image
