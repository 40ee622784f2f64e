// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <map>

#include "woodcock/convert/dense_formats.h"
#include "woodcock/convert/source_bytes.h"
#include "woodcock/base/printable.h"

namespace woodcock {

namespace {

/// The header: a Python dictionary of three literals.
class NpyHeader {
public:
    NpyHeader(std::string text, const std::filesystem::path& file)
        : text_(std::move(text)), file_(file) {}

    std::string descr() const {
        const std::string_view value = after("descr");
        const std::size_t end = value.size() > 1 ? value.find(value[0], 1) : value.npos;
        if (end == value.npos || (value[0] != '\'' && value[0] != '"'))
            throw wrong("'descr' is no name of a type (records are not supported)");
        return std::string(value.substr(1, end - 1));
    }

    bool fortranOrder() const {
        const std::string_view value = after("fortran_order");
        if (value.starts_with("True")) return true;
        if (value.starts_with("False")) return false;
        throw wrong("'fortran_order' is neither True nor False");
    }

    std::vector<std::int64_t> shape() const {
        std::string_view value = after("shape");
        if (!value.starts_with('(')) throw wrong("'shape' is no tuple");
        value.remove_prefix(1);
        std::vector<std::int64_t> shape;
        for (skipSpace(value); !value.starts_with(')'); skipSpace(value)) {
            std::int64_t n = 0;
            const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), n);
            if (error != std::errc() || shape.size() > 32)
                throw wrong("'shape' holds something other than whole numbers");
            shape.push_back(n);
            value.remove_prefix(static_cast<std::size_t>(end - value.data()));
            skipSpace(value);
            if (value.starts_with(','))
                value.remove_prefix(1);
            else if (!value.starts_with(')'))
                throw wrong("'shape' is no tuple");
        }
        return shape;
    }

private:
    static void skipSpace(std::string_view& text) {
        while (!text.empty() && (text[0] == ' ' || text[0] == '\n')) text.remove_prefix(1);
    }

    std::string_view after(const std::string& key) const {
        for (const char quote : {'\'', '"'}) {
            const std::string quoted = quote + key + quote;
            const std::size_t at = text_.find(quoted);
            if (at == text_.npos) continue;
            std::string_view value = std::string_view(text_).substr(at + quoted.size());
            skipSpace(value);
            if (!value.starts_with(':')) continue;
            value.remove_prefix(1);
            skipSpace(value);
            return value;
        }
        throw wrong("it has no '" + key + "'");
    }

    Error wrong(const std::string& what) const {
        return inputError("{}: the header of the NumPy array is damaged: {}; it reads: {}",
                          file_.string(), what, printable(text_.substr(0, 200)));
    }

    std::string text_;
    std::filesystem::path file_;
};

std::string readHeaderText(FileBytes& file) {
    constexpr std::string_view magic = "\x93NUMPY";
    const std::span<const char> start = file.bytes(magic.size());
    if (std::string_view(start.data(), start.size()) != magic)
        throw inputError("{} is no NumPy array: it does not begin with \\x93NUMPY",
                         file.path().string());
    const int version = file.value<unsigned char>();
    file.skip(1);
    if (version < 1 || version > 3)
        throw inputError("{}: NumPy format of version {}; known: 1 to 3", file.path().string(),
                         version);
    std::uint32_t length = 0;
    for (int i = 0; i < (version == 1 ? 2 : 4); ++i)
        length |= std::uint32_t{file.value<unsigned char>()} << (8 * i);
    const std::span<const char> text = file.bytes(length);
    return {text.begin(), text.end()};
}

void setType(DenseVolume& volume, const std::string& descr, const std::filesystem::path& file) {
    static const std::map<std::string, SampleType> types{
        {"b1", SampleType::U8},  {"u1", SampleType::U8},  {"i1", SampleType::I8},
        {"u2", SampleType::U16}, {"i2", SampleType::I16}, {"u4", SampleType::U32},
        {"i4", SampleType::I32}, {"u8", SampleType::U64}, {"i8", SampleType::I64},
        {"f2", SampleType::F16}, {"f4", SampleType::F32}, {"f8", SampleType::F64}};
    const bool marked =
        !descr.empty() && std::string_view("<>|=").find(descr[0]) != std::string::npos;
    const auto type = types.find(marked ? descr.substr(1) : descr);
    if (type == types.end())
        throw inputError(
            "{}: an array of type '{}' holds no plain numbers; known: b1, u1 to u8, i1 to i8, f2, "
            "f4, f8",
            file.string(), printable(descr));
    volume.type = type->second;
    volume.swapped = descr[0] == (std::endian::native == std::endian::little ? '>' : '<');
}

}  // namespace

DenseVolume readNpy(const std::filesystem::path& file) {
    auto bytes = std::make_shared<FileBytes>(file, "a NumPy array");
    const NpyHeader header(readHeaderText(*bytes), file);
    DenseVolume volume;
    setType(volume, header.descr(), file);
    const std::vector<std::int64_t> shape = header.shape();
    if (shape.size() != 3 && shape.size() != 4)
        throw inputError("{}: an array of {} dimensions; expected [x, y, z] or [x, y, z, channel]",
                         file.string(), shape.size());
    for (std::size_t a = 0; a < 3; ++a) volume.dims[a] = shape[a];
    if (shape.size() == 4) {
        if (shape[3] < 1 || shape[3] > 1024)
            throw inputError("{}: the last of four dimensions is that of channels, and is {}",
                             file.string(), shape[3]);
        volume.channels = static_cast<int>(shape[3]);
    }
    const std::uint64_t begin = bytes->position();
    loadSamples(volume, std::move(bytes), begin);
    volume.setStridesZFirst();
    if (header.fortranOrder()) {
        volume.stride = {1, volume.dims[0], volume.dims[0] * volume.dims[1]};
        volume.channelStride = volume.dims[0] * volume.dims[1] * volume.dims[2];
    }
    return volume;
}

}  // namespace woodcock
