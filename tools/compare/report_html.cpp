// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "tools/common/json_text.h"
#include "tools/compare/report.h"
#include "tools/pages/page.h"
#include "woodcock/base/error.h"
#include "woodcock/compare/pack.h"

namespace woodcock::tool {

// Of page/, see CMakeLists.txt.
extern const std::string_view comparePageStyle, comparePageImages, comparePageViewer,
    comparePageControls, comparePageTables;

using Json = nlohmann::ordered_json;

namespace {

/// The planes that are shown: the colour, or else what comes first.
std::vector<std::size_t> shownPlanes(const compare::Picture& p) {
    std::vector<std::size_t> shown;
    for (const char* name : {"R", "G", "B"})
        for (std::size_t i = 0; i < p.planes.size(); ++i)
            if (p.planes[i].name == name) shown.push_back(i);
    return shown.size() == 3 ? shown : std::vector<std::size_t>{0};
}

/// What the page draws, beside what the JSON says.
Json pixelsJson(const compare::Comparison& all, const std::vector<BakedView>& views) {
    const compare::Picture& reference = all.pictures.front();
    Json names = Json::array(), images = Json::array(), flip = Json::array(), cubes = Json::array(),
         tiles = Json::array();
    const std::vector<std::size_t> shown = shownPlanes(reference);
    for (const std::size_t i : shown) names.push_back(reference.planes[i].name);
    for (const compare::Picture& p : all.pictures) {
        std::vector<float> values;
        for (const std::size_t i : shown)
            values.insert(values.end(), p.planes[i].values.begin(), p.planes[i].values.end());
        images.push_back(compare::packFloats(values));
    }
    const compare::Tiles grid(reference.width, reference.height, all.settings.tile);
    for (const compare::ImageComparison& image : all.images) {
        std::vector<unsigned char> map;
        if (image.flip)
            for (const float v : image.flip->hdrMap)
                map.push_back(
                    static_cast<unsigned char>(std::lround(255 * std::clamp(v, 0.0f, 1.0f))));
        flip.push_back(image.flip ? Json(compare::packBytes(map)) : Json());
        std::set<std::size_t> different;
        for (const compare::TileDifference& t : image.tiles) different.insert(t.tile);
        tiles.push_back(different);
    }
    for (const BakedView& view : views)
        cubes.push_back({{"name", view.name},
                         {"side", view.cube.side},
                         {"low", view.cube.low},
                         {"high", view.cube.high},
                         {"rgb", compare::packBytes(view.cube.rgb)}});
    return {{"channels", names},
            {"images", images},
            {"flip", flip},
            {"views", cubes},
            {"tile_columns", grid.columns()},
            {"tile_rows", grid.rows()},
            {"tiles", tiles}};
}

}  // namespace

std::vector<BakedView> bakeViews(const image::ColorConfig& config) {
    std::vector<BakedView> baked;
    for (const std::string& name : config.views()) {
        if (name == "Raw") continue;  // the page draws that itself
        image::DisplaySettings settings;
        settings.view = name;
        try {
            baked.push_back({name, image::bakeView(config.displayTransform(settings))});
        } catch (const Error&) {
            // A view of a later OpenColorIO: `render --view` says which; the others are shown.
        }
    }
    return baked;
}

std::string compareHtml(const compare::Comparison& comparison,
                        const std::vector<BakedView>& views) {
    const Json pixels = pixelsJson(comparison, views);
    return makePage(
        {"woodcock compare",
         {comparePageStyle},
         {{"report", compareJson(comparison)}, {"pixels", jsonText(pixels, -1)}},
         {comparePageImages, comparePageViewer, comparePageControls, comparePageTables}});
}

}  // namespace woodcock::tool
