// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/saved_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <iterator>
#include <utility>

#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"
#include "woodcock/base/printable.h"
#include "woodcock/base/version.h"

namespace woodcock::render {

namespace {

constexpr const char* drawnPlane = "drawn";
constexpr const char* sharePlane = "planShare";
constexpr const char* costPlane = "planCost";
constexpr const char* mattesFact = "mattes";
constexpr std::array endingNames{"complete", "limited", "unfinished"};

constexpr std::array countersKept{&RenderCounters::paths,
                                  &RenderCounters::scatterings,
                                  &RenderCounters::shadowRays,
                                  &RenderCounters::distanceSegments,
                                  &RenderCounters::distanceCollisions,
                                  &RenderCounters::shadowSegments,
                                  &RenderCounters::shadowCollisions,
                                  &RenderCounters::surfaceRays,
                                  &RenderCounters::clamped};

std::string textOf(const image::Film::Window& w) {
    return fmt::format("{},{},{},{}", w.x0, w.y0, w.x1, w.y1);
}

std::string countersText(const RenderCounters& counters) {
    std::string text;
    for (const auto counter : countersKept)
        text += fmt::format("{}{}", text.empty() ? "" : ",", counters.*counter);
    return text;
}

std::string sampledText(const RenderSettings& settings) {
    const image::LayerNeeds& layers = settings.layers;
    std::string text = layers.features         ? "depth and features"
                       : layers.depthSamples() ? "depth"
                                               : "light";
    if (layers.places) text += ", places";
    if (layers.stops) text += ", exact depths";
    for (std::size_t part = 0; part < layers.parts.count(); ++part)
        text += ", " + layers.parts.name(part);
    for (const image::MatteLayer& layer : settings.mattes) text += ", " + layer.name;
    if (settings.deepError > 0)
        text += fmt::format(", deep pixels of error {}", settings.deepError);
    return text;
}

void requireMemory(const image::StateFile& file, const std::vector<image::MatteLayer>& mattes) {
    const image::Film::Window& w = file.window();
    const double needed =
        double(w.width()) * w.height() *
        (image::MatteFilm::bytesPerPixel(mattes) +
         static_cast<double>(image::Film::bytesPerPixel(image::Film::keptIn(file.planes())) +
                             sizeof(SamplePlan::Weight) + 2 * sizeof(std::uint64_t)));
    if (const auto possible = static_cast<double>(memoryLimit()); needed > possible)
        throw file.unreadable(fmt::format("its sums need {} of memory, and there are {}",
                                          formatGiB(needed), formatGiB(possible)));
}

bool planIsSound(const std::vector<SamplePlan::Weight>& weights) {
    constexpr std::uint64_t mostCost = std::uint64_t{1} << 32;
    return std::all_of(weights.begin(), weights.end(), [](const SamplePlan::Weight& w) {
        return w.share > 0 && w.share <= 1e6 && w.cost > 0 && w.cost <= mostCost;
    });
}

}  // namespace

Ending endingOf(StopReason reason) {
    switch (reason) {
        case StopReason::Complete:
            return Ending::Complete;
        case StopReason::TimeLimit:
        case StopReason::NoiseReached:
            return Ending::Limited;
        case StopReason::Interrupted:
            break;
    }
    return Ending::Unfinished;
}

SavedState::SavedState(const RenderState& state, const RenderSettings& settings,
                       image::Film::Window picture, Ending ending, image::StateFacts facts)
    : drawn_(state.drawn.begin(), state.drawn.end()) {
    const image::Film& film = state.film;
    saved_ = {std::move(facts), film.width(), film.height(), film.crop(), film.planes()};
    saved_.planes.push_back({drawnPlane, 1, 1, nullptr, drawn_.data()});
    image::StateFacts& f = saved_.facts;
    const auto keep = [&](std::vector<image::Film::ConstPlane> planes) {
        std::move(planes.begin(), planes.end(), std::back_inserter(saved_.planes));
    };
    if (state.mattes) keep(state.mattes->planes());
    if (state.deep) {
        deep_.emplace(*state.deep);
        keep(std::as_const(*deep_).planes());
        f.merge(deep_->facts());
    }
    f[mattesFact] = image::matteNamesText(settings.mattes);
    if (state.plan) {
        plan_ = state.plan->weights();
        saved_.planes.push_back({sharePlane, 1, 2, &plan_.front().share, nullptr});
        saved_.planes.push_back({costPlane, 1, 2, nullptr, &plan_.front().cost});
        f["pilot"] = fmt::format("{}", state.plan->pilot());
    }
    f["program"] = version();
    f["picture"] = textOf(picture);
    f["sampled"] = sampledText(settings);
    f["seed"] = fmt::format("{}", settings.seed);
    f["first"] = fmt::format("{}", settings.firstSample);
    f["end"] = fmt::format("{}", state.endSample);
    f["asked"] = fmt::format("{}", settings.endSample);
    f["adaptive"] = settings.adaptive ? "yes" : "no";
    f["ending"] = endingNames[static_cast<std::size_t>(ending)];
    f["pass"] = fmt::format("{}", state.passLength);
    f["seconds"] = fmt::format("{}", state.seconds);
    f["counters"] = countersText(state.counters);
}

Ending endingOf(const image::StateFile& file) {
    const std::string& name = file.fact("ending");
    const auto found = std::find(endingNames.begin(), endingNames.end(), name);
    if (found == endingNames.end())
        throw file.unreadable(fmt::format("its 'ending' is '{}', which is not known", shown(name)));
    return static_cast<Ending>(found - endingNames.begin());
}

image::Film::Window pictureOf(const image::StateFile& file) {
    const auto n = file.numbers<int>("picture", 4);
    const image::Film::Window own = file.window(), picture{n[0], n[1], n[2], n[3]};
    if (picture.x0 < 0 || picture.y0 < 0 || picture.x1 > file.width() ||
        picture.y1 > file.height() || own.x0 < picture.x0 || own.y0 < picture.y0 ||
        own.x1 > picture.x1 || own.y1 > picture.y1)
        throw file.unreadable("its pixels lie outside of the picture that they are a part of");
    return picture;
}

std::vector<image::MatteLayer> matteLayersIn(const image::StateFile& file) {
    const std::string& text = file.fact(mattesFact);
    if (auto layers = image::matteLayersOf(text)) return std::move(*layers);
    throw file.unreadable(
        fmt::format("its '{}' is '{}', not names of mattes", mattesFact, shown(text, 60)));
}

RenderState readState(const image::StateFile& file) {
    std::vector<image::MatteLayer> mattes = matteLayersIn(file);
    requireMemory(file, mattes);
    RenderState state{image::Film(file.width(), file.height(), file.window(),
                                  image::Film::keptIn(file.planes()))};
    if (!mattes.empty()) state.mattes.emplace(file.window(), std::move(mattes));
    std::optional<image::DeepState> deep;
    if (image::DeepState::isIn(file)) deep.emplace(file);
    const std::size_t pixels = state.film.pixelCount();
    std::vector<image::Film::Plane> planes = state.film.planes();
    std::vector<std::uint64_t> drawn(pixels);
    planes.push_back({drawnPlane, 1, 1, nullptr, drawn.data()});
    const auto expect = [&](std::vector<image::Film::Plane> more) {
        std::move(more.begin(), more.end(), std::back_inserter(planes));
    };
    if (state.mattes) expect(state.mattes->planes());
    if (deep) expect(deep->planes());
    std::vector<SamplePlan::Weight> plan;
    if (file.has("pilot")) {
        plan.resize(pixels);
        planes.push_back({sharePlane, 1, 2, &plan.front().share, nullptr});
        planes.push_back({costPlane, 1, 2, nullptr, &plan.front().cost});
    }
    if (!std::equal(planes.begin(), planes.end(), file.planes().begin(), file.planes().end(),
                    [](const auto& plane, const std::string& name) { return plane.name == name; }))
        throw file.unreadable(
            "it keeps other sums than this version of woodcock; another version may have written "
            "it");
    file.read(planes);
    if (deep) state.deep = deep->film(file);

    const auto first = file.count("first", 0, INT_MAX);
    state.endSample = static_cast<int>(file.count("end", first, INT_MAX));
    state.passLength = static_cast<int>(file.count("pass", 1, 1 << 20));
    state.seconds = std::max(0.0, file.number("seconds"));
    const auto counters = file.numbers<std::uint64_t>("counters", countersKept.size());
    for (std::size_t i = 0; i < counters.size(); ++i) state.counters.*countersKept[i] = counters[i];
    for (const std::uint64_t n : drawn) {
        if (n < static_cast<std::uint64_t>(first) || n > INT_MAX)
            throw file.unreadable("its numbers of samples contradict each other");
        state.drawn.push_back(static_cast<std::uint32_t>(n));
    }
    if (!plan.empty()) {
        if (!planIsSound(plan)) throw file.unreadable("its plan of samples makes no sense");
        state.plan.emplace(file.window().width(), static_cast<int>(file.count("pilot", 1, INT_MAX)),
                           plan);
    }
    return state;
}

void checkGoesOn(const image::StateFile& file, const RenderSettings& settings,
                 image::Film::Window picture, const image::StateFacts& facts) {
    constexpr const char* advice =
        "Go on with what it was made by, or remove the file to begin anew";
    const auto refuse = [&](const std::string& reason) {
        return inputError("cannot go on from '{}': {}. {}", file.file().string(), reason, advice);
    };
    const auto compare = [&](const char* fact, const std::string& expected, const char* what) {
        if (const std::string& found = file.fact(fact); found != expected)
            throw refuse(fmt::format("{} '{}' there and '{}' here", what, shown(found), expected));
    };
    const auto digest = [&](const char* fact, const char* what) {
        if (file.fact(fact) != facts.at(fact))
            throw refuse(fmt::format("{}: its digest is {}, and that of this render {}", what,
                                     shown(file.fact(fact)), facts.at(fact)));
    };
    digest("scene", "it is of another scene");
    digest("files", "the files of the scene have changed since");
    const image::Film::Window crop = settings.crop.value_or(picture);
    if (file.width() != settings.width || file.height() != settings.height || file.window() != crop)
        throw refuse(fmt::format("it has the pixels {} of {} x {}, and asked for are {} of {} x {}",
                                 textOf(file.window()), file.width(), file.height(), textOf(crop),
                                 settings.width, settings.height));
    compare("picture", textOf(picture), "the pixels that it is a part of are");
    compare("seed", fmt::format("{}", settings.seed), "the seed is");
    compare("first", fmt::format("{}", settings.firstSample), "the first sample is");
    compare("adaptive", settings.adaptive ? "yes" : "no", "adaptive sampling is");
    compare("sampled", sampledText(settings), "sampled for layers is");
    compare(mattesFact, image::matteNamesText(settings.mattes), "the names of mattes are");
    if (settings.adaptive)
        compare("asked", fmt::format("{}", settings.endSample),
                "the samples per pixel, from which the plan of an adaptive render follows, are");
}

}  // namespace woodcock::render
