// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/checks/measure.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/random.h"
#include "woodcock/proof/support/read_back.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::proof {

double Precision::of(double value) const { return std::max(floor, relative * std::abs(value)); }

Precision usualPrecision(const Lab& lab) {
    return lab.full() ? Precision{5e-4, 5e-6} : Precision{1e-2, 1e-4};
}

Precision dearPrecision(const Lab& lab) {
    return lab.full() ? Precision{2e-3, 2e-5} : usualPrecision(lab);
}

render::Scene sceneIn(const Lab& lab, const std::string& text) {
    return sceneFrom(text, lab.directory());
}

image::Film evenFilm(const Lab& lab, const std::string& name, const render::Scene& scene,
                     Picture picture, const std::function<double(const image::Film&)>& excess) {
    constexpr int side = 32, mostRounds = 4;
    constexpr double most = 1 << 20, margin = 1.3;  // a measured variance is a guess, too
    picture.width = picture.height = side;
    picture.samples = lab.pick(4, 16);
    for (int round = 0;; ++round) {
        picture.seed = hashOf(lab.seed(name), round);
        image::Film film = renderScene(scene, picture).film;
        const double ratio = excess(film);
        // Below 1, as a relative error is one of the measured mean, which may be above the truth.
        if (round > 0 && (ratio <= 0.95 || round == mostRounds)) return film;
        picture.samples = static_cast<int>(
            std::clamp(margin * picture.samples * ratio * ratio, 1.0 * picture.samples, most));
    }
}

RgbEstimate evenPicture(const Lab& lab, const std::string& name, const render::Scene& scene,
                        const Precision& precision, std::vector<int> channels,
                        std::optional<int> maxScatterings) {
    Picture picture;
    picture.maxScatterings = maxScatterings;
    return evenRadiance(evenFilm(lab, name, scene, picture, [&](const image::Film& film) {
        const RgbEstimate pilot = evenRadiance(film);
        double ratio = 0;
        for (const int c : channels) {
            const Estimate& e = pilot[static_cast<std::size_t>(c)];
            ratio = std::max(ratio, e.error / precision.of(e.mean));
        }
        return ratio;
    }));
}

Case caseOf(std::string name, double expected, Estimate measured, const Precision& precision) {
    return {.name = std::move(name),
            .expected = expected,
            .measured = measured.mean,
            .standardError = measured.error,
            .largestError = precision.of(expected),
            .allowance = 2e-6 * std::abs(expected)};
}

void writeTwoColouredSky(const Lab& lab) {
    constexpr int rows = 2048, columns = 4;
    std::vector<float> rgb;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            for (const float v : {y < rows / 2 ? 1.0f : 0.0f, 0.0f, y < rows / 2 ? 0.0f : 1.0f})
                rgb.push_back(v);
    writeFloats(lab.file("sky.exr"), columns, rows, 3, rgb);
}

void writeSlab(const Lab& lab, const std::string& file, const std::vector<double>& weights,
               double width) {
    double sum = 0;
    for (const double w : weights) sum += w;
    GridSpec grid;
    grid.box = {{0, 0, 0}, {15, static_cast<int>(weights.size()) - 1, 15}};
    grid.value = [=](Vec3i p) { return weights[static_cast<std::size_t>(p.y)] / sum; };
    grid.worldFromIndex =
        Affine3d::translate({-7.5 * width, 0, -7.5 * width}) * Affine3d::scale({width, 1, width});
    writeVdb(lab.file(file), {grid});
}

std::string cameraAbove(double mu) {
    return pencilCamera({0, 50, 0}, {std::sqrt((1 - mu) * (1 + mu)), -mu, 0});
}

}  // namespace woodcock::proof
