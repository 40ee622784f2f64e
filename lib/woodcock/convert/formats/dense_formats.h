// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/convert/dense_volume.h"

namespace woodcock::convert {

// Readers. Each throws Error{Input} that names the file, what was found and what was expected. A
// file's length is checked against its header before memory is taken.

/// The layout of a file of numbers without a header.
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

/// NumPy's archive of arrays, packed or not: all arrays of three or four dimensions, or the one
/// named `array`. They must have one size. Notes name the arrays that are left out.
std::vector<DenseVolume> readNpz(const std::filesystem::path& file,
                                 const std::optional<std::string>& array);

/// Mitsuba's grid volume (magic VOL, version 3): floats, as Mitsuba 3 has them, and the halves and
/// bytes (0 to 255 mean 0 to 1) of Mitsuba 0.6. The file's box is that of the cells, and values lie
/// at their centres, as in Mitsuba 3's gridvolume with use_grid_bbox. Where the box is empty, the
/// cells fill the unit cube, as in Mitsuba without it.
DenseVolume readMitsubaVolume(const std::filesystem::path& file);

/// The grids of one medium of a pbrt scene, of type uniformgrid or rgbgrid (heterogeneous in
/// pbrt-v3): every parameter with a value, or a colour, for each sample. p0 and p1 are the corners
/// of the box of the cells; values lie at their centres (pbrt-v4, SampledGrid::Lookup: the sample
/// at (i + 1/2) / n). `medium` names the medium, where there are several. Lengths are those of the
/// medium's own space. A note tells where the scene transforms it.
std::vector<DenseVolume> readPbrtGrids(const std::filesystem::path& file,
                                       const std::optional<std::string>& medium);

/// Nearly raw raster data (teem.sourceforge.net/nrrd/format.html), with its data attached, raw, as
/// text or by gzip: three axes, the first the fastest, and perhaps one for the channels. The space
/// origin is the centre of the first voxel.
DenseVolume readNrrd(const std::filesystem::path& file);

/// Pictures `slice.####.png` (or %04d) as slices along z, in the order of their numbers. The upper
/// right of a picture is at the greatest y and x. Integers are scaled to 0 to 1, floats stay.
/// Values are not converted as colours.
DenseVolume readImageStack(const std::filesystem::path& pattern, const WorkProgress& progress);
/// The same of files whose names differ in one number, and of the pages of one TIFF file.
DenseVolume readImageFiles(const std::vector<std::filesystem::path>& files,
                           const WorkProgress& progress);
DenseVolume readImagePages(const std::filesystem::path& file, const WorkProgress& progress);

/// True for a name with #### or %04d in it.
bool isImagePattern(const std::filesystem::path& file);

// Writers. They write little-endian numbers, the whole file or none. Integer types take the nearest
// number; a type that cannot hold a value is an error (Input). Each returns the largest difference
// between a value and the number written for it.

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
/// Floats only. Errors: Input where the volume is rotated or sheared, as the format has only a box.
double writeMitsubaVolume(const std::filesystem::path& file, const DenseVolume& volume,
                          const DenseWriteOptions& options);
double writeNrrd(const std::filesystem::path& file, const DenseVolume& volume,
                 const DenseWriteOptions& options);

}  // namespace woodcock::convert
