// SPDX-License-Identifier: Apache-2.0
// mean_ratio A1 A2 B1 B2: how the means of two pictures compare, each drawn twice with different
// seeds: B / A for red, green and blue, its standard errors, and a verdict. Exit code 1: they
// differ by more than 4 standard errors or 0.3 %.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <exception>

#include "woodcock/proof/support/read_back.h"

namespace woodcock::test {

using namespace proof;

namespace {

struct Mean {
    double value = 0, error = 0;
};

/// Of both pictures; their difference in each pixel tells the error.
Mean meanOf(const ReadBack& first, const ReadBack& second, const std::string& channel) {
    double sum = 0, squares = 0;
    for (int y = 0; y < first.height; ++y)
        for (int x = 0; x < first.width; ++x) {
            const double a = first.at(x, y, channel), b = second.at(x, y, channel);
            sum += (a + b) / 2, squares += (a - b) * (a - b) / 4;
        }
    const double pixels = double(first.width) * first.height;
    return {sum / pixels, std::sqrt(squares) / pixels};
}

int run(char** files) {
    std::array<ReadBack, 4> images;
    for (std::size_t i = 0; i < 4; ++i) images[i] = readBack(files[i]);
    std::string ratios, errors;
    bool same = true;
    for (const char* channel : {"R", "G", "B"}) {
        const Mean a = meanOf(images[0], images[1], channel);
        const Mean b = meanOf(images[2], images[3], channel);
        const double ratio = b.value / a.value;
        const double error = ratio * std::hypot(a.error / a.value, b.error / b.value);
        ratios += fmt::format("{:8.5f} ", ratio);
        errors += fmt::format("{:.5f} ", error);
        same &= std::abs(ratio - 1) <= 4 * error && std::abs(ratio - 1) <= 0.003;
    }
    fmt::print("{} {} {}\n", ratios, errors, same ? "same" : "differs");
    return same ? 0 : 1;
}

}  // namespace
}  // namespace woodcock::test

int main(int argc, char** argv) {
    try {
        if (argc == 5) return woodcock::test::run(argv + 1);
        fmt::print(stderr, "usage: mean_ratio A1 A2 B1 B2\n");
    } catch (const std::exception& e) {
        fmt::print(stderr, "mean_ratio: {}\n", e.what());
    }
    return 2;
}
