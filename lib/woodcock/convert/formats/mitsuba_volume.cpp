// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "woodcock/base/printable.h"
#include "woodcock/convert/formats/dense_file.h"
#include "woodcock/convert/formats/dense_formats.h"
#include "woodcock/convert/formats/source_bytes.h"

namespace woodcock::convert {

namespace {

constexpr std::uint64_t headerBytes = 48;

template <class T>
T littleEndian(grid::FileBytes& file) {
    const T value = file.value<T>();
    return std::endian::native == std::endian::little ? value : swapBytes(value);
}

SampleType typeOf(std::int32_t encoding, const std::filesystem::path& file) {
    switch (encoding) {
        case 1:
            return SampleType::F32;
        case 2:
            return SampleType::F16;
        case 3:
            return SampleType::U8;
        default:
            throw inputError(
                "{}: its values have encoding {}; known: 1 (float), 2 (half), 3 (byte)",
                file.string(), encoding);
    }
}

/// Mitsuba ignores the box and fills the unit cube unless `use_grid_bbox` is set. So some writers
/// leave the box empty, and others write integers there, which are tiny numbers as floats.
void placeInBox(DenseVolume& volume, Vec3d lower, Vec3d upper, const std::filesystem::path& file) {
    constexpr double least = 1e-30;
    bool usable = isFinite(lower) && isFinite(upper);
    for (int i = 0; i < 3; ++i) usable = usable && upper[i] - lower[i] > least;
    if (!usable) {
        volume.unitCube = true;
        fillUnitCube(volume);
        volume.notes.push_back(
            fmt::format("{}: its box, from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}), "
                        "is empty or not a box. The volume fills the unit cube, as in Mitsuba "
                        "without use_grid_bbox, unless --voxel, --size or --origin place it",
                        file.string(), lower.x, lower.y, lower.z, upper.x, upper.y, upper.z));
        return;
    }
    Vec3d voxel;
    for (int i = 0; i < 3; ++i)
        voxel[i] = (upper[i] - lower[i]) / static_cast<double>(volume.dims[static_cast<size_t>(i)]);
    volume.worldFromIndex = Affine3d::translate(lower + voxel * 0.5) * Affine3d::scale(voxel);
    volume.placed = true;
}

}  // namespace

DenseVolume readMitsubaVolume(const std::filesystem::path& file) {
    auto bytes = std::make_shared<grid::FileBytes>(file, "a Mitsuba volume");
    const std::span<const char> magic = bytes->bytes(3);
    if (std::string_view(magic.data(), 3) != "VOL")
        throw inputError("{} is not a Mitsuba volume: it begins with '{}' instead of 'VOL'",
                         file.string(), printable(std::string(magic.data(), 3)));
    if (const int version = bytes->value<unsigned char>(); version != 3)
        throw inputError("{}: Mitsuba volume of version {}; known: 3", file.string(), version);
    DenseVolume volume;
    volume.type = typeOf(littleEndian<std::int32_t>(*bytes), file);
    if (volume.type == SampleType::U8) volume.unit = 1 / 255.0;
    volume.swapped = std::endian::native == std::endian::big;
    for (std::int64_t& n : volume.dims) n = littleEndian<std::int32_t>(*bytes);
    volume.channels = littleEndian<std::int32_t>(*bytes);
    requireDims(volume, file);
    Vec3d lower, upper;
    for (int i = 0; i < 3; ++i) lower[i] = static_cast<double>(littleEndian<float>(*bytes));
    for (int i = 0; i < 3; ++i) upper[i] = static_cast<double>(littleEndian<float>(*bytes));
    placeInBox(volume, lower, upper, file);
    loadSamples(volume, std::move(bytes), headerBytes);
    volume.setStridesXFirst();
    return volume;
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
            "only a box along the axes; .nrrd keeps any transform",
            file.string(), volume.name);
    std::string header("VOL\x03", 4);
    appendLittleEndian(header, std::int32_t{1});
    for (const std::int64_t n : volume.dims)
        appendLittleEndian(header, static_cast<std::int32_t>(n));
    appendLittleEndian(header, std::int32_t{volume.channels});
    for (const double corner : {-0.5, 0.5})
        for (int i = 0; i < 3; ++i) {
            const double cell =
                corner < 0 ? corner
                           : static_cast<double>(volume.dims[static_cast<std::size_t>(i)]) - corner;
            appendLittleEndian(header, static_cast<float>(map.translation[i] + cell * voxel[i]));
        }
    return writeDenseFile(file, volume, {.header = header, .type = SampleType::F32},
                          options.progress);
}

}  // namespace woodcock::convert
