// SPDX-License-Identifier: Apache-2.0
// What adaptive samples are worth: for each scene file that is named, error and processor time of
// even and of adaptive renders in turns, against many even samples.
//     adaptive_bench [--spp 64] [--seeds 4] [--reference 4096] [--width 120] SCENE...
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "woodcock/base/error.h"
#include "woodcock/base/statistics.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/load.h"
#include "woodcock/scene/scene_file.h"
#include "woodcock/trade/timing.h"

namespace {

using namespace woodcock;
using namespace woodcock::image;
using namespace woodcock::scene;
using namespace woodcock::trade;

struct Options {
    int spp = 64, seeds = 4, reference = 4096, width = 120;
};

/// Squared errors, in means over the picture.
struct Errors {
    double noise = 0;     ///< as Film::noise() weighs them
    double relative = 0;  ///< relMSE of all pixels, its epsilon a hundredth of the mean
    double absolute = 0;
};

class Truth {
public:
    explicit Truth(Film film) : film_(std::move(film)) {
        double covered = 0, light = 0;
        each([&](int x, int y) {
            covered += film_.foreground(x, y).coverage, light += film_.foreground(x, y).radiance;
            picture_ += film_.radiance(x, y).mean();
        });
        picture_ /= film_.width() * film_.height();
        mean_ = covered > 0 ? light / covered : 0;
    }

    /// The reference's own noise is taken off.
    Errors errorsOf(const Film& film) const {
        Errors sum;
        double weights = 0, pixels = 0;
        each([&](int x, int y) {
            const Rgb a = film.radiance(x, y), b = film_.radiance(x, y);
            const Rgb known = film_.variance(x, y);
            double square = 0, relative = 0;
            for (int c = 0; c < 3; ++c) {
                const double e = std::pow(double{a[c]} - double{b[c]}, 2) - double{known[c]};
                square += e / 3;
                relative += e / (double{b[c]} * double{b[c]} + 1e-4 * picture_ * picture_) / 3;
            }
            const Film::Foreground f = film_.foreground(x, y);
            const double coverage = std::min(1.0, f.coverage);
            const double seen = std::hypot(f.radiance + (1 - coverage) * mean_, 0.1 * mean_);
            const double weight = std::max(f.alpha, std::min(coverage, f.radiance / mean_));
            if (weight > 0) sum.noise += weight * square / (seen * seen), weights += weight;
            sum.relative += relative, sum.absolute += square, ++pixels;
        });
        return {sum.noise / weights, sum.relative / pixels, sum.absolute / pixels};
    }

private:
    template <class F>
    void each(const F& f) const {
        for (int y = 0; y < film_.height(); ++y)
            for (int x = 0; x < film_.width(); ++x) f(x, y);
    }
    Film film_;
    double mean_ = 0, picture_ = 0;
};

/// Of even and adaptive renders.
struct Runs {
    Moments noise, relative, absolute, told, cpu, samples, events;
};

/// Per pixel, of all its samples.
double eventsOf(const Film& film) {
    double events = 0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) events += film.at(x, y).events;
    return events / film.width() / film.height();
}

/// Time of an event in times of a path without any, as both runs tell it together.
double costOfAnEvent(const Runs& even, const Runs& adaptive) {
    const double p = even.samples.mean(), q = adaptive.samples.mean();
    const double e = even.events.mean(), f = adaptive.events.mean();
    const double s = even.cpu.mean(), t = adaptive.cpu.mean();
    return (p * t - q * s) / (f * s - e * t);
}

std::string ratio(const Moments& even, const Moments& adaptive, double time) {
    const auto share = [](const Moments& m) { return m.standardError() / m.mean(); };
    return fmt::format(
        "{:.2f} +- {:.2f}", even.mean() / adaptive.mean() / time,
        even.mean() / adaptive.mean() / time * std::hypot(share(even), share(adaptive)));
}

void measure(const std::string& file, const Options& o) {
    SceneDescription description = parseScene(file);
    LoadedScene loaded = loadScene(description);
    completeScene(description, loaded);
    const render::Scene scene = buildScene(description, std::move(loaded));
    render::RenderSettings s = renderSettings(description.render);
    s.height = std::max(1, s.height * o.width / s.width), s.width = o.width;
    s.timeLimit = s.noise = 0;
    s.adaptive = false, s.endSample = o.reference, s.seed = 1000;
    const Truth truth(render::render(scene, s).film);
    s.endSample = o.spp;
    Runs runs[2];
    for (int seed = 0; seed < o.seeds; ++seed)
        for (const bool adaptive : {false, true}) {
            s.adaptive = adaptive, s.seed = static_cast<std::uint64_t>(seed);
            const double start = processorSeconds();
            const Film film = render::render(scene, s).film;
            Runs& r = runs[adaptive];
            r.cpu.add(processorSeconds() - start);
            const Errors e = truth.errorsOf(film);
            r.noise.add(e.noise), r.relative.add(e.relative), r.absolute.add(e.absolute);
            r.told.add(film.noise()), r.samples.add(film.meanSamples()),
                r.events.add(eventsOf(film));
        }
    const double time = runs[1].cpu.mean() / runs[0].cpu.mean();
    fmt::print(
        "{:24} noise {:.2f} % (told {:.2f} %), {:.2f} % ({:.2f} %); mean samples {:.3g}; cpu x "
        "{:.2f}, event {:.2g}; even over "
        "adaptive at equal time: noise^2 {}, relMSE {}, MSE {}\n",
        file.substr(file.rfind('/') + 1), 100 * std::sqrt(runs[0].noise.mean()),
        100 * runs[0].told.mean(), 100 * std::sqrt(runs[1].noise.mean()), 100 * runs[1].told.mean(),
        runs[1].samples.mean(), time, costOfAnEvent(runs[0], runs[1]),
        ratio(runs[0].noise, runs[1].noise, time), ratio(runs[0].relative, runs[1].relative, time),
        ratio(runs[0].absolute, runs[1].absolute, time));
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        Options o;
        for (int i = 1; i < argc; ++i) {
            const std::string word = argv[i];
            int* const number = word == "--spp"         ? &o.spp
                                : word == "--seeds"     ? &o.seeds
                                : word == "--reference" ? &o.reference
                                : word == "--width"     ? &o.width
                                                        : nullptr;
            if (number && i + 1 < argc)
                *number = std::atoi(argv[++i]);
            else
                measure(word, o);
        }
    } catch (const std::exception& e) {
        fmt::print(stderr, "error: {}\n", e.what());
        return 1;
    }
}
