// SPDX-License-Identifier: Apache-2.0
// pixel_digest IMAGE...: a line for each image, of the FNV-1a hash of all its channels' names and
// numbers, and its path. Two images with the same bits in every pixel have the same digest,
// whatever their headers say.
#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <exception>
#include <string_view>

#include "woodcock/image/read_layers.h"

namespace woodcock::test {

using namespace image;

namespace {

/// Fowler, Noll and Vo's FNV-1a of 64 bits.
class Digest {
public:
    void add(std::uint32_t word) {
        for (int byte = 0; byte < 4; ++byte) add(static_cast<unsigned char>(word >> (8 * byte)));
    }
    void add(std::string_view text) {
        for (const char c : text) add(static_cast<unsigned char>(c));
    }
    std::uint64_t value() const { return hash_; }

private:
    void add(unsigned char byte) { hash_ = (hash_ ^ byte) * 0x100000001b3; }
    std::uint64_t hash_ = 0xcbf29ce484222325;
};

std::uint64_t digestOf(const LayeredImage& image) {
    Digest digest;
    digest.add(static_cast<std::uint32_t>(image.width));
    digest.add(static_cast<std::uint32_t>(image.height));
    for (const ImagePlane& plane : image.planes) {
        digest.add(plane.name());
        for (const float value : plane.values) digest.add(std::bit_cast<std::uint32_t>(value));
    }
    return digest.value();
}

}  // namespace
}  // namespace woodcock::test

int main(int argc, char** argv) {
    try {
        for (int i = 1; i < argc; ++i)
            fmt::print("{:016x}  {}\n",
                       woodcock::test::digestOf(woodcock::image::readLayers(argv[i])), argv[i]);
        if (argc > 1) return 0;
        fmt::print(stderr, "usage: pixel_digest IMAGE...\n");
    } catch (const std::exception& e) {
        fmt::print(stderr, "pixel_digest: {}\n", e.what());
    }
    return 2;
}
