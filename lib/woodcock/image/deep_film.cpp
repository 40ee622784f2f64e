// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/deep_film.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"

namespace woodcock::image {

namespace {

/// Of what is left of the light, this is nothing to a float.
constexpr double nothing = 1e-7;
/// Media that stop all light in one sample could not be split any more.
constexpr double mostOfMedium = 1 - 0x1p-24;

void requireMemory(std::size_t edges, std::size_t pixels, int copies) {
    const double bytes =
        copies * (static_cast<double>(edges) * (sizeof(DeepSums::Bin) + sizeof(float)) +
                  static_cast<double>(pixels) * sizeof(std::vector<DeepSums::Point>));
    if (bytes > 0.9 * static_cast<double>(memoryLeft()))
        throw failure(
            "deep pixels need {} of memory, and there are {}: {:.3g} bins in the mean pixel. A "
            "larger deep_error needs fewer, or render parts of the image by --crop",
            formatGiB(bytes), formatGiB(static_cast<double>(memoryLeft())),
            static_cast<double>(edges) / static_cast<double>(std::max<std::size_t>(pixels, 1)));
}

void addRadiance(double (&sums)[3], Rgb radiance) {
    for (int c = 0; c < 3; ++c) sums[c] += radiance[c];
}

}  // namespace

/// A bin or a point of one pixel, in means over its samples.
struct DeepFilm::Piece {
    double near, far, stopped;
    double radiance[3];
    bool isPoint() const { return !(far > near); }
};

DeepFilm::DeepFilm(Film::Window crop, double error, const std::vector<std::vector<float>>& edges,
                   int copies)
    : crop_(crop), error_(error) {
    std::size_t count = 0;
    for (const std::vector<float>& pixel : edges) {
        sums_.firstEdge.push_back(count);
        count += pixel.size();
    }
    sums_.firstEdge.push_back(count);
    requireMemory(count, edges.size(), copies);
    sums_.edges.reserve(count);
    for (const std::vector<float>& pixel : edges)
        sums_.edges.insert(sums_.edges.end(), pixel.begin(), pixel.end());
    sums_.points.resize(edges.size());
    makeBins();
}

DeepFilm::DeepFilm(Film::Window crop, double error, DeepSums sums)
    : crop_(crop), error_(error), sums_(std::move(sums)) {}

DeepFilm::DeepFilm(Film::Window crop, std::span<const DeepFilm> parts)
    : crop_(crop), error_(parts.front().error_) {
    std::size_t most = 0;
    for (const DeepFilm& part : parts) most += part.sums_.edges.size();
    requireMemory(most, pixelOf(crop.x1 - 1, crop.y1 - 1) + 1, 1);
    sums_.edges.reserve(most);
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            sums_.firstEdge.push_back(sums_.edges.size());
            const auto part = std::find_if(parts.begin(), parts.end(), [&](const DeepFilm& film) {
                const Film::Window& w = film.crop_;
                return x >= w.x0 && x < w.x1 && y >= w.y0 && y < w.y1;
            });
            if (part == parts.end()) continue;
            const std::span<const float> edges = part->edgesOf(part->pixelOf(x, y));
            sums_.edges.insert(sums_.edges.end(), edges.begin(), edges.end());
        }
    sums_.points.resize(sums_.firstEdge.size());
    sums_.firstEdge.push_back(sums_.edges.size());
    makeBins();
    for (const DeepFilm& part : parts) add(part);
}

void DeepFilm::makeBins() {
    const std::size_t pixels = sums_.points.size();
    sums_.bins.resize((sums_.edges.size() + pixels - 1) / pixels * pixels);
}

double DeepFilm::meanBins() const {
    std::size_t bins = 0;
    for (std::size_t i = 0; i < sums_.points.size(); ++i)
        bins += std::max<std::size_t>(sums_.firstEdge[i + 1] - sums_.firstEdge[i], 1) - 1;
    return static_cast<double>(bins) / static_cast<double>(sums_.points.size());
}

std::size_t DeepFilm::pixelOf(int x, int y) const {
    return static_cast<std::size_t>(y - crop_.y0) * static_cast<std::size_t>(crop_.width()) +
           static_cast<std::size_t>(x - crop_.x0);
}

std::span<const float> DeepFilm::edgesOf(std::size_t pixel) const {
    return std::span(sums_.edges)
        .subspan(sums_.firstEdge[pixel], sums_.firstEdge[pixel + 1] - sums_.firstEdge[pixel]);
}

/// The bin that this depth lies in, or within the error of; null: there is none.
DeepFilm::Bin* DeepFilm::binAt(std::size_t pixel, double depth) {
    const auto begin = sums_.edges.begin() + static_cast<std::ptrdiff_t>(sums_.firstEdge[pixel]);
    const auto end = sums_.edges.begin() + static_cast<std::ptrdiff_t>(sums_.firstEdge[pixel + 1]);
    if (begin == end || depth < *begin * (1 - error_) || depth > *(end - 1) * (1 + error_))
        return nullptr;
    const auto above = std::upper_bound(begin + 1, end - 1, depth);
    return &sums_.bins[static_cast<std::size_t>(above - sums_.edges.begin()) - 1];
}

/// The point that a hit belongs to; perhaps a new one, which has none yet.
DeepFilm::Point& DeepFilm::pointNear(std::size_t pixel, std::uint32_t owner, double depth) {
    std::vector<Point>& points = sums_.points[pixel];
    const auto distance = [&](const Point& p) { return std::abs(p.depth() - depth); };
    Point* nearest = nullptr;
    for (Point& p : points)
        if (p.owner == owner && (!nearest || distance(p) < distance(*nearest))) nearest = &p;
    if (!nearest || distance(*nearest) > error_ * depth) {
        if (points.size() < mostPoints) {
            nearest = &points.emplace_back(Point{.owner = owner});
        } else {
            nearest = &*std::min_element(
                points.begin(), points.end(),
                [&](const Point& a, const Point& b) { return distance(a) < distance(b); });
        }
    }
    return *nearest;
}

DeepFilm::Point& DeepFilm::pointAt(std::size_t pixel, std::uint32_t owner, double depth) {
    Point& point = pointNear(pixel, owner, depth);
    point.depths += depth, point.hits += 1;
    return point;
}

void DeepFilm::addStop(std::size_t pixel, const StoppedLight::Stop& stop) {
    using Kind = StoppedLight::Stop::Kind;
    if (stop.kind != Kind::Medium) {
        Point& point = pointAt(pixel, stop.owner, stop.near);
        (stop.kind == Kind::ShadowCatcher ? point.caught : point.stopped) += stop.amount();
        return;
    }
    if (!(stop.far > stop.near)) {
        if (Bin* bin = binAt(pixel, stop.near))
            bin->stopped += stop.amount();
        else
            pointAt(pixel, strayMedium, stop.near).stopped += stop.amount();
        return;
    }
    const std::size_t first = sums_.firstEdge[pixel], end = sums_.firstEdge[pixel + 1];
    if (first == end) {
        pointAt(pixel, strayMedium, (stop.near + stop.far) / 2).stopped += stop.amount();
        return;
    }
    // What lies outside of all bins goes to the first and the last.
    double before = 0;
    for (std::size_t i = first; i + 1 < end; ++i) {
        const bool last = i + 2 == end;
        const double upTo = last ? stop.amount() : stop.amountBefore(sums_.edges[i + 1]);
        sums_.bins[i].stopped += upTo - before;
        before = upTo;
    }
}

void DeepFilm::add(int x, int y, const StoppedLight& ray) {
    const std::size_t pixel = pixelOf(x, y);
    for (const StoppedLight::Stop& stop : ray.stops) addStop(pixel, stop);
    for (const StoppedLight::Arrival& arrival : ray.arrivals) {
        if (Bin* bin = arrival.fromPoint ? nullptr : binAt(pixel, arrival.depth))
            addRadiance(bin->radiance, arrival.radiance);
        else
            addRadiance(
                pointAt(pixel, arrival.fromPoint ? arrival.owner : strayMedium, arrival.depth)
                    .radiance,
                arrival.radiance);
    }
}

std::optional<std::array<int, 2>> DeepFilm::mismatch(const DeepFilm& other) const {
    const Film::Window &a = crop_, &b = other.crop_;
    for (int y = std::max(a.y0, b.y0); y < std::min(a.y1, b.y1); ++y)
        for (int x = std::max(a.x0, b.x0); x < std::min(a.x1, b.x1); ++x) {
            const std::span<const float> own = edgesOf(pixelOf(x, y)),
                                         others = other.edgesOf(other.pixelOf(x, y));
            if (!std::equal(own.begin(), own.end(), others.begin(), others.end()))
                return std::array{x, y};
        }
    return std::nullopt;
}

void DeepFilm::add(const DeepFilm& part) {
    const Film::Window& w = part.crop_;
    for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x) {
            const std::size_t to = pixelOf(x, y), from = part.pixelOf(x, y);
            const std::size_t first = sums_.firstEdge[to], source = part.sums_.firstEdge[from];
            for (std::size_t i = 0; i < edgesOf(to).size(); ++i) {
                Bin& bin = sums_.bins[first + i];
                const Bin& more = part.sums_.bins[source + i];
                bin.stopped += more.stopped;
                for (int c = 0; c < 3; ++c) bin.radiance[c] += more.radiance[c];
            }
            if (sums_.points[to].empty()) {
                sums_.points[to] = part.sums_.points[from];
                continue;
            }
            for (const Point& more : part.sums_.points[from]) {
                Point& point = pointNear(to, more.owner, more.depth());
                point.depths += more.depths, point.hits += more.hits;
                point.stopped += more.stopped, point.caught += more.caught;
                for (int c = 0; c < 3; ++c) point.radiance[c] += more.radiance[c];
            }
        }
}

/// Samples that make, over each other, the sums of sorted pieces.
std::vector<DeepSample> DeepFilm::composed(const std::vector<Piece>& pieces) {
    std::vector<DeepSample> samples;
    double left = 1;  // of the light, in front of the next piece
    double owed = 0;  // what pieces have stopped less than nothing
    // The same as a reader of the file has it, whose alphas are floats; and in front of the last
    // sample.
    double inFile = 1, ofLast = 1;
    const auto colourOf = [](const Piece& piece, double inFront) {
        return Rgb::map([&](int c) { return static_cast<float>(piece.radiance[c] / inFront); });
    };
    for (const Piece& piece : pieces) {
        const double owing = piece.stopped + owed;
        owed = std::min(0.0, owing);
        const double stopped = std::clamp(owing, 0.0, left);
        if (stopped == 0 && colourOf(piece, 1) == Rgb()) continue;
        left -= stopped;
        auto near = static_cast<float>(piece.near), far = static_cast<float>(piece.far);
        const bool afterPoint = !samples.empty() && samples.back().far == samples.back().near;
        if (!samples.empty()) near = std::max(near, samples.back().far);
        if (afterPoint && far > near && near == samples.back().near)
            near = std::nextafter(near, std::numeric_limits<float>::infinity());
        far = std::max(near, far);
        // Behind what lets nothing through, and in one place, samples become one.
        const bool joins =
            !samples.empty() &&
            (inFile < nothing || (afterPoint && far == near && near == samples.back().near));
        if (!joins) {
            samples.push_back({near, far, Rgb(), 0});
            ofLast = inFile;
        }
        DeepSample& sample = samples.back();
        sample.colour += colourOf(piece, ofLast);
        const double most = sample.far > sample.near ? mostOfMedium : 1;
        sample.alpha = static_cast<float>(std::clamp(1 - left / ofLast, 0.0, most));
        inFile = ofLast * (1 - double{sample.alpha});
    }
    return samples;
}

std::vector<DeepSample> DeepFilm::samples(int x, int y, const Film& film) const {
    const std::size_t pixel = pixelOf(x, y);
    const Film::Pixel& sums = film.at(x, y);
    if (sums.samples == 0) return {};
    const auto n = static_cast<double>(sums.samples);

    // Shadows on a catcher: their share of its light is known at the end.
    double caught = 0;
    for (const Point& p : sums_.points[pixel]) caught += p.caught;
    const double shadow =
        caught > 0 ? std::max(0.0, double{film.alpha(x, y)} * n - sums.alpha) / caught : 0;

    std::vector<Piece> pieces;
    const auto add = [&](double near, double far, double stopped, const double(&radiance)[3],
                         double share) {
        Piece piece{near, far, stopped * share / n, {}};
        for (int c = 0; c < 3; ++c) piece.radiance[c] = radiance[c] * share / n;
        pieces.push_back(piece);
    };
    for (const Point& p : sums_.points[pixel])
        add(p.depth(), p.depth(), p.stopped + shadow * p.caught, p.radiance, 1);
    const auto byDepth = [](const Piece& a, const Piece& b) {
        return std::pair(a.near, a.far) < std::pair(b.near, b.far);
    };
    std::sort(pieces.begin(), pieces.end(), byDepth);
    // Bins are cut where a point lies in them, as their own light falls: exponentially.
    const std::vector<Piece> points = pieces;
    double binsInFront = 0;
    for (std::size_t i = sums_.firstEdge[pixel]; i + 1 < sums_.firstEdge[pixel + 1]; ++i) {
        const Bin& bin = sums_.bins[i];
        const double near = sums_.edges[i], far = sums_.edges[i + 1];
        double from = near, used = 0;
        double left = n - binsInFront;
        for (const Piece& p : points)
            if (p.near < near) left -= p.stopped * n;
        const double passed =
            left > 0 ? std::clamp(1 - bin.stopped / left, 1 - mostOfMedium, 1.0) : 1;
        const auto cut = [&](double to) {
            const double at = (to - near) / (far - near);
            const double share = to >= far    ? 1
                                 : passed < 1 ? (1 - std::pow(passed, at)) / (1 - passed)
                                              : at;
            add(from, to, bin.stopped, bin.radiance, share - used);
            from = to, used = share;
        };
        for (const Piece& p : points)
            if (p.near > from && p.near < far) cut(p.near);
        cut(far);
        binsInFront += bin.stopped;
    }
    std::sort(pieces.begin(), pieces.end(), byDepth);

    return composed(pieces);
}

}  // namespace woodcock::image
