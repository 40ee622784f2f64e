// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/load_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/base/statistics.h"
#include "woodcock/compare/resample.h"
#include "woodcock/image/read_layers.h"

namespace woodcock::compare {

namespace {

constexpr const char* errorPrefix = "error.";  // Woodcock's standard errors: error.R

constexpr float nothingThere = 1e10f;  // depth where a ray meets nothing, ours and Blender's

bool isOfPicture(const image::ImagePlane& plane) {
    return plane.layer != "error" && plane.layer != "variance" && plane.name() != "samples";
}

std::vector<std::string> planeNames(const image::LayeredImage& image) {
    std::vector<std::string> names;
    for (const image::ImagePlane& plane : image.planes) names.push_back(plane.name());
    return names;
}

/// Blender's pass of the finished picture, which has the view layer's name, as R, G, B, A.
void nameCombinedPass(image::LayeredImage& image) {
    if (image.find("R") || image.find("Y")) return;
    std::string layer;
    for (const image::ImagePlane& plane : image.planes)
        if (layer.empty() && (plane.layer == "Combined" || plane.layer.ends_with(".Combined")))
            layer = plane.layer;
    for (image::ImagePlane& plane : image.planes)
        if (!layer.empty() && plane.layer == layer) plane.layer.clear();
}

image::LayeredImage read(const std::filesystem::path& file, const std::string& space,
                         const image::ColorConfig& config) {
    image::LayeredImage image = image::readLayers(file);
    nameCombinedPass(image);
    image::makeSceneLinear(image, space, config);
    return image;
}

std::string dimensions(const image::LayeredImage& image) {
    const image::Film::Window w = image.window;
    if (w == image::Film::Window{0, 0, image.width, image.height})
        return fmt::format("{} x {}", image.width, image.height);
    return fmt::format("{} x {} with pixels in [{}, {}) x [{}, {})", image.width, image.height,
                       w.x0, w.x1, w.y0, w.y1);
}

/// Seeds of one image must differ in noise only.
void requireSame(const image::LayeredImage& image, const image::LayeredImage& first) {
    if (image.width != first.width || image.height != first.height || image.window != first.window)
        throw inputError("'{}' is not another seed of '{}': it is {}, not {}", image.file.string(),
                         first.file.string(), dimensions(image), dimensions(first));
    if (planeNames(image) != planeNames(first))
        throw inputError("'{}' is not another seed of '{}': its channels are {}, not {}",
                         image.file.string(), first.file.string(), joinNames(planeNames(image)),
                         joinNames(planeNames(first)));
}

std::string fact(const image::LayeredImage& image, const char* name) {
    const auto found = image.facts.find(name);
    return found == image.facts.end() ? std::string() : found->second;
}

/// Standard errors of a mean over `images`, from their error layers; empty where one image lacks
/// them or an error is unknown.
std::vector<float> errorsFromLayers(const std::vector<image::LayeredImage>& images,
                                    const std::string& plane) {
    std::vector<double> variances;
    for (const image::LayeredImage& image : images) {
        const image::ImagePlane* errors = image.find(errorPrefix + plane);
        if (!errors || image.resolution == 0) return {};
        variances.resize(errors->values.size(), 0.0);
        for (std::size_t i = 0; i < variances.size(); ++i)
            variances[i] += std::pow(static_cast<double>(errors->values[i]), 2);
    }
    std::vector<float> found;
    for (const double v : variances) {
        if (!std::isfinite(v)) return {};
        found.push_back(static_cast<float>(std::sqrt(v) / static_cast<double>(images.size())));
    }
    return found;
}

/// The sum of a number over the files' headers; absent where one header lacks it.
std::optional<double> total(const std::vector<image::LayeredImage>& images, const char* name) {
    double sum = 0;
    for (const image::LayeredImage& image : images) {
        const std::optional<double> value = image.number(name);
        if (!value || !std::isfinite(*value)) return {};
        sum += *value;
    }
    return sum;
}

void addPlane(Picture& picture, const std::vector<image::LayeredImage>& images, std::size_t plane) {
    const std::size_t pixels = images.front().planes[plane].values.size();
    const image::ImagePlane& first = images.front().planes[plane];
    ComparedPlane made{first.name(), {}, {}, first.roundings};
    std::vector<float> scatter;
    for (std::size_t i = 0; i < pixels; ++i) {
        Moments values;
        for (const image::LayeredImage& image : images) values.add(image.planes[plane].values[i]);
        made.values.push_back(static_cast<float>(values.mean()));
        scatter.push_back(static_cast<float>(values.standardError()));
    }
    for (float& v : made.values)
        if (made.isDepth() && v >= nothingThere) v = std::numeric_limits<float>::quiet_NaN();
    made.errors = errorsFromLayers(images, made.name);
    if (!made.errors.empty()) {
        picture.errorsFrom = "error layer";
    } else if (images.size() > 1) {
        made.errors = std::move(scatter);
        picture.errorsFrom = fmt::format("{} seeds", images.size());
        picture.errorDegrees = static_cast<double>(images.size() - 1);
    }
    picture.planes.push_back(std::move(made));
}

/// Each image of the comparison before it is cut to what all have.
struct Whole {
    Picture picture;
    int width, height;
    image::Film::Window window;
};

Whole load(const PictureSource& source, char letter, const image::ColorConfig& config,
           std::vector<std::string>& notes) {
    std::vector<image::LayeredImage> images{read(source.file, source.colourSpace, config)};
    for (const auto& file : source.more) {
        images.push_back(read(file, source.colourSpace, config));
        requireSame(images.back(), images.front());
        if (const std::string seed = fact(images.back(), "woodcock/seed");
            !seed.empty() && seed == fact(images.front(), "woodcock/seed") &&
            fact(images.back(), "woodcock/sampleRange") ==
                fact(images.front(), "woodcock/sampleRange"))
            notes.push_back(
                fmt::format("'{}' has the same seed and samples as '{}': their differences do not "
                            "show the error",
                            file.string(), source.file.string()));
    }
    const image::LayeredImage& first = images.front();
    Whole whole{{}, first.width, first.height, first.window};
    Picture& p = whole.picture;
    p.letter = std::string(1, letter);
    p.files.push_back(source.file);
    p.files.insert(p.files.end(), source.more.begin(), source.more.end());
    p.width = first.window.width(), p.height = first.window.height();
    p.resolution = first.resolution;
    p.madeBy = fact(first, "Software");
    p.madeBy = p.madeBy.substr(0, p.madeBy.find(" : "));  // oiiotool adds its command line
    p.seed = images.size() == 1 ? fact(first, "woodcock/seed") : "";
    p.samples = total(images, "woodcock/samples");
    p.seconds = total(images, "woodcock/renderSeconds");
    for (std::size_t i = 0; i < first.planes.size(); ++i)
        if (isOfPicture(first.planes[i])) addPlane(p, images, i);
    return whole;
}

void cut(Whole& whole, const image::Film::Window& to) {
    Picture& p = whole.picture;
    p.x0 = to.x0, p.y0 = to.y0;
    if (whole.window == to) return;
    const auto part = [&](std::vector<float>& values) {
        std::vector<float> kept;
        if (values.empty()) return;
        for (int y = to.y0; y < to.y1; ++y) {
            const auto row = values.begin() + std::ptrdiff_t{y - whole.window.y0} * p.width;
            kept.insert(kept.end(), row + (to.x0 - whole.window.x0),
                        row + (to.x1 - whole.window.x0));
        }
        values = std::move(kept);
    };
    for (ComparedPlane& plane : p.planes)
        part(plane.values), part(plane.errors), part(plane.roundings);
    p.width = to.width(), p.height = to.height();
}

void cutToCommon(std::vector<Whole>& all, std::vector<std::string>& notes) {
    image::Film::Window common = all.front().window;
    for (const Whole& w : all)
        common = {std::max(common.x0, w.window.x0), std::max(common.y0, w.window.y0),
                  std::min(common.x1, w.window.x1), std::min(common.y1, w.window.y1)};
    if (common.width() < 1 || common.height() < 1)
        throw inputError("the images' data windows have no pixel in common");
    if (std::any_of(all.begin(), all.end(), [&](const Whole& w) { return w.window != common; }))
        notes.push_back(fmt::format(
            "data windows differ: only their common part is compared, [{}, {}) x [{}, {})",
            common.x0, common.x1, common.y0, common.y1));
    for (Whole& w : all) cut(w, common);
}

void makeOneSize(std::vector<Whole>& all, bool resample, std::vector<std::string>& notes) {
    const Whole& first = all.front();
    int width = first.width, height = first.height;
    bool equal = true;
    for (const Whole& w : all) {
        equal = equal && w.width == first.width && w.height == first.height;
        if (!equal && !resample)
            throw inputError(
                "'{}' is {} x {} pixels and '{}' is {} x {}: render them at one size, or add "
                "--resample to average the larger one down",
                first.picture.files.front().string(), first.width, first.height,
                w.picture.files.front().string(), w.width, w.height);
        width = std::min(width, w.width), height = std::min(height, w.height);
    }
    if (equal) return;
    for (Whole& w : all) {
        if (w.window != image::Film::Window{0, 0, w.width, w.height})
            throw inputError("'{}' holds only a part of its image, which cannot be resampled",
                             w.picture.files.front().string());
        if (w.width != width || w.height != height)
            notes.push_back(fmt::format("{}: averaged over areas from {} x {} to {} x {} pixels",
                                        w.picture.letter, w.width, w.height, width, height));
        shrink(w.picture, width, height);
        w.width = width, w.height = height, w.window = {0, 0, width, height};
    }
}

/// Keeps the planes of the first image that all images have, in its order.
void keepCommonPlanes(std::vector<Whole>& all, std::vector<std::string>& notes) {
    std::vector<std::string> common, missing;
    for (const ComparedPlane& plane : all.front().picture.planes) {
        const bool everywhere = std::all_of(all.begin(), all.end(), [&](const Whole& w) {
            return w.picture.find(plane.name) != nullptr;
        });
        (everywhere ? common : missing).push_back(plane.name);
    }
    const auto namesOf = [](const Picture& p) {
        std::vector<std::string> names;
        for (const ComparedPlane& plane : p.planes) names.push_back(plane.name);
        return names;
    };
    std::vector<std::string> has;
    for (const Whole& w : all)
        has.push_back(fmt::format("'{}' has {}", w.picture.files.front().string(),
                                  joinNames(namesOf(w.picture))));
    if (common.empty())
        throw inputError("the images have no channel in common: {}",
                         fmt::format("{}", fmt::join(has, "; ")));
    for (const Whole& w : all)
        for (const std::string& name : namesOf(w.picture))
            if (std::find(common.begin(), common.end(), name) == common.end() &&
                std::find(missing.begin(), missing.end(), name) == missing.end())
                missing.push_back(name);
    if (!missing.empty())
        notes.push_back("not compared, as not all images have them: " + joinNames(missing));
    for (Whole& w : all) {
        std::vector<ComparedPlane> kept;
        for (const std::string& name : common) kept.push_back(*w.picture.find(name));
        w.picture.planes = std::move(kept);
    }
}

void noteEqualSeeds(const std::vector<Whole>& all, std::vector<std::string>& notes) {
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t k = i + 1; k < all.size(); ++k)
            if (const Picture& a = all[i].picture, &b = all[k].picture;
                !a.seed.empty() && a.seed == b.seed)
                notes.push_back(
                    fmt::format("{} and {} have the same seed, {}: their noise is alike, so the "
                                "standard error of their difference is overestimated",
                                a.letter, b.letter, a.seed));
}

}  // namespace

LoadedPictures loadPictures(const std::vector<PictureSource>& sources, bool resample,
                            const image::ColorConfig& config) {
    if (sources.size() < 2 || sources.size() > 26)
        throw usageError("compare takes 2 to 26 images, not {}", sources.size());
    LoadedPictures loaded;
    std::vector<Whole> all;
    for (const PictureSource& source : sources)
        all.push_back(load(source, static_cast<char>('A' + all.size()), config, loaded.notes));
    makeOneSize(all, resample, loaded.notes);
    keepCommonPlanes(all, loaded.notes);
    cutToCommon(all, loaded.notes);
    noteEqualSeeds(all, loaded.notes);
    for (Whole& w : all) loaded.pictures.push_back(std::move(w.picture));
    return loaded;
}

}  // namespace woodcock::compare
