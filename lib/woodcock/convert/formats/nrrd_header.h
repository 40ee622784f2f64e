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

namespace woodcock {

/// The text before the values of a NRRD file, or beside them.
struct NrrdHeader {
    std::filesystem::path file;
    std::map<std::string, std::string> fields;  ///< names in lower case, without spaces
    std::vector<std::string> listed;            ///< the lines below "data file: LIST"

    bool has(const std::string& name) const { return fields.contains(name); }
    const std::string& get(const std::string& name) const;  ///< Errors: Input where there is none
    /// What the field is, where it is not what is expected.
    Error wrong(const std::string& name, const std::string& expected) const;
};

/// Reads up to the empty line before the data, or to the end where the data are in other files.
/// Errors: Input.
NrrdHeader readNrrdHeader(FileBytes& file);

/// Words apart by spaces; a vector in parentheses is one.
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
    std::string note;  ///< what was assumed of axes that say nothing
};

/// By the axes' kinds and directions. Errors: Input where they are not three of space, and at most
/// one other of a size above one.
NrrdAxes nrrdAxes(const NrrdHeader& header);

SampleType nrrdType(const NrrdHeader& header);

/// Sets the volume's place by directions or spacings, origin and space. The world is
/// right-anterior-superior (x to the right, y to the front, z up), as in NIfTI and 3D Slicer: what
/// is said in another order, such as left-posterior-superior, is turned to it. Spaces of no body
/// (3D-right-handed, scanner-xyz) stay as they are, and 3D-left-handed has its z reversed.
void placeNrrd(DenseVolume& volume, const NrrdHeader& header, const NrrdAxes& axes);

}  // namespace woodcock
