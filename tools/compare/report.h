// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/compare/comparison.h"
#include "woodcock/image/display.h"
#include "woodcock/image/view_cube.h"

namespace woodcock::tool {

/// Where the noise of the tests is known from: "standard errors (R) and the scatter inside tiles
/// (A)".
std::string noiseFrom(const compare::ImageComparison& image);

/// A table of metrics and a verdict for each image.
std::string compareText(const compare::Comparison& comparison);
/// {"version", "images", "comparisons", ...}; numbers that are not finite are null.
std::string compareJson(const compare::Comparison& comparison);

/// A view of the config, for the page to show.
struct BakedView {
    std::string name;
    image::ViewCube cube;
};
/// Of the config's default display, those that this build can show; the plain numbers not among
/// them.
std::vector<BakedView> bakeViews(const image::ColorConfig& config);

/// A page that needs no other file: the images with their pixels' values, plots and tables.
std::string compareHtml(const compare::Comparison& comparison, const std::vector<BakedView>& views);

}  // namespace woodcock::tool
