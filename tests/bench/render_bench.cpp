// SPDX-License-Identifier: Apache-2.0
// Whole renders of small scenes by one thread: samples of a pixel per second, the relative variance
// of one, and the cost: seconds x variance, the time to a given noise.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <filesystem>

#include "woodcock/base/error.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/load.h"
#include "woodcock/scene/scene_file.h"
#include "woodcock/trade/scaling_cloud.h"
#include "woodcock/trade/timing.h"

namespace {

using namespace woodcock;
using namespace woodcock::image;
using namespace woodcock::medium;
using namespace woodcock::scene;
using namespace woodcock::trade;

constexpr const char* glassText = R"(
[[material]]
name = "glass"
type = "dielectric"
ior = 1.5
[[surface]]
material = "glass"
sphere = { centre = [0, 1, 0], radius = 1 }
medium = { sigma_a = 0.2, sigma_s = 1 }
[[surface]]
plane = {}
[[light]]
type = "sphere"
position = [2, 4, 2]
radius = 0.8
radiance = 20
[[light]]
type = "environment"
radiance = 0.3
[camera]
eye = [0, 1.6, 6]
look_at = [0, 0.9, 0]
fov = 30
)";

render::Scene glass() {
    SceneDescription description = parseSceneText(glassText, "glass", ".", {});
    return buildScene(description, loadScene(description));
}

render::Scene chromatic(const ScalingCloud& cloud) {
    render::Scene scene = scalingScene(cloud, {.opticalDepth = 10});
    MediumPart::Description d = scene.medium.parts.front().description();
    d.scattering = d.scattering * Rgb(1.0f, 0.5f, 0.2f);
    scene.medium.parts = {MediumPart(d)};
    return scene;
}

/// Mean over the pixels of the variance of one sample, over the squared mean of the picture.
double relativeVariance(const Film& film) {
    double mean = 0, variance = 0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            const double error = film.standardError(x, y).mean();
            mean += film.radiance(x, y).mean();
            variance += error * error * static_cast<double>(film.at(x, y).samples);
        }
    const double pixels = film.width() * film.height();
    return variance / pixels / (mean / pixels * (mean / pixels));
}

void draw(benchmark::State& state, const render::Scene& scene) {
    render::RenderSettings settings;
    settings.width = settings.height = 32;
    settings.endSample = 16;
    settings.threads = 1;
    double samples = 0, variance = 0, seconds = 0;
    for (auto _ : state) {
        const double start = processorSeconds();
        const render::RenderResult result = render::render(scene, settings);
        seconds += processorSeconds() - start;
        state.PauseTiming();
        samples += static_cast<double>(result.counters.paths);
        variance += relativeVariance(result.film);
        ++settings.seed;
        state.ResumeTiming();
    }
    variance /= static_cast<double>(state.iterations());
    state.counters["samples/s"] = samples / seconds;
    state.counters["variance"] = variance;
    state.counters["cost"] = variance * seconds / samples;
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    try {
        const ScalingCloud cloud = bakeScalingCloud(128, std::filesystem::temp_directory_path(), 1);
        const std::vector<std::pair<std::string, render::Scene>> scenes{
            {"thin", scalingScene(cloud, {.opticalDepth = 0.5})},
            {"dense", scalingScene(cloud, {.opticalDepth = 100, .albedo = 1})},
            {"chromatic", chromatic(cloud)},
            {"overlap", scalingScene(cloud, {.volumes = 2})},
            {"glass", glass()}};
        for (const auto& [name, scene] : scenes)
            benchmark::RegisterBenchmark(name.c_str(), draw, scene)->Unit(benchmark::kMillisecond);
        benchmark::RunSpecifiedBenchmarks();
    } catch (const std::exception& e) {
        fmt::print(stderr, "render_bench: {}\n", e.what());
        return 1;
    }
    return 0;
}
