// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "tools/compare/report.h"

namespace woodcock::tool {

namespace {

std::string pictureLine(const compare::Picture& p) {
    std::vector<std::string> files, facts;
    for (const auto& file : p.files) files.push_back(file.string());
    if (!p.madeBy.empty()) facts.push_back(p.madeBy);
    if (p.samples) facts.push_back(fmt::format("{:g} samples", *p.samples));
    if (p.seconds) facts.push_back(fmt::format("{:.3g} s", *p.seconds));
    if (!p.errorsFrom.empty()) facts.push_back("errors from " + p.errorsFrom);
    return fmt::format("{}  {}{}{}\n", p.letter, fmt::join(files, ", "), facts.empty() ? "" : ": ",
                       fmt::join(facts, ", "));
}

std::string channelLine(const compare::ChannelComparison& c, const compare::Picture& at,
                        std::size_t nameWidth) {
    const compare::DifferenceMetrics& m = c.metrics;
    std::string largest = "none";
    if (!m.largest.empty()) {
        const compare::PixelDifference& d = m.largest.front();
        largest = fmt::format("{:.4g} at {},{}", d.b - d.a, at.x0 + d.x, at.y0 + d.y);
    }
    const double z = c.bias.value == 0 ? 0 : c.bias.value / c.bias.error;
    return fmt::format(
        "{:{}}  {:>10.5g} {:>10.5g} {:>9.5f} {:>8.5f} {:>10.2e} {:>8.1e} {:>7.1f} "
        "{:>9.3g} {:>9.3g} {:>6.1f}  {}\n",
        c.name, nameWidth, m.meanA, m.meanB, c.ratio, c.ratioError, c.bias.value, c.bias.error, z,
        m.rmse, m.relMse, m.psnr, largest);
}

std::string imageText(const compare::ImageComparison& image, const compare::Comparison& all) {
    const compare::Picture& reference = all.pictures.front();
    const std::string& letter = all.pictures[image.image].letter;
    std::size_t width = 7;
    for (const compare::ChannelComparison& c : image.channels)
        width = std::max(width, c.name.size());
    std::string text = fmt::format(
        "\n{:{}}  {:>10} {:>10} {:>9} {:>8} {:>10} {:>8} {:>7} {:>9} {:>9} {:>6}  {}\n", "channel",
        width, "mean " + reference.letter, "mean " + letter, letter + "/" + reference.letter, "+-",
        "bias", "+-", "z", "RMSE", "relMSE", "PSNR", "largest difference");
    for (const compare::ChannelComparison& c : image.channels)
        text += channelLine(c, reference, width);
    for (const compare::ChannelComparison& c : image.channels)
        if (const compare::DifferenceMetrics& m = c.metrics; m.nonFiniteA + m.nonFiniteB > 0)
            text += fmt::format("{}: NaN or infinite: {} in {}, {} in {}\n", c.name, m.nonFiniteA,
                                reference.letter, m.nonFiniteB, letter);
    if (image.flip)
        text += fmt::format("FLIP: {:.4f} at exposure 0, {:.4f} over all exposures (HDR)\n",
                            image.flip->ldr, image.flip->hdr);
    text += fmt::format("{}: {}{}{}  ({} tests, noise from {}, false alarms {:g})\n", letter,
                        image.differ ? "differ" : "same within noise", image.differ ? ": " : "",
                        image.reason, image.tests, noiseFrom(image), all.settings.falseAlarms);
    if (!image.tiles.empty()) {
        const compare::TileDifference& t = image.tiles.front();
        text += fmt::format(
            "   worst tile: {} in [{}, {}) x [{}, {}): {:.3g} +- {:.1g}, p = {:.1g}\n",
            image.channels[t.channel].name, reference.x0 + t.place.x0, reference.x0 + t.place.x1,
            reference.y0 + t.place.y0, reference.y0 + t.place.y1, t.difference.value,
            t.difference.error, t.chance);
    }
    return text;
}

}  // namespace

std::string noiseFrom(const compare::ImageComparison& image) {
    std::vector<std::string> known, scattered;
    for (const compare::ChannelComparison& c : image.channels)
        if (c.tested) (c.errorsKnown ? known : scattered).push_back(c.name);
    if (scattered.empty()) return "standard errors";
    if (known.empty()) return "the scatter inside tiles";
    return fmt::format("standard errors ({}) and the scatter inside tiles ({})",
                       fmt::join(known, ", "), fmt::join(scattered, ", "));
}

std::string compareText(const compare::Comparison& all) {
    const compare::Picture& reference = all.pictures.front();
    std::string text = fmt::format("{} x {} pixels, {} tiles; {} is the reference\n",
                                   reference.width, reference.height, all.tiles, reference.letter);
    for (const compare::Picture& p : all.pictures) text += pictureLine(p);
    for (const compare::ImageComparison& image : all.images) text += imageText(image, all);
    return text;
}

}  // namespace woodcock::tool
