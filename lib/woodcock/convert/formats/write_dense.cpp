// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <cerrno>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <span>

#include "woodcock/base/error.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/convert/formats/dense_formats.h"
#include "woodcock/grid/half.h"

namespace woodcock {

namespace {

/// The nearest number of the type; nothing where there is none.
template <class Sample>
std::optional<Sample> toSample(double v) {
    if constexpr (std::is_same_v<Sample, double>) {
        return v;
    } else if constexpr (std::is_same_v<Sample, float>) {
        const auto f = static_cast<float>(v);
        return std::isfinite(f) == std::isfinite(v) ? std::optional(f) : std::nullopt;
    } else if constexpr (std::is_same_v<Sample, HalfBits>) {
        const auto f = static_cast<float>(v);
        if (!(std::abs(f) < 65520.0f)) return {};  // from there on a half is infinite
        return HalfBits{encodeHalf(f)};
    } else {
        const double whole = std::nearbyint(v);
        // The ends as doubles: the upper one may be rounded up, and is then out of range.
        const auto low = static_cast<double>(std::numeric_limits<Sample>::min());
        const double high = std::ldexp(1.0, std::numeric_limits<Sample>::digits);
        if (!(whole >= low && whole < high)) return {};
        return static_cast<Sample>(whole);
    }
}

template <class Sample>
double toDouble(Sample sample) {
    if constexpr (std::is_same_v<Sample, HalfBits>)
        return static_cast<double>(decodeHalf(sample.bits));
    else
        return static_cast<double>(sample);
}

/// Packs bytes by gzip, piece by piece. The same bytes give the same file: no name, no time.
class Gzip {
public:
    Gzip() {
        constexpr int gzip = 16 + MAX_WBITS, usualMemory = 8;
        if (deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip, usualMemory,
                         Z_DEFAULT_STRATEGY) != Z_OK)
            throw std::bad_alloc();
    }
    ~Gzip() { deflateEnd(&stream_); }
    Gzip(const Gzip&) = delete;
    Gzip& operator=(const Gzip&) = delete;

    /// Calls `write` with what is packed so far; `last` ends the stream.
    template <class Write>
    void pack(std::span<const char> bytes, bool last, Write write) {
        while (true) {
            constexpr std::size_t most = 1u << 30;
            const std::size_t give = std::min(bytes.size(), most);
            // Only read.
            stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
            stream_.avail_in = static_cast<uInt>(give);
            bytes = bytes.subspan(give);
            do {
                stream_.next_out = reinterpret_cast<Bytef*>(out_.data());
                stream_.avail_out = static_cast<uInt>(out_.size());
                deflate(&stream_, last && bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
                write(out_.data(), out_.size() - stream_.avail_out);
            } while (stream_.avail_out == 0);
            if (bytes.empty()) return;
        }
    }

private:
    z_stream stream_{};
    std::array<char, 1 << 16> out_;
};

/// A file that is written row by row.
class DenseFile {
public:
    DenseFile(const std::filesystem::path& file, const std::string& header, bool packed)
        : file_(file), making_(file), out_(making_.temporary(), std::ios::binary) {
        write(header.data(), header.size());
        if (packed) gzip_ = std::make_unique<Gzip>();
    }

    /// Rows along axis `along`, the other two in `order` with the last the fastest. Returns the
    /// largest difference that the type makes.
    double writeValues(const DenseVolume& volume, SampleType type, bool xFirst,
                       const WorkProgress& progress) {
        const std::array<std::size_t, 3> order =
            xFirst ? std::array<std::size_t, 3>{2, 1, 0} : std::array<std::size_t, 3>{0, 1, 2};
        const auto rows = static_cast<std::uint64_t>(volume.dims[order[0]] * volume.dims[order[1]]);
        WorkCounter counter(progress, rows);
        Dims begin{}, size{1, 1, 1};
        size[order[2]] = volume.dims[order[2]];
        std::vector<double> values(static_cast<std::size_t>(size[order[2]] * volume.channels));
        double most = 0;
        for (std::int64_t a = 0; a < volume.dims[order[0]]; ++a)
            for (std::int64_t b = 0; b < volume.dims[order[1]]; ++b) {
                begin[order[0]] = a, begin[order[1]] = b;
                readBlock(volume, begin, size, values.data());
                most = std::max(most, writeRow(values, type, volume.channels, begin, order[2]));
                counter.add(1);
            }
        return most;
    }

    void commit() {
        writePacked({}, true);
        out_.close();
        if (!out_) throwFailure();
        making_.commit();
    }

private:
    double writeRow(const std::vector<double>& values, SampleType type, int channels, Dims begin,
                    std::size_t along) {
        double most = 0;
        withSampleType(type, [&]<class Sample>(Sample) {
            row_.resize(values.size() * sizeof(Sample));
            for (std::size_t i = 0; i < values.size(); ++i) {
                std::optional<Sample> sample = toSample<Sample>(values[i]);
                if (!sample) {
                    begin[along] = static_cast<std::int64_t>(i) / channels;
                    throw inputError(
                        "cannot write '{}': the value {} of voxel [{}, {}, {}] is beyond the range "
                        "of {}; use --scale, --clamp or another --out-type",
                        file_.string(), values[i], begin[0], begin[1], begin[2],
                        sampleTypeName(type));
                }
                const double error = std::abs(toDouble(*sample) - values[i]);
                if (error > most) most = error;
                if (std::endian::native == std::endian::big) *sample = swapBytes(*sample);
                std::memcpy(row_.data() + i * sizeof(Sample), &*sample, sizeof(Sample));
            }
        });
        if (gzip_)
            writePacked(row_, false);
        else
            write(row_.data(), row_.size());
        return most;
    }

    void writePacked(std::span<const char> bytes, bool last) {
        if (gzip_) gzip_->pack(bytes, last, [this](const char* b, std::size_t n) { write(b, n); });
    }

    void write(const char* bytes, std::size_t size) {
        errno = 0;
        if (!out_.write(bytes, static_cast<std::streamsize>(size))) throwFailure();
    }

    [[noreturn]] void throwFailure() const {
        throw failure("cannot write '{}': {}", file_.string(),
                      errno ? std::strerror(errno) : "the file system takes no more");
    }

    std::filesystem::path file_;
    FileInTheMaking making_;
    std::ofstream out_;
    std::unique_ptr<Gzip> gzip_;
    std::vector<char> row_;
};

double writeFile(const std::filesystem::path& file, const std::string& header,
                 const DenseVolume& volume, bool xFirst, SampleType type,
                 const WorkProgress& progress, bool packed = false) {
    DenseFile out(file, header, packed);
    const double most = out.writeValues(volume, type, xFirst, progress);
    out.commit();
    return most;
}

template <class T>
void append(std::string& bytes, T value) {
    if (std::endian::native == std::endian::big) value = swapBytes(value);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

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

double writeRaw(const std::filesystem::path& file, const DenseVolume& volume,
                const DenseWriteOptions& options) {
    return writeFile(file, "", volume, true, options.type.value_or(volume.type), options.progress);
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
    append(header, static_cast<std::uint16_t>(text.size()));
    return writeFile(file, header + text, volume, false, type, options.progress);
}

double writeMitsubaVolume(const std::filesystem::path& file, const DenseVolume& original,
                          const DenseWriteOptions& options) {
    if (options.type.value_or(SampleType::F32) != SampleType::F32)
        throw usageError("a Mitsuba volume holds f32; --out-type {} is not possible",
                         sampleTypeName(*options.type));
    DenseVolume volume = original;
    straighten(volume);
    const Affine3d& map = volume.worldFromIndex;
    const Vec3d voxel{map.column[0].x, map.column[1].y, map.column[2].z};
    if (!(Affine3d::scale(voxel).column == map.column) ||
        !(voxel.x > 0 && voxel.y > 0 && voxel.z > 0))
        throw inputError(
            "cannot write '{}': '{}' is rotated or sheared in the world, and a Mitsuba volume has "
            "but a box along the axes; NRRD keeps any transform",
            file.string(), volume.name);
    std::string header("VOL\x03", 4);
    append(header, std::int32_t{1});
    for (const std::int64_t n : volume.dims) append(header, static_cast<std::int32_t>(n));
    append(header, std::int32_t{volume.channels});
    for (const double corner : {-0.5, 0.5})
        for (int i = 0; i < 3; ++i) {
            const double cell =
                corner < 0 ? corner
                           : static_cast<double>(volume.dims[static_cast<std::size_t>(i)]) - corner;
            append(header, static_cast<float>(map.translation[i] + cell * voxel[i]));
        }
    return writeFile(file, header, volume, true, SampleType::F32, options.progress);
}

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
    return writeFile(file, header, volume, true, type, options.progress, options.packed);
}

}  // namespace woodcock
