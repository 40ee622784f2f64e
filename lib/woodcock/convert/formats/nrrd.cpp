// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/printable.h"
#include "woodcock/convert/formats/dense_file.h"
#include "woodcock/convert/formats/dense_formats.h"
#include "woodcock/convert/formats/nrrd_header.h"
#include "woodcock/convert/formats/number_text.h"
#include "woodcock/convert/formats/source_bytes.h"

namespace woodcock::convert {

namespace fs = std::filesystem;

namespace {

void setLayout(DenseVolume& volume, const NrrdAxes& axes) {
    std::vector<std::int64_t> strides(axes.sizes.size(), 1);
    for (std::size_t a = 1; a < strides.size(); ++a)
        strides[a] = strides[a - 1] * axes.sizes[a - 1];
    for (std::size_t i = 0; i < 3; ++i) volume.stride[i] = strides[axes.space[i]];
    volume.channelStride = axes.channels ? strides[*axes.channels] : 1;
}

/// Files with the values, relative to the header's folder.
std::vector<fs::path> dataFiles(const NrrdHeader& header) {
    const std::vector<std::string> words = nrrdWords(header.get("datafile"));
    if (words.empty()) throw header.wrong("datafile", "a name");
    std::vector<fs::path> files;
    const auto add = [&](const std::string& name) {
        files.push_back(header.file.parent_path() / name);  // an absolute name stays itself
    };
    // "slice.%03d.raw 1 20 1", perhaps with the dimension of each file after it
    const bool numbered = words.size() >= 4 && words[0].find('%') != std::string::npos;
    if (words[0] == "LIST") {
        for (const std::string& name : header.listed) add(name);
    } else if (numbered) {
        const std::int64_t first = nrrdWhole(header, "datafile", words[1]),
                           last = nrrdWhole(header, "datafile", words[2]),
                           step = nrrdWhole(header, "datafile", words[3]);
        constexpr std::int64_t most = 1'000'000'000;
        const std::size_t percent = words[0].find('%'), end = words[0].find('d', percent);
        std::string width =
            end == std::string::npos ? "?" : words[0].substr(percent + 1, end - percent - 1);
        const bool zeros = width.starts_with('0');
        const bool known = width.size() <= 2 && std::all_of(width.begin(), width.end(), [](char c) {
                               return c >= '0' && c <= '9';
                           });
        if (!known || step == 0 || std::abs(last) > most || std::abs(first) > most ||
            (last - first) / step < 0 || (last - first) / step >= 100000)
            throw header.wrong("datafile", "a name, LIST, or NAME.%03d.raw FIRST LAST STEP");
        const int digits = width.empty() ? 0 : std::stoi(width);
        for (std::int64_t n = first; step > 0 ? n <= last : n >= last; n += step)
            add(words[0].substr(0, percent) +
                (zeros ? fmt::format("{:0{}}", n, digits) : fmt::format("{:{}}", n, digits)) +
                words[0].substr(end + 1));
    } else {
        add(header.get("datafile"));
    }
    if (files.empty()) throw header.wrong("datafile", "names of files below it");
    return files;
}

/// Values as they come from one file or several of equal parts.
struct NrrdData {
    std::string encoding;
    std::int64_t skipBytes = 0;  ///< -1: the values are the file's last bytes
    std::int64_t skipLines = 0;
};

NrrdData describeData(const NrrdHeader& header) {
    NrrdData data;
    data.encoding = nrrdLower(header.get("encoding"));
    if (data.encoding == "gz") data.encoding = "gzip";
    if (data.encoding == "txt" || data.encoding == "text") data.encoding = "ascii";
    if (data.encoding == "bz2" || data.encoding == "bzip2" || data.encoding == "hex")
        throw inputError(
            "{}: woodcock does not read NRRD data in {}; `unu save -f nrrd -e gzip -i {} -o "
            "OUT.nrrd` packs them by gzip, which it reads",
            header.file.string(), data.encoding, header.file.filename().string());
    if (data.encoding != "raw" && data.encoding != "gzip" && data.encoding != "ascii")
        throw header.wrong("encoding", "raw, gzip or ascii");
    if (header.has("byteskip")) {
        data.skipBytes = nrrdWhole(header, "byteskip", header.get("byteskip"));
        if (data.skipBytes < -1 || (data.skipBytes == -1 && data.encoding != "raw"))
            throw header.wrong("byteskip", "0 or more, or -1 for raw data at the file's end");
    }
    if (header.has("lineskip")) {
        data.skipLines = nrrdWhole(header, "lineskip", header.get("lineskip"));
        if (data.skipLines < 0) throw header.wrong("lineskip", "0 or more");
    }
    return data;
}

void skipLines(grid::FileBytes& file, std::int64_t lines) {
    while (lines > 0) {
        if (file.left() == 0)
            throw inputError("{}: the NRRD field 'lineskip' skips the whole file",
                             file.path().string());
        if (file.value<char>() == '\n') --lines;
    }
}

/// Deflate makes of one byte 1032 at most.
constexpr std::uint64_t largestInflation = 1032;

/// All that is left of the file, in memory.
std::span<const char> restOf(grid::FileBytes& file) {
    const std::uint64_t begin = file.position();
    file.enter(begin, file.size(), "its values");
    file.loadAll();
    return file.loaded(begin, file.size());
}

/// Inflates as many bytes as `to` has, after the skipped ones. True where there are more.
bool inflateInto(grid::FileBytes& file, std::uint64_t skipped, std::span<char> to) {
    const std::uint64_t needed = skipped + to.size();
    if (needed / largestInflation > file.left())
        throw inputError("{}: {} bytes of values are needed, and {} bytes of gzip cannot hold them",
                         file.path().string(), needed, file.left());
    const std::span<const char> packed = restOf(file);
    z_stream stream{};
    constexpr int gzip = 16 + MAX_WBITS;
    if (inflateInit2(&stream, gzip) != Z_OK) throw std::bad_alloc();
    std::uint64_t in = 0, out = 0;
    int status = Z_OK;
    std::array<char, 4096> unused;  // what is skipped, and what is beyond
    constexpr std::uint64_t most = 1u << 30;
    while (status == Z_OK && out <= needed) {
        const std::uint64_t give = std::min(most, packed.size() - in);
        char* place = unused.data();
        std::uint64_t room = unused.size();
        if (out < skipped)
            room = std::min(room, skipped - out);
        else if (out < needed)
            place = to.data() + (out - skipped), room = std::min(most, needed - out);
        stream.next_in =
            reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + in));  // only read
        stream.avail_in = static_cast<uInt>(give);
        stream.next_out = reinterpret_cast<Bytef*>(place);
        stream.avail_out = static_cast<uInt>(room);
        status = inflate(&stream, Z_NO_FLUSH);
        in += give - stream.avail_in;
        out += room - stream.avail_out;
    }
    inflateEnd(&stream);
    if (out < needed)
        throw inputError("{}: {} bytes of values are needed, and the gzip data {}",
                         file.path().string(), needed,
                         status == Z_STREAM_END ? fmt::format("hold {}", out)
                                                : fmt::format("are damaged after {}", out));
    if (out == needed && status != Z_STREAM_END)
        throw inputError("{}: the gzip data are damaged at their end", file.path().string());
    return out > needed;
}

/// Numbers as text become floats or doubles. True where there are more.
bool parseInto(grid::FileBytes& file, SampleType type, std::span<char> to) {
    const std::uint64_t count = to.size() / sampleBytes(type);
    if (count / 2 > file.left())
        throw inputError("{}: {} numbers are needed, and {} characters cannot hold them",
                         file.path().string(), count, file.left());
    const std::span<const char> text = restOf(file);
    NumberText numbers({text.data(), text.size()});
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::optional<double> value = numbers.next();
        if (!value)
            throw inputError("{}: {} numbers are expected, and after {} of them comes {}",
                             file.path().string(), count, i, numbers.describeRest());
        const auto asFloat = static_cast<float>(*value);
        if (type == SampleType::F32)
            std::memcpy(to.data() + i * sizeof asFloat, &asFloat, sizeof asFloat);
        else
            std::memcpy(to.data() + i * sizeof *value, &*value, sizeof *value);
    }
    return !numbers.atEnd();
}

/// The position of the raw values; checks that `needed` bytes are there.
std::uint64_t rawBegin(grid::FileBytes& file, const NrrdData& data, std::uint64_t needed) {
    const std::uint64_t left = file.left();
    const auto skip = static_cast<std::uint64_t>(std::max<std::int64_t>(data.skipBytes, 0));
    if (needed > left || skip > left - needed)
        throw inputError("{} is too short: its values take {} bytes{}, and it has {}",
                         file.path().string(), needed,
                         skip > 0 ? fmt::format(" after {} that are skipped", skip) : "", left);
    return data.skipBytes < 0 ? file.size() - needed : file.position() + skip;
}

/// Fills `to` from a file, whose position is at its values, or at lines to be skipped. True where
/// it has more.
bool readPart(grid::FileBytes& file, const NrrdData& data, SampleType type, std::span<char> to) {
    skipLines(file, data.skipLines);
    if (data.encoding == "raw") {
        const std::uint64_t begin = rawBegin(file, data, to.size());
        file.seek(begin);
        constexpr std::size_t piece = 1 << 24;
        for (std::size_t at = 0; at < to.size(); at += piece) {
            const std::span<const char> bytes = file.bytes(std::min(piece, to.size() - at));
            std::copy(bytes.begin(), bytes.end(), to.begin() + static_cast<std::ptrdiff_t>(at));
        }
        return file.left() > 0;
    }
    if (data.encoding == "gzip")
        return inflateInto(file, static_cast<std::uint64_t>(data.skipBytes), to);
    file.skip(static_cast<std::uint64_t>(data.skipBytes));
    return parseInto(file, type, to);
}

/// Attached raw values, of which no copy is made.
bool loadAttached(DenseVolume& volume, std::shared_ptr<grid::FileBytes> file, const NrrdData& data,
                  std::uint64_t needed) {
    skipLines(*file, data.skipLines);
    const std::uint64_t begin = rawBegin(*file, data, needed);
    const bool more = begin + needed < file->size();
    file->enter(begin, begin + needed, "its values");
    file->loadAll();
    volume.samples = file->loaded(begin, begin + needed).data();
    volume.owner = std::move(file);
    return more;
}

bool loadDetached(DenseVolume& volume, const NrrdHeader& header, const NrrdData& data,
                  std::span<char> to) {
    const std::vector<fs::path> files = dataFiles(header);
    if (to.size() / sampleBytes(volume.type) % files.size() != 0)
        throw inputError("{}: {} cannot be split evenly among {} data files", header.file.string(),
                         volume.describe(), files.size());
    const std::size_t part = to.size() / files.size();
    bool more = false;
    for (std::size_t i = 0; i < files.size(); ++i) {
        try {
            grid::FileBytes file(files[i], "the data of a NRRD file");
            more = readPart(file, data, volume.type, to.subspan(i * part, part)) || more;
        } catch (const Error& e) {
            throw Error(e.kind(), fmt::format("{}: its data: {}", header.file.string(), e.what()));
        }
    }
    return more;
}

/// Memory of the volume's own.
std::span<char> allocate(DenseVolume& volume, std::uint64_t bytes, const fs::path& file) {
    requireMemory(static_cast<double>(bytes),
                  fmt::format("{}: {}", file.string(), volume.describe()));
    auto samples = std::shared_ptr<char[]>(new char[bytes]);
    volume.samples = samples.get();
    volume.owner = samples;
    return {samples.get(), static_cast<std::size_t>(bytes)};
}

void setByteOrder(DenseVolume& volume, const NrrdHeader& header) {
    if (sampleBytes(volume.type) < 2) return;
    const std::string endian = nrrdLower(header.get("endian"));
    if (endian != "little" && endian != "big") throw header.wrong("endian", "little or big");
    volume.swapped = (endian == "big") != (std::endian::native == std::endian::big);
}

void loadValues(DenseVolume& volume, const NrrdHeader& header,
                std::shared_ptr<grid::FileBytes> file) {
    const NrrdData data = describeData(header);
    if (data.encoding == "ascii")
        volume.type = fitsFloat(volume.type) ? SampleType::F32 : SampleType::F64;
    else
        setByteOrder(volume, header);
    const std::uint64_t needed = requireDims(volume, header.file);
    const bool attached = !header.has("datafile") || nrrdLower(header.get("datafile")) == "local";
    bool more = false;
    if (attached && data.encoding == "raw") {
        requireMemory(static_cast<double>(needed),
                      fmt::format("{}: {}", header.file.string(), volume.describe()));
        more = loadAttached(volume, std::move(file), data, needed);
    } else {
        // Checked before memory is taken: the file is large enough for its values.
        const std::uint64_t size = attached ? file->left() : needed;
        if (attached && needed / largestInflation / sizeof(double) > size)
            throw inputError("{}: {} need {} bytes, and {} bytes cannot hold them",
                             header.file.string(), volume.describe(), needed, size);
        const std::span<char> to = allocate(volume, needed, header.file);
        more = attached ? readPart(*file, data, volume.type, to)
                        : loadDetached(volume, header, data, to);
    }
    if (more)
        volume.notes.push_back(fmt::format("{}: {} after its values are ignored",
                                           header.file.string(),
                                           data.encoding == "ascii" ? "numbers" : "bytes"));
}

}  // namespace

DenseVolume readNrrd(const fs::path& path) {
    auto file = std::make_shared<grid::FileBytes>(path, "a NRRD file");
    const NrrdHeader header = readNrrdHeader(*file);
    const NrrdAxes axes = nrrdAxes(header);
    DenseVolume volume;
    volume.type = nrrdType(header);
    for (std::size_t i = 0; i < 3; ++i) volume.dims[i] = axes.sizes[axes.space[i]];
    if (axes.channels) volume.channels = static_cast<int>(axes.sizes[*axes.channels]);
    volume.list = axes.list;
    requireDims(volume, path);
    setLayout(volume, axes);
    placeNrrd(volume, header, axes);
    if (!axes.note.empty()) volume.notes.push_back(axes.note);
    loadValues(volume, header, std::move(file));
    return volume;
}

namespace {

const char* nrrdTypeName(SampleType type) {
    switch (type) {
        case SampleType::U8:
            return "uint8";
        case SampleType::I8:
            return "int8";
        case SampleType::U16:
            return "uint16";
        case SampleType::I16:
            return "int16";
        case SampleType::U32:
            return "uint32";
        case SampleType::I32:
            return "int32";
        case SampleType::U64:
            return "uint64";
        case SampleType::I64:
            return "int64";
        case SampleType::F16:
            throw usageError("NRRD has no halves; use --out-type f32");
        case SampleType::F64:
            return "double";
        case SampleType::F32:
            break;
    }
    return "float";
}

std::string vectorText(Vec3d v) { return fmt::format("({},{},{})", v.x, v.y, v.z); }

}  // namespace

double writeNrrd(const std::filesystem::path& file, const DenseVolume& volume,
                 const DenseWriteOptions& options) {
    const SampleType type = options.type.value_or(volume.type);
    const bool colour = volume.channels > 1;
    const auto& map = volume.worldFromIndex;
    std::string header = "NRRD0004\n";
    header += fmt::format("type: {}\n", nrrdTypeName(type));
    header += fmt::format("dimension: {}\n", colour ? 4 : 3);
    header += "space dimension: 3\n";
    header += fmt::format("sizes: {}{} {} {}\n", colour ? fmt::format("{} ", volume.channels) : "",
                          volume.dims[0], volume.dims[1], volume.dims[2]);
    header += fmt::format("space directions: {}{} {} {}\n", colour ? "none " : "",
                          vectorText(map.column[0]), vectorText(map.column[1]),
                          vectorText(map.column[2]));
    header += fmt::format("kinds: {}domain domain domain\n", colour ? "vector " : "");
    header += fmt::format("endian: little\nencoding: {}\n", options.packed ? "gzip" : "raw");
    header += fmt::format("space origin: {}\n\n", vectorText(map.translation));
    return writeDenseFile(file, volume, {header, VoxelOrder::XFastest, type, options.packed},
                          options.progress);
}

}  // namespace woodcock::convert
