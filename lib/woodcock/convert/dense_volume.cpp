// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/dense_volume.h"

#include <bit>
#include <limits>

#include "woodcock/base/error.h"
#include "woodcock/grid/half.h"

namespace woodcock::convert {

namespace {

constexpr std::size_t axis(int i) { return static_cast<std::size_t>(i); }

/// decodeHalf() is for finite values.
float halfToFloat(std::uint16_t bits) {
    if ((bits & 0x7c00u) != 0x7c00u) return grid::decodeHalf(bits);
    return std::bit_cast<float>((bits & 0x8000u) << 16 | 0x7f800000u | (bits & 0x3ffu) << 13);
}

template <class Value, class Sample>
Value toValue(Sample sample) {
    if constexpr (std::is_same_v<Sample, HalfBits>)
        return static_cast<Value>(halfToFloat(sample.bits));
    else
        return static_cast<Value>(sample);
}

template <class Value>
void readBlockAs(const DenseVolume& volume, const Dims& begin, const Dims& size, Value* values) {
    withSampleType(volume.type, [&]<class Sample>(Sample) {
        const auto load = [&](std::int64_t at) {
            Sample sample;
            std::memcpy(&sample, volume.samples + at * std::int64_t{sizeof(Sample)}, sizeof sample);
            if (volume.swapped) sample = swapBytes(sample);
            const Value value = toValue<Value>(sample);
            return volume.unit == 1 ? value
                                    : static_cast<Value>(static_cast<double>(value) * volume.unit);
        };
        for (std::int64_t i = 0; i < size[0]; ++i)
            for (std::int64_t j = 0; j < size[1]; ++j) {
                std::int64_t at = volume.first + (begin[0] + i) * volume.stride[0] +
                                  (begin[1] + j) * volume.stride[1] + begin[2] * volume.stride[2];
                for (std::int64_t k = 0; k < size[2]; ++k, at += volume.stride[2])
                    for (int c = 0; c < volume.channels; ++c)
                        *values++ = load(at + c * volume.channelStride);
            }
    });
}

/// Swaps and reverses so that index axis a is the former axis order.from[a].
void renameIndexAxes(DenseVolume& volume, const AxisOrder& order) {
    const DenseVolume old = volume;
    for (std::size_t a = 0; a < 3; ++a) {
        const auto from = axis(order.from[a]);
        volume.dims[a] = old.dims[from];
        volume.stride[a] = old.stride[from];
        volume.worldFromIndex.column[a] = old.worldFromIndex.column[from];
        if (!order.reversed[a]) continue;
        const std::int64_t last = volume.dims[a] - 1;
        volume.first += last * volume.stride[a];
        volume.stride[a] = -volume.stride[a];
        Vec3d& column = volume.worldFromIndex.column[a];
        volume.worldFromIndex.translation += column * static_cast<double>(last);
        column = -column;
    }
    // Avoids -0, which files would show.
    for (Vec3d& column : volume.worldFromIndex.column)
        for (int i = 0; i < 3; ++i) column[i] += 0.0;
}

}  // namespace

std::string DenseVolume::describe() const {
    return fmt::format("{} x {} x {} voxels of {}{}", dims[0], dims[1], dims[2],
                       channels == 1 ? "" : fmt::format("{} x ", channels), sampleTypeName(type));
}

void DenseVolume::setStridesXFirst() {
    stride = {channels, channels * dims[0], channels * dims[0] * dims[1]};
    channelStride = 1;
    first = 0;
}

void DenseVolume::setStridesZFirst() {
    stride = {channels * dims[2] * dims[1], channels * dims[2], channels};
    channelStride = 1;
    first = 0;
}

std::optional<std::uint64_t> denseBytes(const Dims& dims, int channels, SampleType type) {
    if (channels < 1) return {};
    std::uint64_t bytes = sampleBytes(type) * static_cast<std::uint64_t>(channels);
    for (const std::int64_t n : dims)
        if (n < 1 || n > mostVoxelsOfSide ||
            __builtin_mul_overflow(bytes, static_cast<std::uint64_t>(n), &bytes))
            return {};
    if (bytes > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return {};
    return bytes;
}

void readBlock(const DenseVolume& volume, const Dims& begin, const Dims& size, float* values) {
    readBlockAs(volume, begin, size, values);
}

void readBlock(const DenseVolume& volume, const Dims& begin, const Dims& size, double* values) {
    readBlockAs(volume, begin, size, values);
}

void setVoxelSides(DenseVolume& volume, Vec3d sides) {
    for (int a = 0; a < 3; ++a) {
        Vec3d& column = volume.worldFromIndex.column[axis(a)];
        column = column * (sides[a] / length(column));
    }
}

void fillUnitCube(DenseVolume& volume) {
    Vec3d sides;
    for (int a = 0; a < 3; ++a) sides[a] = 1 / static_cast<double>(volume.dims[axis(a)]);
    volume.worldFromIndex = Affine3d::translate(sides * 0.5) * Affine3d::scale(sides);
}

DenseVolume selectChannel(DenseVolume volume, int channel) {
    if (channel < 0 || channel >= volume.channels)
        throw usageError("there is no channel {} in '{}'; it has {}, numbered from 0", channel,
                         volume.name, volume.channels);
    volume.first += channel * volume.channelStride;
    volume.channels = 1;
    return volume;
}

Affine3d AxisOrder::map() const {
    Affine3d map;
    map.column = {};
    for (int to = 0; to < 3; ++to)
        map.column[axis(from[axis(to)])][to] = reversed[axis(to)] ? -1 : 1;
    return map;
}

AxisOrder parseAxisOrder(std::string_view text) {
    AxisOrder order;
    std::size_t found = 0;
    bool minus = false, wrong = text.empty();
    std::array<bool, 3> seen{};
    for (const char letter : text) {
        if (letter == ',' || (letter == '+' && !minus)) continue;
        if (letter == '-' && !minus) {
            minus = true;
            continue;
        }
        const int from = (letter | 0x20) - 'x';
        if (from < 0 || from > 2 || found == 3 || seen[axis(from)]) {
            wrong = true;
            break;
        }
        seen[axis(from)] = true;
        order.from[found] = from;
        order.reversed[found++] = minus;
        minus = false;
    }
    if (wrong || found != 3 || minus)
        throw usageError(
            "'{}' is not an order of axes; expected each of x, y and z once, with a minus to "
            "reverse one, such as xzy or x,-z,y",
            text);
    return order;
}

void applyAxisOrder(DenseVolume& volume, const AxisOrder& axes) {
    if (axes.identity()) return;
    volume.worldFromIndex = axes.map() * volume.worldFromIndex;
    straighten(volume);
    // A volume that the file does not place begins at the world's origin, however it is turned.
    if (!volume.placed) volume.worldFromIndex.translation = {};
}

void straighten(DenseVolume& volume) {
    AxisOrder order;
    for (int to = 0; to < 3; ++to) {
        int axesAlong = 0;
        for (int from = 0; from < 3; ++from) {
            const Vec3d& column = volume.worldFromIndex.column[axis(from)];
            if (column[to] == 0) continue;
            if (column[(to + 1) % 3] != 0 || column[(to + 2) % 3] != 0) return;
            order.from[axis(to)] = from;
            order.reversed[axis(to)] = column[to] < 0;
            ++axesAlong;
        }
        if (axesAlong != 1) return;
    }
    renameIndexAxes(volume, order);
}

}  // namespace woodcock::convert
