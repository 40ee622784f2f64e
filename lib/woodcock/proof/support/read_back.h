// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace woodcock::proof {

/// An image file as another program sees it: through OpenImageIO, none of our code.
struct ReadBack {
    int x = 0, y = 0, width = 0, height = 0;  ///< data window
    int fullWidth = 0, fullHeight = 0;        ///< display window
    std::vector<std::string> channels;
    std::map<std::string, std::string> types;       ///< by channel: uint8, half, float
    std::map<std::string, std::string> attributes;  ///< as text
    std::vector<float> values;                      ///< channels innermost; bytes as 0 to 255

    bool has(const std::string& channel) const;
    /// `x` and `y` in the display window.
    float at(int x, int y, const std::string& channel) const;
};

/// Of a file of several parts, the one of this number; throws std::out_of_range beyond the last.
ReadBack readBack(const std::filesystem::path& file, int part = 0);

/// Writes a float image, for tests of readers: TIFF, EXR, or whatever the extension says.
void writeFloats(const std::filesystem::path& file, int width, int height, int channels,
                 const std::vector<float>& values);

}  // namespace woodcock::proof
