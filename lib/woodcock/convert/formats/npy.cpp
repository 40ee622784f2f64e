// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <map>

#include "woodcock/base/nearest_name.h"
#include "woodcock/base/printable.h"
#include "woodcock/convert/formats/dense_file.h"
#include "woodcock/convert/formats/dense_formats.h"
#include "woodcock/convert/formats/source_bytes.h"
#include "woodcock/convert/formats/zip_archive.h"

namespace woodcock::convert {

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
            throw wrong("'descr' is not the name of a type (records are not supported)");
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
        if (!value.starts_with('(')) throw wrong("'shape' is not a tuple");
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
                throw wrong("'shape' is not a tuple");
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

/// Bytes in memory, read as those of a file are.
class MemoryBytes {
public:
    MemoryBytes(std::span<const char> bytes, std::filesystem::path name)
        : bytes_(bytes), path_(std::move(name)) {}

    std::uint64_t position() const { return position_; }
    std::span<const char> bytes(std::uint64_t n) {
        if (n > bytes_.size() - position_)
            throw inputError("{} is cut short or damaged: its header reaches beyond its end",
                             path_.string());
        position_ += n;
        return bytes_.subspan(position_ - n, n);
    }
    template <class T>
    T value() {
        T v;
        std::memcpy(&v, bytes(sizeof v).data(), sizeof v);
        return v;
    }
    void skip(std::uint64_t n) { bytes(n); }
    const std::filesystem::path& path() const { return path_; }

private:
    std::span<const char> bytes_;
    std::uint64_t position_ = 0;
    std::filesystem::path path_;
};

template <class Bytes>
std::string readHeaderText(Bytes& file) {
    constexpr std::string_view magic = "\x93NUMPY";
    const std::span<const char> start = file.bytes(magic.size());
    if (std::string_view(start.data(), start.size()) != magic)
        throw inputError("{} is not a NumPy array: it does not begin with \\x93NUMPY",
                         file.path().string());
    const int version = file.template value<unsigned char>();
    file.skip(1);
    if (version < 1 || version > 3)
        throw inputError("{}: NumPy format of version {}; known: 1 to 3", file.path().string(),
                         version);
    std::uint32_t length = 0;
    for (int i = 0; i < (version == 1 ? 2 : 4); ++i)
        length |= std::uint32_t{file.template value<unsigned char>()} << (8 * i);
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
            "{}: an array of type '{}' does not hold plain numbers; known: b1, u1 to u8, i1 to i8, "
            "f2, "
            "f4, f8",
            file.string(), printable(descr));
    volume.type = type->second;
    volume.swapped = descr[0] == (std::endian::native == std::endian::little ? '>' : '<');
}

/// Dims, channels and type; the samples are still to come.
DenseVolume describeArray(const NpyHeader& header, const std::filesystem::path& file) {
    DenseVolume volume;
    setType(volume, header.descr(), file);
    const std::vector<std::int64_t> shape = header.shape();
    if (shape.size() != 3 && shape.size() != 4)
        throw inputError("{}: an array of {} dimensions; expected [x, y, z] or [x, y, z, channel]",
                         file.string(), shape.size());
    for (std::size_t a = 0; a < 3; ++a) volume.dims[a] = shape[a];
    if (shape.size() == 4) {
        if (shape[3] < 1 || shape[3] > 1024)
            throw inputError(
                "{}: the last of four dimensions is the number of channels; it is {}, and 1 to "
                "1024 are possible",
                file.string(), shape[3]);
        volume.channels = static_cast<int>(shape[3]);
    }
    return volume;
}

void setOrder(DenseVolume& volume, bool fortran) {
    volume.setStridesZFirst();
    if (!fortran) return;
    volume.stride = {1, volume.dims[0], volume.dims[0] * volume.dims[1]};
    volume.channelStride = volume.dims[0] * volume.dims[1] * volume.dims[2];
}

constexpr std::string_view arrayEnding = ".npy";

/// The array's name: that of its file in the archive.
std::string arrayName(const ZipEntry& entry) {
    return entry.name.substr(0, entry.name.size() - arrayEnding.size());
}

std::string shapeText(const std::vector<std::int64_t>& shape) {
    std::string text;
    for (const std::int64_t n : shape) text += (text.empty() ? "" : ", ") + std::to_string(n);
    return "[" + text + "]";
}

/// One array of an archive. Absent, with a note, where it is not a volume.
std::optional<DenseVolume> readArray(grid::FileBytes& file, const ZipEntry& entry, bool wanted,
                                     std::vector<std::string>& notes) {
    const UnpackedEntry unpacked = unpackZipEntry(file, entry);
    const std::filesystem::path place =
        fmt::format("{}: '{}'", file.path().string(), arrayName(entry));
    MemoryBytes bytes(unpacked.bytes, place);
    const NpyHeader header(readHeaderText(bytes), place);
    const std::vector<std::int64_t> shape = header.shape();
    if (shape.size() != 3 && shape.size() != 4 && !wanted) {
        notes.push_back(fmt::format("{} is left out: an array of shape {} is not a volume",
                                    place.string(), shapeText(shape)));
        return {};
    }
    DenseVolume volume = describeArray(header, place);
    volume.name = arrayName(entry);
    const std::uint64_t needed = requireDims(volume, place);
    if (const std::uint64_t found = unpacked.bytes.size() - bytes.position(); found != needed)
        throw inputError("{}: {} need {} bytes, and there are {}", place.string(),
                         volume.describe(), needed, found);
    volume.samples = unpacked.bytes.data() + bytes.position();
    volume.owner = unpacked.owner;
    setOrder(volume, header.fortranOrder());
    return volume;
}

}  // namespace

std::vector<DenseVolume> readNpz(const std::filesystem::path& path,
                                 const std::optional<std::string>& array) {
    grid::FileBytes file(path, "an archive of NumPy arrays");
    std::vector<ZipEntry> entries;
    std::vector<std::string> names;
    for (ZipEntry& entry : listZip(file)) {
        if (!entry.name.ends_with(arrayEnding)) continue;
        names.push_back(arrayName(entry));
        entries.push_back(std::move(entry));
    }
    if (entries.empty()) throw inputError("{} holds no NumPy array (.npy)", path.string());
    if (array && std::find(names.begin(), names.end(), *array) == names.end())
        throw inputError("there is no array '{}' in {}{}", *array, path.string(),
                         suggestName(*array, "it has", names));
    std::vector<std::string> notes;
    std::vector<DenseVolume> volumes;
    double bytes = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (array && names[i] != *array) continue;
        bytes += static_cast<double>(entries[i].size);
        requireMemory(bytes, fmt::format("{}: its arrays", path.string()));
        if (auto volume = readArray(file, entries[i], array.has_value(), notes))
            volumes.push_back(std::move(*volume));
    }
    if (volumes.empty())
        throw inputError(
            "{} holds no array of three or four dimensions, [x, y, z] or [x, y, z, channel]; it "
            "has: {}",
            path.string(), joinNames(names));
    for (const DenseVolume& volume : volumes)
        if (volume.dims != volumes.front().dims)
            throw inputError(
                "{}: arrays '{}' and '{}' differ in size, {} and {}; choose one by --grid: {}",
                path.string(), volumes.front().name, volume.name,
                shapeText({volumes[0].dims.begin(), volumes[0].dims.end()}),
                shapeText({volume.dims.begin(), volume.dims.end()}), joinNames(names));
    // numpy.savez(file, array) names it arr_0.
    if (volumes.size() == 1 && volumes.front().name == "arr_0") volumes.front().name = "density";
    volumes.front().notes = std::move(notes);
    return volumes;
}

DenseVolume readNpy(const std::filesystem::path& file) {
    auto bytes = std::make_shared<grid::FileBytes>(file, "a NumPy array");
    const NpyHeader header(readHeaderText(*bytes), file);
    DenseVolume volume = describeArray(header, file);
    const std::uint64_t begin = bytes->position();
    loadSamples(volume, std::move(bytes), begin);
    setOrder(volume, header.fortranOrder());
    return volume;
}

double writeNpy(const std::filesystem::path& file, const DenseVolume& volume,
                const DenseWriteOptions& options) {
    const SampleType type = options.type.value_or(volume.type);
    const char kind = *sampleTypeName(type);
    std::string shape = fmt::format("{}, {}, {}", volume.dims[0], volume.dims[1], volume.dims[2]);
    if (volume.channels > 1) shape += fmt::format(", {}", volume.channels);
    std::string text =
        fmt::format("{{'descr': '{}{}{}', 'fortran_order': False, 'shape': ({}), }}",
                    sampleBytes(type) == 1 ? '|' : '<', kind, sampleBytes(type), shape);
    // NumPy asks for a multiple of 64 bytes and a line feed at the end.
    constexpr std::size_t fixed = 10;
    text.append(63 - (fixed + text.size()) % 64, ' ');
    text += '\n';
    std::string header("\x93NUMPY\x01\x00", 8);
    appendLittleEndian(header, static_cast<std::uint16_t>(text.size()));
    return writeDenseFile(file, volume, {header + text, VoxelOrder::ZFastest, type},
                          options.progress);
}

}  // namespace woodcock::convert
