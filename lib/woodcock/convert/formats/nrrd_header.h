// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/base/error.h"
#include "woodcock/convert/dense_volume.h"
#include "woodcock/grid/vdb/file_bytes.h"

namespace woodcock::convert {

/// The header of a NRRD file: before its values, or in a file of its own.
struct NrrdHeader {
    std::filesystem::path file;
    std::map<std::string, std::string> fields;  ///< names in lower case, without spaces
    std::vector<std::string> listed;            ///< the lines below "data file: LIST"

    bool has(const std::string& name) const { return fields.contains(name); }
    const std::string& get(const std::string& name) const;  ///< Errors: Input where there is none
    /// The error where a field is not as expected.
    Error wrong(const std::string& name, const std::string& expected) const;
};

/// Reads up to the empty line before the data, or to the end where the data are in other files.
/// Errors: Input.
NrrdHeader readNrrdHeader(grid::FileBytes& file);

/// The words of a text, separated by spaces; a vector in parentheses is one word.
std::vector<std::string> nrrdWords(const std::string& text);

/// In lower case.
std::string nrrdLower(std::string text);

/// A whole number, perhaps with a minus. Errors: Input.
std::int64_t nrrdWhole(const NrrdHeader& header, const std::string& field, const std::string& word);

/// Which of the axes of the file is x (y and z follow), and which tells the channels apart.
struct NrrdAxes {
    std::vector<std::int64_t> sizes;
    std::vector<std::size_t> space;
    std::optional<std::size_t> channels;
    /// What the channels are where each is a volume of its own ("times"); empty: they belong
    /// together.
    std::string list;
    std::string note;  ///< what was assumed of axes without a kind
};

/// By the axes' kinds and directions. Errors: Input where they are not three of space, and at most
/// one other of a size above one.
NrrdAxes nrrdAxes(const NrrdHeader& header);

SampleType nrrdType(const NrrdHeader& header);

/// Sets the volume's place by directions or spacings, origin and space. The world is
/// right-anterior-superior (x to the right, y to the front, z up), as in NIfTI and 3D Slicer: other
/// orders, such as left-posterior-superior, are turned to it. Spaces without anatomy
/// (3D-right-handed, scanner-xyz) stay, and 3D-left-handed gets its z reversed.
void placeNrrd(DenseVolume& volume, const NrrdHeader& header, const NrrdAxes& axes);

}  // namespace woodcock::convert
