// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace woodcock::mesh {

/// An element of a PLY file, such as its vertices or its faces.
struct PlyElement {
    struct Property {
        std::string name;
        bool isList = false;
        std::vector<double> values;  ///< one for each element; of lists, all of all elements
        std::vector<std::size_t>
            begins;  ///< of lists: where that of each element begins, and the end
        std::span<const double> list(std::size_t element) const {
            return std::span(values).subspan(begins[element],
                                             begins[element + 1] - begins[element]);
        }
    };
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;

    /// The first property that has one of these names; null for none.
    const Property* find(std::initializer_list<std::string_view> names) const;
};

/// Reads an ascii or binary PLY file, of either byte order. Sizes are checked against the file's
/// length before memory is taken. Errors: Input, with the place.
std::vector<PlyElement> readPly(const std::filesystem::path& file);

/// Whether there are faces among them. Errors: as of readPly().
bool plyHasFaces(const std::filesystem::path& file);

}  // namespace woodcock::mesh
