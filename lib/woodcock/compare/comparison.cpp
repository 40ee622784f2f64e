// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "woodcock/base/error.h"
#include "woodcock/compare/flip.h"

namespace woodcock::compare {

namespace {

ChannelComparison compareChannel(const Picture& a, const Picture& b, std::size_t plane,
                                 const Tiles& tiles,
                                 const std::vector<MeanDifference>& differences) {
    const ComparedPlane &planeA = a.planes[plane], &planeB = b.planes[plane];
    ChannelComparison c;
    c.name = planeA.name;
    c.tested = !planeA.isDepth();
    c.errorsKnown = !planeA.errors.empty() && !planeB.errors.empty();
    c.metrics = differenceMetrics(planeA.values, planeB.values, a.width);
    if (planeA.isDepth())  // missing depth is not a defect
        c.metrics.nonFiniteA = c.metrics.nonFiniteB = c.metrics.nonFiniteInOne = 0;
    if (c.metrics.pixels == 0 && c.tested)
        throw inputError("no pixel of channel {} is finite in both '{}' and '{}'", c.name,
                         a.files.front().string(), b.files.front().string());
    c.bias = overall(differences);
    c.chance = c.bias.chance();
    c.ratio = c.ratioError = std::numeric_limits<double>::quiet_NaN();
    if (const double mean = c.metrics.meanA; mean != 0) {
        // To first order, the error of the ratio is that of the mean of b - ratio * a.
        c.ratio = c.metrics.meanB / mean;
        c.ratioError =
            overall(tileDifferences(a, planeA, b, planeB, tiles, c.ratio)).error / std::abs(mean);
    }
    return c;
}

/// R, G, B of every pixel, black where one of the two images is not finite.
std::vector<float> colours(const Picture& of, const Picture& other) {
    std::vector<float> rgb(of.pixels() * 3);
    std::size_t c = 0;
    for (const char* name : {"R", "G", "B"}) {
        const std::vector<float>&here = of.find(name)->values, &there = other.find(name)->values;
        for (std::size_t i = 0; i < here.size(); ++i)
            rgb[3 * i + c] = std::isfinite(here[i]) && std::isfinite(there[i]) ? here[i] : 0;
        ++c;
    }
    return rgb;
}

double mean(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::optional<FlipComparison> compareByEye(const Picture& a, const Picture& b) {
    for (const char* name : {"R", "G", "B"})
        if (!a.find(name)) return {};
    const std::vector<float> reference = colours(a, b), test = colours(b, a);
    FlipComparison flip;
    flip.ldr = mean(flipLdr(reference, test, a.width, a.height));
    flip.hdrMap = flipHdr(reference, test, a.width, a.height);
    flip.hdr = mean(flip.hdrMap);
    return flip;
}

/// Tests the means of all channels at half of the rate, and all tiles at the other half: together,
/// the many tiles would make the bounds of the means needlessly strict.
void test(ImageComparison& image, const std::vector<std::vector<MeanDifference>>& differences,
          const Tiles& tiles, double falseAlarms) {
    std::vector<double> ofMeans, ofTiles;
    std::vector<TileDifference> all;
    for (std::size_t c = 0; c < image.channels.size(); ++c) {
        if (!image.channels[c].tested) continue;
        ofMeans.push_back(image.channels[c].chance);
        const std::vector<MeanDifference> own = cautious(differences[c], tiles);
        for (std::size_t t = 0; t < own.size(); ++t) {
            ofTiles.push_back(own[t].chance());
            all.push_back({c, t, tiles.tile(t), own[t], ofTiles.back()});
        }
    }
    image.tests = ofMeans.size() + ofTiles.size();
    const std::vector<bool> biased = tooSmall(ofMeans, falseAlarms / 2);
    const std::vector<bool> found = tooSmall(ofTiles, falseAlarms / 2);
    std::size_t next = 0;
    for (ChannelComparison& channel : image.channels)
        if (channel.tested) channel.biased = biased[next++];
    std::set<std::size_t> places;
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (!found[k]) continue;
        image.tiles.push_back(all[k]);
        places.insert(all[k].tile);
    }
    image.differentTiles = places.size();
    std::stable_sort(
        image.tiles.begin(), image.tiles.end(),
        [](const TileDifference& a, const TileDifference& b) { return a.chance < b.chance; });
}

void judge(ImageComparison& image, const Picture& a, const Picture& b, std::size_t tiles) {
    std::vector<std::string> reasons;
    std::size_t nonFinite = 0;
    std::vector<std::string> biased;
    for (const ChannelComparison& c : image.channels) {
        nonFinite += c.metrics.nonFiniteInOne;
        if (c.biased) biased.push_back(c.name);
    }
    if (nonFinite > 0)
        reasons.push_back(
            fmt::format("{} NaN or infinite in only one of {} and {}",
                        nonFinite == 1 ? "a value is" : fmt::format("{} values are", nonFinite),
                        a.letter, b.letter));
    if (!biased.empty()) reasons.push_back(fmt::format("the mean of {}", fmt::join(biased, ", ")));
    if (image.differentTiles > 0)
        reasons.push_back(fmt::format("{} of {} tiles", image.differentTiles, tiles));
    image.differ = !reasons.empty();
    image.reason = fmt::format("{}", fmt::join(reasons, "; "));
}

ImageComparison compareWith(const Picture& a, const Picture& b, std::size_t index,
                            const CompareSettings& settings) {
    const Tiles tiles(a.width, a.height, settings.tile);
    ImageComparison image;
    image.image = index;
    std::vector<std::vector<MeanDifference>> differences;
    for (std::size_t p = 0; p < a.planes.size(); ++p) {
        differences.push_back(tileDifferences(a, a.planes[p], b, b.planes[p], tiles));
        image.channels.push_back(compareChannel(a, b, p, tiles, differences.back()));
    }
    test(image, differences, tiles, settings.falseAlarms);
    judge(image, a, b, tiles.count());
    image.flip = compareByEye(a, b);
    return image;
}

/// Notes values that are not finite, with the position of the first.
void noteNonFinite(const Picture& p, std::vector<std::string>& notes) {
    std::size_t count = 0;
    std::string first;
    for (const ComparedPlane& plane : p.planes)
        for (std::size_t i = 0; i < plane.values.size(); ++i) {
            if (plane.isDepth() || std::isfinite(plane.values[i]) || count++ > 0) continue;
            const auto width = static_cast<std::size_t>(p.width);
            first = fmt::format("{} in {} at {}, {}", plane.values[i], plane.name,
                                static_cast<std::size_t>(p.x0) + i % width,
                                static_cast<std::size_t>(p.y0) + i / width);
        }
    if (count > 0)
        notes.push_back(
            fmt::format("{} holds {} NaN or infinite value{}, the first one {}; no "
                        "metric includes these",
                        p.letter, count, count == 1 ? "" : "s", first));
}

}  // namespace

Comparison compare(LoadedPictures loaded, const CompareSettings& settings) {
    Comparison c;
    c.settings = settings;
    c.pictures = std::move(loaded.pictures);
    c.notes = std::move(loaded.notes);
    const Picture& reference = c.pictures.front();
    c.tiles = Tiles(reference.width, reference.height, settings.tile).count();
    for (const Picture& picture : c.pictures) noteNonFinite(picture, c.notes);
    for (std::size_t i = 1; i < c.pictures.size(); ++i)
        c.images.push_back(compareWith(reference, c.pictures[i], i, settings));
    return c;
}

}  // namespace woodcock::compare
