// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/formats/dense_file.h"

#include <zlib.h>

#include <cerrno>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <span>

#include "woodcock/base/error.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/grid/half.h"

namespace woodcock::convert {

namespace {

/// The nearest number of the type; absent where the type cannot hold the value.
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
        return HalfBits{grid::encodeHalf(f)};
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
        return static_cast<double>(grid::decodeHalf(sample.bits));
    else
        return static_cast<double>(sample);
}

/// Packs bytes by gzip, piece by piece. The same bytes give the same file: its header has neither a
/// name nor a time.
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

    /// Writes row by row; a row lies along the fastest axis. Returns the largest difference that
    /// the type makes.
    double writeValues(const DenseVolume& volume, SampleType type, VoxelOrder voxelOrder,
                       const WorkProgress& progress) {
        // From the slowest axis to the fastest.
        const std::array<std::size_t, 3> order = voxelOrder == VoxelOrder::XFastest
                                                     ? std::array<std::size_t, 3>{2, 1, 0}
                                                     : std::array<std::size_t, 3>{0, 1, 2};
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

}  // namespace

double writeDenseFile(const std::filesystem::path& file, const DenseVolume& volume,
                      const DenseFileLayout& layout, const WorkProgress& progress) {
    DenseFile out(file, layout.header, layout.packed);
    const double most = out.writeValues(volume, layout.type, layout.order, progress);
    out.commit();
    return most;
}

}  // namespace woodcock::convert
