// SPDX-License-Identifier: Apache-2.0
// shows_something PICTURE: exit code 0 where it can be read and any of its pixels is brighter than
// a hundredth of white.
#include <algorithm>
#include <cstdio>
#include <exception>

#include "woodcock/image/read_image.h"

int main(int count, char** words) {
    if (count != 2) return 2;
    try {
        const woodcock::image::Image image = woodcock::image::readImage(words[1]);
        return *std::max_element(image.rgb.begin(), image.rgb.end()) > 0.01f ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
