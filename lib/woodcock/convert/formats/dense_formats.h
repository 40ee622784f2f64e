// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/convert/dense_volume.h"

namespace woodcock {

// Readers. Each throws Error{Input} that names the file, what was found and what was expected; a
// file's length is held against what its header promises before memory is taken.

/// A file of nothing but numbers, which says nothing of itself.
struct RawLayout {
    Dims dims{};
    int channels = 1;  ///< interleaved
    SampleType type = SampleType::F32;
    bool bigEndian = false;
    std::uint64_t headerBytes = 0;  ///< skipped
};

/// x varies fastest in the file, then y, then z.
DenseVolume readRaw(const std::filesystem::path& file, const RawLayout& layout);

/// NumPy's format, versions 1 to 3, in C or Fortran order: array[x, y, z], as OpenVDB's own Python
/// module has it, or array[x, y, z, channel]. Integers, halves, floats, doubles and booleans.
DenseVolume readNpy(const std::filesystem::path& file);

/// NumPy's archive of arrays, packed or not: each of three or four dimensions, or the one named
/// `array`. They are of one size; notes name the others.
std::vector<DenseVolume> readNpz(const std::filesystem::path& file,
                                 const std::optional<std::string>& array);

/// Mitsuba's grid volume (magic VOL, version 3): floats, as Mitsuba 3 has them, and the halves and
/// bytes (0 to 255 mean 0 to 1) of Mitsuba 0.6. The box in the file is that of the cells, whose
/// centres have the values: so Mitsuba 3's gridvolume sees it with use_grid_bbox. Where the box is
/// empty or none, the cells fill the unit cube, as they do without that.
DenseVolume readMitsubaVolume(const std::filesystem::path& file);

/// The grids of one medium of a pbrt scene, of type uniformgrid or rgbgrid (heterogeneous in
/// pbrt-v3): every parameter with a value, or a colour, for each sample. p0 and p1 are the corners
/// of the box of the cells, whose centres have the values (pbrt-v4, SampledGrid::Lookup: the sample
/// at (i + 1/2) / n). `medium` chooses by name, where there are several. Lengths are those of the
/// medium's own space: a note says where the scene transforms it.
std::vector<DenseVolume> readPbrtGrids(const std::filesystem::path& file,
                                       const std::optional<std::string>& medium);

/// Nearly raw raster data (teem.sourceforge.net/nrrd/format.html), with its data attached, raw, as
/// text or by gzip: three axes, the first the fastest, and perhaps one for the channels. The space
/// origin is the centre of the first voxel.
DenseVolume readNrrd(const std::filesystem::path& file);

/// Pictures `slice.####.png` (or %04d) as slices along z, in the order of their numbers. The upper
/// right of a picture is at the greatest y and x. The numbers of bytes are 0 to 1, floats are as
/// they are; nothing is taken for a colour.
DenseVolume readImageStack(const std::filesystem::path& pattern, const WorkProgress& progress);
/// The same of files whose names differ in one number, and of the pages of one TIFF file.
DenseVolume readImageFiles(const std::vector<std::filesystem::path>& files,
                           const WorkProgress& progress);
DenseVolume readImagePages(const std::filesystem::path& file, const WorkProgress& progress);

/// True for a name with #### or %04d in it.
bool isImagePattern(const std::filesystem::path& file);

// Writers: little endian, the whole file or none. A type that cannot hold a value is an error
// (Input); integers take the nearest number. Each returns how far a written number is from its
// value at most.

struct DenseWriteOptions {
    std::optional<SampleType> type{};  ///< as in the volume where absent
    bool packed = false;               ///< by gzip, where the format can be
    WorkProgress progress{};
};

double writeRaw(const std::filesystem::path& file, const DenseVolume& volume,
                const DenseWriteOptions& options);
/// In C order: array[x, y, z], or array[x, y, z, channel].
double writeNpy(const std::filesystem::path& file, const DenseVolume& volume,
                const DenseWriteOptions& options);
/// Floats only. Errors: Input where the volume is rotated or sheared, as the format has but a box.
double writeMitsubaVolume(const std::filesystem::path& file, const DenseVolume& volume,
                          const DenseWriteOptions& options);
double writeNrrd(const std::filesystem::path& file, const DenseVolume& volume,
                 const DenseWriteOptions& options);

}  // namespace woodcock
