// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "woodcock/compare/load_pictures.h"

namespace woodcock::test {

/// A picture whose channels hold `value(x, y)`.
inline compare::Picture picture(int width, int height, const std::vector<std::string>& channels,
                                const std::function<double(int x, int y)>& value) {
    compare::Picture p;
    p.width = width, p.height = height;
    p.files = {"made.exr"};
    for (const std::string& name : channels) {
        compare::ComparedPlane plane{name, {}, {}, {}};
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) plane.values.push_back(static_cast<float>(value(x, y)));
        p.planes.push_back(std::move(plane));
    }
    return p;
}

/// Normal noise of this standard deviation at each pixel; `known` says so in the errors.
inline compare::Picture noisy(compare::Picture p,
                              const std::function<double(int x, int y)>& deviation, bool known,
                              std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    for (compare::ComparedPlane& plane : p.planes)
        for (std::size_t i = 0; i < plane.values.size(); ++i) {
            const auto width = static_cast<std::size_t>(p.width);
            const double d = deviation(static_cast<int>(i % width), static_cast<int>(i / width));
            plane.values[i] += static_cast<float>(d * normal(random));
            if (known) plane.errors.push_back(static_cast<float>(d));
        }
    return p;
}

/// The mean of `seeds` such pictures with the errors of their scatter, as loadPictures() makes it.
inline compare::Picture meanOfSeeds(const compare::Picture& p,
                                    const std::function<double(int x, int y)>& deviation, int seeds,
                                    std::mt19937_64& random) {
    compare::Picture mean = p;
    std::vector<compare::Picture> all;
    for (int i = 0; i < seeds; ++i) all.push_back(noisy(p, deviation, false, random));
    for (std::size_t c = 0; c < p.planes.size(); ++c) {
        compare::ComparedPlane& plane = mean.planes[c];
        plane.errors.resize(plane.values.size());
        for (std::size_t i = 0; i < plane.values.size(); ++i) {
            double sum = 0, squares = 0;
            for (const compare::Picture& one : all) sum += one.planes[c].values[i];
            for (const compare::Picture& one : all)
                squares += std::pow(one.planes[c].values[i] - sum / seeds, 2);
            plane.values[i] = static_cast<float>(sum / seeds);
            plane.errors[i] = static_cast<float>(std::sqrt(squares / (seeds - 1) / seeds));
        }
    }
    mean.errorDegrees = seeds - 1;
    return mean;
}

/// A first picture, the reference, and one to hold against it.
inline compare::LoadedPictures both(compare::Picture a, compare::Picture b) {
    a.letter = "A", b.letter = "B";
    return {{std::move(a), std::move(b)}, {}};
}

}  // namespace woodcock::test
