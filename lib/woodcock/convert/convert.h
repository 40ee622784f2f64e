// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "woodcock/convert/dense_to_vdb.h"
#include "woodcock/convert/formats/dense_formats.h"
#include "woodcock/grid/vdb/write.h"

namespace woodcock::convert {

/// The placement of voxels that a file does not place, or places wrongly.
struct Placement {
    std::optional<double> voxel;  ///< the shortest side of a voxel, world units
    std::optional<double> size;   ///< the longest side of the volume, outer faces of its cells
    /// The three sides of a voxel or of the volume, along the axes of the file.
    std::optional<Vec3d> voxelSides, sizeSides;
    std::optional<Vec3d> origin;  ///< the centre of the first voxel

    bool sized() const { return voxel || size || voxelSides || sizeSides; }
    bool any() const { return sized() || origin; }
};

struct ConvertOptions {
    std::optional<std::string> from;  ///< format of the input; absent: by its name
    std::optional<std::string> grid;  ///< the grid of a VDB or .npz, or the medium of a pbrt scene
    std::optional<std::string> name;  ///< of the grid that is made

    // Of files of numbers without a header.
    std::optional<Dims> dims;
    std::optional<SampleType> type;
    std::optional<int> channels;
    std::optional<bool> bigEndian;
    std::optional<std::uint64_t> headerBytes;

    // Of meshes, points and level sets.
    std::optional<double> band;          ///< depth at which density reaches one, world units
    std::optional<double> radius;        ///< of points that have none of their own
    std::optional<std::string> columns;  ///< of a table of points: "x,y,z,radius"
    bool shell = false;                  ///< fog around a mesh's surface instead of inside it

    std::optional<int> channel;  ///< the channel that is taken; absent: all
    AxisOrder axes;
    Placement placement;
    ValueOptions values;

    Precision precision = Precision::Source;
    std::optional<grid::VdbCompression> compression;  ///< absent: what is usual in the format
    std::optional<SampleType> outputType;             ///< of dense formats
    std::optional<Box3i> bounds;                      ///< voxels that are written to dense formats

    std::function<void(const std::string&)> info, warn;
    /// Called with the stage in a word, and the fraction of it that is done. If it throws, the work
    /// ends.
    std::function<void(std::string_view stage, double fraction)> progress;
};

/// Reads any known format and writes VDB, NanoVDB or a dense format. Nothing is written in case of
/// an error. Errors: Usage for unknown formats and options that do not fit them, Input for faults
/// of the file, Failure where the output cannot be written.
void convert(const std::filesystem::path& in, const std::filesystem::path& out,
             const ConvertOptions& options);

/// The same for several pictures that are slices of one volume; their names differ in a number.
void convert(const std::vector<std::filesystem::path>& in, const std::filesystem::path& out,
             const ConvertOptions& options);

/// A line for each format: name, extensions, read and written.
std::string describeFormats();

}  // namespace woodcock::convert
