// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/convert/convert.h"

namespace woodcock::grid {
struct VdbGrids;
}

namespace woodcock::convert {

struct Source;

/// Reads a file and makes grids of it, as the options say.
using ReadSource = std::function<Source(const std::filesystem::path&, const ConvertOptions&)>;

using WriteGrids = void (*)(const std::filesystem::path& in, const std::filesystem::path& out,
                            grid::VdbGrids&, const ConvertOptions&);

/// Writes one volume on a regular lattice, and what the format can hold.
struct DenseWriter {
    double (*write)(const std::filesystem::path&, const DenseVolume&,
                    const DenseWriteOptions&) = nullptr;
    bool halves = true;                    ///< numbers of type f16
    bool packs = false;                    ///< --compression zip
    std::optional<SampleType> onlyType{};  ///< where the format has one type of numbers
};

/// The options that some inputs take and others would ignore.
struct InputOptions {
    bool layout = false;   ///< --dims, --type, --channels, --endian, --header
    bool grid = false;     ///< --grid
    bool band = false;     ///< --band
    bool radius = false;   ///< --radius
    bool shell = false;    ///< --shell
    bool columns = false;  ///< --columns
};

/// One row of the table of formats. A new format is one file in convert/formats, its declaration
/// and one row.
struct Format {
    std::string name;
    std::vector<std::string> extensions;  ///< in lower case, with the dot
    std::string what;
    ReadSource read;
    DenseWriter dense{};
    WriteGrids writeGrids = nullptr;
    InputOptions takes{};

    bool written() const { return dense.write || writeGrids; }
};

/// All formats, in the order in which the help lists them. The last one is that of slices.
const std::vector<Format>& formats();

/// The format of an input: the one of --from, else by its name and its first bytes. Errors: Usage
/// for an unknown --from; Input where the name tells no format, or the content is of one that is
/// not read.
const Format& inputFormat(const std::filesystem::path& in, const ConvertOptions& options);

/// The format of an output, by its name. Errors: Usage where it cannot be written.
const Format& outputFormat(const std::filesystem::path& out);

/// True where the name ends as that of a picture does.
bool isPicture(const std::filesystem::path& file);

}  // namespace woodcock::convert
