// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/exr_parts.h"

#include <cstdint>
#include <cstring>

#include "woodcock/base/error.h"
#include "woodcock/image/exr_layout.h"

namespace woodcock::image {

namespace {

/// Reads on in a file, whose numbers are little-endian, as those of the processors here.
class Reader {
public:
    explicit Reader(std::span<const unsigned char> bytes) : bytes_(bytes) {}

    std::size_t position() const { return at_; }
    void moveTo(std::size_t position) { at_ = position; }
    std::span<const unsigned char> take(std::size_t count) {
        if (count > bytes_.size() - std::min(at_, bytes_.size()))
            throw failure("a part of an OpenEXR file ends too early");
        at_ += count;
        return bytes_.subspan(at_ - count, count);
    }
    template <class T>
    T number() {
        T value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    /// Of a text that ends with a zero byte; its length.
    std::size_t text() {
        const std::size_t begin = at_;
        while (take(1)[0] != 0) {
        }
        return at_ - begin - 1;
    }

private:
    std::span<const unsigned char> bytes_;
    std::size_t at_ = 0;
};

class Writer {
public:
    explicit Writer(std::size_t bytes) { file.reserve(bytes); }

    template <class T>
    void number(T value) {
        unsigned char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        file.insert(file.end(), bytes, bytes + sizeof value);
    }
    void bytes(std::span<const unsigned char> bytes) {
        file.insert(file.end(), bytes.begin(), bytes.end());
    }
    void text(std::string_view text) {
        file.insert(file.end(), text.begin(), text.end());
        file.push_back(0);
    }
    void attribute(std::string_view name, std::string_view value) {
        text(name), text("string");
        number(static_cast<std::int32_t>(value.size()));
        file.insert(file.end(), value.begin(), value.end());
    }
    void attribute(std::string_view name, std::int32_t value) {
        text(name), text("int");
        number(std::int32_t{sizeof value});
        number(value);
    }

    std::vector<unsigned char> file;
};

/// Where what is what in a file of one part.
struct Layout {
    std::uint32_t flags;
    std::span<const unsigned char> attributes;
    std::vector<std::uint64_t> chunks;  ///< where they begin
};

Layout layoutOf(std::span<const unsigned char> file) {
    Reader reader(file);
    if (reader.number<std::uint32_t>() != exr::magic) throw failure("a part is no OpenEXR file");
    const auto flags = reader.number<std::uint32_t>();
    if ((flags & exr::versionMask) != exr::version ||
        flags & (exr::tiled | exr::deepParts | exr::severalParts))
        throw failure("a part of an OpenEXR file is not flat, of lines and alone");
    const std::size_t begin = reader.position();
    while (reader.text() > 0) {
        reader.text();  // its type
        reader.take(reader.number<std::uint32_t>());
    }
    const std::size_t end = reader.position();
    Layout layout{flags, file.subspan(begin, end - 1 - begin), {}};
    // The first chunk begins where the table of chunks ends.
    do layout.chunks.push_back(reader.number<std::uint64_t>());
    while (reader.position() < layout.chunks.front());
    return layout;
}

}  // namespace

std::vector<unsigned char> joinExrParts(std::span<const ExrPart> parts) {
    std::vector<Layout> layouts;
    std::uint32_t flags = exr::version | exr::severalParts;
    std::size_t size = 64;
    for (const ExrPart& part : parts) {
        layouts.push_back(layoutOf(part.file));
        flags |= layouts.back().flags & exr::longNames;
        size += part.file.size() + 128 + part.name.size() + 4 * layouts.back().chunks.size();
    }
    Writer writer(size);
    writer.number(exr::magic), writer.number(flags);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        writer.bytes(layouts[i].attributes);
        writer.attribute("name", parts[i].name);
        writer.attribute("type", "scanlineimage");
        writer.attribute("chunkCount", static_cast<std::int32_t>(layouts[i].chunks.size()));
        writer.text("");
    }
    writer.text("");
    std::vector<std::size_t> tables;
    for (const Layout& layout : layouts) {
        tables.push_back(writer.file.size());
        writer.file.resize(writer.file.size() + 8 * layout.chunks.size());
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Reader reader(parts[i].file);
        for (std::size_t k = 0; k < layouts[i].chunks.size(); ++k) {
            const std::uint64_t place = writer.file.size();
            std::memcpy(&writer.file[tables[i] + 8 * k], &place, sizeof place);
            reader.moveTo(layouts[i].chunks[k]);
            writer.number(static_cast<std::int32_t>(i));
            writer.number(reader.number<std::int32_t>());  // its first line
            const auto bytes = reader.number<std::uint32_t>();
            writer.number(bytes);
            writer.bytes(reader.take(bytes));
        }
    }
    return std::move(writer.file);
}

}  // namespace woodcock::image
