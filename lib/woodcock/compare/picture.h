// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace woodcock::compare {

/// A channel of one image of a comparison.
struct ComparedPlane {
    std::string name;                ///< "R", "transmittance.R", "Z"
    std::vector<float> values;       ///< row by row from the top left; mean over the image's seeds
    std::vector<float> errors;       ///< standard error of each value; empty: unknown
    std::vector<float> roundings{};  ///< of what was an integer, as ImagePlane has them

    /// True for distances, in which renderers write "nothing" as a huge number.
    bool isDepth() const { return name == "Z" || name.ends_with(".Z"); }
};

/// One image of a comparison: a file, or the mean of several that differ in their seed only.
struct Picture {
    std::string letter;  ///< A for the first
    std::vector<std::filesystem::path> files;
    int width = 0, height = 0;  ///< of what is compared
    int x0 = 0, y0 = 0;         ///< where that lies in the whole image
    std::vector<ComparedPlane> planes;
    double resolution = 0;  ///< of the numbers, relative to them
    /// Degrees of freedom of each standard error.
    double errorDegrees = std::numeric_limits<double>::infinity();
    /// Factor of the variance of a mean over a tile, as pixels share noise.
    double sharedNoise = 1;
    std::string errorsFrom;    ///< their source, for the report; empty: there are none
    std::string madeBy, seed;  ///< as headers have it; empty: unknown
    std::optional<double> samples, seconds;  ///< sums over the files

    std::size_t pixels() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    const ComparedPlane* find(const std::string& name) const {
        for (const ComparedPlane& plane : planes)
            if (plane.name == name) return &plane;
        return nullptr;
    }
};

}  // namespace woodcock::compare
