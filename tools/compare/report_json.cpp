// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/common/json_text.h"
#include "tools/compare/report.h"
#include "woodcock/base/version.h"

namespace woodcock::tool {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t mostTiles = 100;  // of each image: what a reader may look at one by one

Json orNull(const std::optional<double>& number) { return number ? Json(*number) : Json(); }

Json pictureJson(const compare::Picture& p) {
    Json files = Json::array();
    for (const auto& file : p.files) files.push_back(file.string());
    return {{"letter", p.letter},
            {"files", files},
            {"made_by", p.madeBy},
            {"samples", orNull(p.samples)},
            {"render_seconds", orNull(p.seconds)},
            {"errors_from", p.errorsFrom.empty() ? Json() : Json(p.errorsFrom)}};
}

Json channelJson(const compare::ChannelComparison& c, const compare::Picture& at) {
    const compare::DifferenceMetrics& m = c.metrics;
    Json largest = Json::array();
    for (const compare::PixelDifference& d : m.largest)
        largest.push_back(
            {{"x", at.x0 + d.x}, {"y", at.y0 + d.y}, {"reference", d.a}, {"image", d.b}});
    return {{"name", c.name},
            {"pixels", m.pixels},
            {"non_finite", {{"reference", m.nonFiniteA}, {"image", m.nonFiniteB}}},
            {"mean", {{"reference", m.meanA}, {"image", m.meanB}}},
            {"ratio", c.ratio},
            {"ratio_error", c.ratioError},
            {"bias", c.bias.value},
            {"bias_error", c.bias.error},
            {"p", c.chance},
            {"tested", c.tested},
            {"biased", c.biased},
            {"rmse", m.rmse},
            {"relmse", m.relMse},
            {"psnr", m.psnr},
            {"peak", m.peak},
            {"largest", largest}};
}

Json imageJson(const compare::ImageComparison& image, const compare::Comparison& all) {
    const compare::Picture& at = all.pictures.front();
    Json channels = Json::array(), tiles = Json::array();
    for (const compare::ChannelComparison& c : image.channels)
        channels.push_back(channelJson(c, at));
    for (std::size_t i = 0; i < std::min(mostTiles, image.tiles.size()); ++i) {
        const compare::TileDifference& t = image.tiles[i];
        tiles.push_back({{"channel", image.channels[t.channel].name},
                         {"x0", at.x0 + t.place.x0},
                         {"y0", at.y0 + t.place.y0},
                         {"x1", at.x0 + t.place.x1},
                         {"y1", at.y0 + t.place.y1},
                         {"difference", t.difference.value},
                         {"error", t.difference.error},
                         {"p", t.chance}});
    }
    return {
        {"image", all.pictures[image.image].letter},
        {"verdict", image.differ ? "differ" : "same within noise"},
        {"reason", image.reason},
        {"noise_from", noiseFrom(image)},
        {"tests", image.tests},
        {"tiles_that_differ", image.differentTiles},
        {"flip", image.flip ? Json{{"ldr", image.flip->ldr}, {"hdr", image.flip->hdr}} : Json()},
        {"channels", channels},
        {"worst_tiles", tiles}};
}

}  // namespace

std::string compareJson(const compare::Comparison& all) {
    Json images = Json::array(), comparisons = Json::array();
    for (const compare::Picture& p : all.pictures) images.push_back(pictureJson(p));
    for (const compare::ImageComparison& image : all.images)
        comparisons.push_back(imageJson(image, all));
    const compare::Picture& reference = all.pictures.front();
    const Json json{{"version", version()},
                    {"width", reference.width},
                    {"height", reference.height},
                    {"x0", reference.x0},
                    {"y0", reference.y0},
                    {"tile_side", all.settings.tile},
                    {"tiles", all.tiles},
                    {"false_alarm_rate", all.settings.falseAlarms},
                    {"relmse_epsilon", compare::relMseEpsilon},
                    {"images", images},
                    {"comparisons", comparisons},
                    {"notes", all.notes}};
    return jsonText(json) + "\n";
}

}  // namespace woodcock::tool
