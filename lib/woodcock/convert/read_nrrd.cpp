// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "woodcock/convert/dense_formats.h"
#include "woodcock/convert/number_text.h"
#include "woodcock/convert/source_bytes.h"
#include "woodcock/base/printable.h"

namespace woodcock {

namespace {

struct NrrdHeader {
    std::filesystem::path file;
    std::map<std::string, std::string> fields;  ///< names in lower case, without spaces

    bool has(const std::string& name) const { return fields.contains(name); }
    const std::string& get(const std::string& name) const {
        const auto found = fields.find(name);
        if (found == fields.end())
            throw inputError("{}: the NRRD header has no field '{}'", file.string(), name);
        return found->second;
    }
    Error wrong(const std::string& name, const std::string& expected) const {
        return inputError("{}: the NRRD field '{}' is '{}'; expected {}", file.string(), name,
                          printable(get(name).substr(0, 100)), expected);
    }
};

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::string trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t\r");
    if (begin == text.npos) return {};
    return std::string(text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1));
}

/// The next line, which must end within the file and a sane length.
std::string readLine(FileBytes& file) {
    std::string line;
    while (true) {
        if (file.left() == 0)
            throw inputError("{}: the NRRD header has no end: no empty line follows it",
                             file.path().string());
        const char c = file.value<char>();
        if (c == '\n') break;
        line += c;
        if (line.size() > 65536)
            throw inputError("{}: the NRRD header has a line of over 65536 characters",
                             file.path().string());
    }
    if (line.ends_with('\r')) line.pop_back();
    return line;
}

/// Reads up to the empty line before the data.
NrrdHeader readHeader(FileBytes& file) {
    NrrdHeader header{file.path(), {}};
    const std::span<const char> magic = file.bytes(std::min<std::uint64_t>(file.left(), 8));
    const std::string_view text(magic.data(), magic.size());
    if (text.size() < 8 || !text.starts_with("NRRD000") || text[7] < '1' || text[7] > '6')
        throw inputError("{} is no NRRD file: it begins with '{}' instead of NRRD0001 to NRRD0006",
                         file.path().string(), printable(text));
    readLine(file);
    for (std::string line; !(line = readLine(file)).empty();) {
        if (line.starts_with('#') || line.find(":=") != line.npos) continue;
        const std::size_t colon = line.find(':');
        if (colon == line.npos)
            throw inputError("{}: the NRRD header has the line '{}', which is no 'field: value'",
                             file.path().string(), printable(line.substr(0, 100)));
        std::string name = lower(trimmed(line.substr(0, colon)));
        std::erase(name, ' ');
        header.fields[name] = trimmed(line.substr(colon + 1));
    }
    return header;
}

std::vector<std::string> words(const std::string& text) {
    std::vector<std::string> found;
    for (std::size_t at = 0; (at = text.find_first_not_of(" \t", at)) != text.npos;) {
        // A vector may have spaces within its parentheses.
        const std::size_t close = text[at] == '(' ? text.find(')', at) : at;
        const std::size_t end = std::min(text.find_first_of(" \t", close), text.size());
        found.push_back(text.substr(at, end - at));
        at = end;
    }
    return found;
}

double numberOf(const NrrdHeader& header, const std::string& field, std::string_view word) {
    const auto value = parseDouble(trimmed(word));
    if (!value || !std::isfinite(*value)) throw header.wrong(field, "finite numbers");
    return *value;
}

Vec3d vectorOf(const NrrdHeader& header, const std::string& field, const std::string& word) {
    Vec3d v;
    if (word.size() < 2 || word.front() != '(' || word.back() != ')')
        throw header.wrong(field, "vectors such as (0,0,1)");
    std::string_view rest(word.data() + 1, word.size() - 2);
    for (int i = 0; i < 3; ++i) {
        const std::size_t comma = i < 2 ? rest.find(',') : rest.size();
        if (comma == rest.npos) throw header.wrong(field, "vectors of three numbers");
        v[i] = numberOf(header, field, rest.substr(0, comma));
        rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    return v;
}

SampleType typeOf(const NrrdHeader& header) {
    static const std::map<std::string, SampleType> types = [] {
        std::map<std::string, SampleType> names;
        const auto add = [&](SampleType type, std::initializer_list<const char*> all) {
            for (const char* name : all) names[name] = type;
        };
        add(SampleType::I8, {"signed char", "int8", "int8_t"});
        add(SampleType::U8, {"uchar", "unsigned char", "uint8", "uint8_t"});
        add(SampleType::I16,
            {"short", "short int", "signed short", "signed short int", "int16", "int16_t"});
        add(SampleType::U16,
            {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"});
        add(SampleType::I32, {"int", "signed int", "int32", "int32_t"});
        add(SampleType::U32, {"uint", "unsigned int", "uint32", "uint32_t"});
        add(SampleType::I64, {"longlong", "long long", "long long int", "signed long long",
                              "signed long long int", "int64", "int64_t"});
        add(SampleType::U64,
            {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"});
        add(SampleType::F32, {"float"});
        add(SampleType::F64, {"double"});
        return names;
    }();
    const auto found = types.find(lower(header.get("type")));
    if (found == types.end()) throw header.wrong("type", "int8 to uint64, float or double");
    return found->second;
}

/// Which of the axes of the file is x (y and z follow), and which holds the channels.
struct NrrdAxes {
    std::vector<std::int64_t> sizes;
    std::vector<std::size_t> space;
    std::optional<std::size_t> channels;
};

NrrdAxes axesOf(const NrrdHeader& header) {
    NrrdAxes axes;
    for (const std::string& word : words(header.get("sizes"))) {
        std::int64_t n = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), n);
        if (error != std::errc() || end != word.data() + word.size() || n < 1)
            throw header.wrong("sizes", "positive whole numbers");
        axes.sizes.push_back(n);
    }
    if (header.get("dimension") != std::to_string(axes.sizes.size()))
        throw header.wrong("dimension", fmt::format("{}, the number of sizes", axes.sizes.size()));
    if (axes.sizes.size() != 3 && axes.sizes.size() != 4)
        throw header.wrong("dimension", "3, or 4 where one axis is that of channels");
    if (axes.sizes.size() == 4) {
        // The axis that lies in no direction of space; the first where nothing is said.
        axes.channels = 0;
        const auto mark = [&](const char* field, auto isChannel) {
            if (!header.has(field)) return;
            const std::vector<std::string> each = words(header.get(field));
            if (each.size() != 4) throw header.wrong(field, "an entry for each of the axes");
            for (std::size_t a = 0; a < 4; ++a)
                if (isChannel(lower(each[a]))) axes.channels = a;
        };
        mark("kinds", [](const std::string& kind) {
            return kind != "domain" && kind != "space" && kind != "time" && kind != "???" &&
                   kind != "none";
        });
        mark("spacedirections", [](const std::string& vector) { return vector == "none"; });
        if (axes.sizes[*axes.channels] > 1024)
            throw header.wrong("sizes", "one axis of at most 1024 channels among the four");
    }
    for (std::size_t a = 0; a < axes.sizes.size(); ++a)
        if (a != axes.channels) axes.space.push_back(a);
    return axes;
}

void setLayout(DenseVolume& volume, const NrrdAxes& axes) {
    std::vector<std::int64_t> strides(axes.sizes.size(), 1);
    for (std::size_t a = 1; a < strides.size(); ++a)
        strides[a] = strides[a - 1] * axes.sizes[a - 1];
    for (std::size_t i = 0; i < 3; ++i) volume.stride[i] = strides[axes.space[i]];
    volume.channelStride = axes.channels ? strides[*axes.channels] : 1;
}

void place(DenseVolume& volume, const NrrdHeader& header, const NrrdAxes& axes) {
    if (header.has("spacedirections")) {
        const std::vector<std::string> vectors = words(header.get("spacedirections"));
        if (vectors.size() != axes.sizes.size())
            throw header.wrong("spacedirections", "a vector for each axis");
        for (std::size_t i = 0; i < 3; ++i)
            volume.worldFromIndex.column[i] =
                vectorOf(header, "spacedirections", vectors[axes.space[i]]);
        volume.placed = true;
    } else if (header.has("spacings")) {
        const std::vector<std::string> spacings = words(header.get("spacings"));
        if (spacings.size() != axes.sizes.size())
            throw header.wrong("spacings", "a number for each axis");
        Vec3d voxel;
        for (std::size_t i = 0; i < 3; ++i)
            voxel[static_cast<int>(i)] = numberOf(header, "spacings", spacings[axes.space[i]]);
        volume.worldFromIndex = Affine3d::scale(voxel);
        volume.placed = true;
    }
    if (header.has("spaceorigin")) {
        volume.worldFromIndex.translation =
            vectorOf(header, "spaceorigin", header.get("spaceorigin"));
        volume.placed = true;
    }
    const double determinant = volume.worldFromIndex.determinant();
    if (determinant == 0 || !std::isfinite(determinant))
        throw inputError("{}: the NRRD header's directions or spacings are zero or lie in a plane",
                         header.file.string());
    for (const char* ignored : {"axismins", "axismaxs", "measurementframe"})
        if (header.has(ignored))
            volume.notes.push_back(
                fmt::format("{}: the NRRD field '{}' is ignored", header.file.string(), ignored));
}

void checkSkips(const NrrdHeader& header) {
    for (const char* detached : {"datafile", "lineskip", "byteskip"})
        if (header.has(detached) && header.get(detached) != "0")
            throw inputError(
                "{}: the NRRD field '{}' is not supported: the values must follow the header",
                header.file.string(), detached);
}

/// Gives the volume memory of its own for `bytes`.
char* allocate(DenseVolume& volume, std::uint64_t bytes, const std::filesystem::path& file) {
    requireMemory(static_cast<double>(bytes),
                  fmt::format("{}: {}", file.string(), volume.describe()));
    auto samples = std::shared_ptr<char[]>(new char[bytes]);
    volume.samples = samples.get();
    volume.owner = samples;
    return samples.get();
}

std::span<const char> restOf(FileBytes& file) {
    const std::uint64_t begin = file.position();
    file.enter(begin, file.size(), "its values");
    file.loadAll();
    return file.loaded(begin, file.size());
}

/// Deflate makes of one byte 1032 at most.
constexpr std::uint64_t largestInflation = 1032;

void inflateSamples(DenseVolume& volume, FileBytes& file, std::uint64_t needed) {
    if (needed / largestInflation > file.left())
        throw inputError("{}: {} need {} bytes, and {} bytes of gzip cannot hold them",
                         file.path().string(), volume.describe(), needed, file.left());
    const std::span<const char> packed = restOf(file);
    char* const samples = allocate(volume, needed, file.path());
    z_stream stream{};
    constexpr int gzip = 16 + MAX_WBITS;
    if (inflateInit2(&stream, gzip) != Z_OK) throw std::bad_alloc();
    std::uint64_t in = 0, out = 0;
    int status = Z_OK;
    char beyond = 0;
    constexpr std::uint64_t most = 1u << 30;
    while (status == Z_OK) {
        const std::uint64_t give = std::min(most, packed.size() - in);
        const std::uint64_t room = std::min(most, needed - out);
        stream.next_in =
            reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + in));  // only read
        stream.avail_in = static_cast<uInt>(give);
        // One byte more shows whether there is more.
        stream.next_out = reinterpret_cast<Bytef*>(room ? samples + out : &beyond);
        stream.avail_out = static_cast<uInt>(room ? room : 1);
        status = inflate(&stream, Z_NO_FLUSH);
        in += give - stream.avail_in;
        out += (room ? room : 1) - stream.avail_out;
        if (out > needed) break;
    }
    inflateEnd(&stream);
    if (status != Z_STREAM_END || out != needed)
        throw inputError("{}: {} need {} bytes, and the gzip data {}", file.path().string(),
                         volume.describe(), needed,
                         out > needed             ? "hold more"
                         : status == Z_STREAM_END ? fmt::format("hold {}", out)
                                                  : fmt::format("are damaged after {}", out));
}

void parseSamples(DenseVolume& volume, FileBytes& file, std::uint64_t count) {
    if (count / 2 > file.left())
        throw inputError("{}: {} need {} numbers, and {} characters cannot hold them",
                         file.path().string(), volume.describe(), count, file.left());
    const bool floats = fitsFloat(volume.type);
    const std::span<const char> text = restOf(file);
    volume.type = floats ? SampleType::F32 : SampleType::F64;
    volume.swapped = false;
    char* const samples = allocate(volume, count * sampleBytes(volume.type), file.path());
    NumberText numbers({text.data(), text.size()});
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::optional<double> value = numbers.next();
        if (!value)
            throw inputError("{}: {} numbers are expected, and after {} of them comes {}",
                             file.path().string(), count, i, numbers.describeRest());
        const auto asFloat = static_cast<float>(*value);
        if (floats)
            std::memcpy(samples + i * sizeof asFloat, &asFloat, sizeof asFloat);
        else
            std::memcpy(samples + i * sizeof *value, &*value, sizeof *value);
    }
    if (!numbers.atEnd())
        throw inputError("{}: {} numbers are expected, and after them comes {}",
                         file.path().string(), count, numbers.describeRest());
}

}  // namespace

DenseVolume readNrrd(const std::filesystem::path& path) {
    auto file = std::make_shared<FileBytes>(path, "a NRRD file");
    const NrrdHeader header = readHeader(*file);
    checkSkips(header);
    const NrrdAxes axes = axesOf(header);
    DenseVolume volume;
    volume.type = typeOf(header);
    for (std::size_t i = 0; i < 3; ++i) volume.dims[i] = axes.sizes[axes.space[i]];
    if (axes.channels) volume.channels = static_cast<int>(axes.sizes[*axes.channels]);
    const std::uint64_t needed = requireDims(volume, path);
    setLayout(volume, axes);
    place(volume, header, axes);
    const std::string encoding = lower(header.get("encoding"));
    const bool text = encoding == "ascii" || encoding == "text" || encoding == "txt";
    if (sampleBytes(volume.type) > 1 && !text) {
        const std::string endian = lower(header.get("endian"));
        if (endian != "little" && endian != "big") throw header.wrong("endian", "little or big");
        volume.swapped = (endian == "big") != (std::endian::native == std::endian::big);
    }
    const std::uint64_t begin = file->position();
    if (encoding == "raw")
        loadSamples(volume, file, begin);
    else if (encoding == "gzip" || encoding == "gz")
        inflateSamples(volume, *file, needed);
    else if (text)
        parseSamples(volume, *file, needed / sampleBytes(volume.type));
    else
        throw header.wrong("encoding", "raw, gzip or ascii");
    return volume;
}

}  // namespace woodcock
