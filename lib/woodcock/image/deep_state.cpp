// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/deep_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"

namespace woodcock::image {

namespace {

constexpr const char* errorFact = "deepError";
constexpr const char* edgesFact = "deepEdges";
constexpr const char* pointsFact = "deepPoints";
constexpr std::int64_t mostOfPixel = 1 << 20;

std::size_t areaOf(const Film::Window& w) {
    return static_cast<std::size_t>(w.width()) * static_cast<std::size_t>(w.height());
}

std::size_t shareOf(std::size_t count, std::size_t pixels) { return (count + pixels - 1) / pixels; }

}  // namespace

DeepState::DeepState(const DeepFilm& film)
    : crop_(film.crop()), error_(film.error()), binsOfFilm_(film.sums().bins.data()) {
    const DeepSums& sums = film.sums();
    for (std::size_t i = 0; i < sums.points.size(); ++i) {
        edgeCounts_.push_back(sums.firstEdge[i + 1] - sums.firstEdge[i]);
        pointCounts_.push_back(sums.points[i].size());
        for (const DeepSums::Point& p : sums.points[i])
            points_.push_back({double(p.owner),
                               p.depths,
                               p.hits,
                               p.stopped,
                               p.caught,
                               {p.radiance[0], p.radiance[1], p.radiance[2]}});
    }
    edges_.assign(sums.edges.begin(), sums.edges.end());
    edgeShare_ = shareOf(edges_.size(), pixels()), pointShare_ = shareOf(points_.size(), pixels());
    edges_.resize(edgeShare_ * pixels()), points_.resize(pointShare_ * pixels());
}

DeepState::DeepState(const StateFile& file) : crop_(file.window()), error_(file.number(errorFact)) {
    const std::size_t pixels = areaOf(crop_);
    const auto share = [&](const char* fact) {
        const std::int64_t most = mostOfPixel * static_cast<std::int64_t>(pixels);
        return shareOf(static_cast<std::size_t>(file.count(fact, 0, most)), pixels);
    };
    edgeShare_ = share(edgesFact), pointShare_ = share(pointsFact);
    const double bytes =
        double(pixels) * (2.0 * sizeof(std::uint64_t) + sizeof(std::vector<DeepSums::Point>) +
                          double(edgeShare_) * (sizeof(double) + sizeof(DeepSums::Bin)) +
                          double(pointShare_) * (sizeof(Point) + sizeof(DeepSums::Point)));
    if (const auto possible = 0.9 * static_cast<double>(memoryLeft()); bytes > possible)
        throw file.unreadable(fmt::format("its deep pixels need {} of memory, and there are {}",
                                          formatGiB(bytes), formatGiB(possible)));
    edgeCounts_.resize(pixels), pointCounts_.resize(pixels);
    edges_.resize(edgeShare_ * pixels), bins_.resize(edgeShare_ * pixels);
    points_.resize(pointShare_ * pixels);
}

bool DeepState::isIn(const StateFile& file) { return file.has(errorFact); }

StateFacts DeepState::facts() const {
    const auto sum = [](const std::vector<std::uint64_t>& counts) {
        std::uint64_t all = 0;
        for (const std::uint64_t count : counts) all += count;
        return fmt::format("{}", all);
    };
    return {{errorFact, fmt::format("{}", error_)},
            {edgesFact, sum(edgeCounts_)},
            {pointsFact, sum(pointCounts_)}};
}

template <typename Plane, typename Self, typename Bin>
std::vector<Plane> DeepState::planesOf(Self& state, Bin* bins) {
    std::vector<Plane> planes{{"deepEdges", 1, 1, nullptr, state.edgeCounts_.data()},
                              {"deepPoints", 1, 1, nullptr, state.pointCounts_.data()}};
    const auto list = [&](const char* name, std::size_t share, auto* first) {
        constexpr std::size_t numbers = sizeof(*first) / sizeof(double);
        const std::size_t ofPixel = share * numbers;
        using Sum = std::remove_pointer_t<decltype(Plane::sums)>;
        if (share > 0)
            planes.push_back(
                {name, static_cast<int>(ofPixel), ofPixel, reinterpret_cast<Sum*>(first), nullptr});
    };
    list("deepEdge", state.edgeShare_, state.edges_.data());
    list("deepBin", state.edgeShare_, bins);
    list("deepPoint", state.pointShare_, state.points_.data());
    return planes;
}

std::vector<Film::ConstPlane> DeepState::planes() const {
    return planesOf<Film::ConstPlane>(*this, binsOfFilm_ ? binsOfFilm_ : bins_.data());
}

std::vector<Film::Plane> DeepState::planes() { return planesOf<Film::Plane>(*this, bins_.data()); }

DeepFilm DeepState::film(const StateFile& file) {
    const auto require = [&](bool sound) {
        if (!sound) throw file.unreadable("its deep pixels make no sense");
    };
    require(error_ > 0 && error_ < 1);
    DeepSums sums;
    sums.points.reserve(pixels());
    std::size_t edge = 0, point = 0;
    for (std::size_t i = 0; i < pixels(); ++i) {
        sums.firstEdge.push_back(edge);
        require(edgeCounts_[i] != 1 && edgeCounts_[i] <= edges_.size() - edge);
        const auto first = edges_.begin() + static_cast<std::ptrdiff_t>(edge);
        const auto end = first + static_cast<std::ptrdiff_t>(edgeCounts_[i]);
        require(std::is_sorted(first, end) && std::all_of(first, end, [](double depth) {
                    return depth >= 0 && std::isfinite(static_cast<float>(depth));
                }));
        for (auto depth = first; depth != end; ++depth)
            sums.edges.push_back(static_cast<float>(*depth));
        edge += edgeCounts_[i];

        require(pointCounts_[i] <= std::min(DeepFilm::mostPoints, points_.size() - point));
        std::vector<DeepSums::Point>& points = sums.points.emplace_back();
        for (; points.size() < pointCounts_[i]; ++point) {
            const Point& p = points_[point];
            require(p.owner >= 0 && p.owner <= StoppedLight::lamp && p.hits >= 1 && p.depths >= 0 &&
                    std::isfinite(p.depths / p.hits));
            points.push_back({static_cast<std::uint32_t>(p.owner),
                              p.depths,
                              p.hits,
                              p.stopped,
                              p.caught,
                              {p.radiance[0], p.radiance[1], p.radiance[2]}});
        }
    }
    sums.firstEdge.push_back(edge);
    sums.bins = std::move(bins_);
    return DeepFilm(crop_, error_, std::move(sums));
}

}  // namespace woodcock::image
