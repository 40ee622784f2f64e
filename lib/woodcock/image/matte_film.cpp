// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/matte_film.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

namespace woodcock::image {

MatteFilm::MatteFilm(Film::Window crop, std::vector<MatteLayer> layers)
    : crop_(crop), layers_(std::move(layers)) {
    const std::size_t pixels =
        static_cast<std::size_t>(crop.width()) * static_cast<std::size_t>(crop.height());
    for (const MatteLayer& layer : layers_) sums_.emplace_back(pixels * layer.names.size());
}

std::size_t MatteFilm::first(std::size_t layer, int x, int y) const {
    const std::size_t pixel =
        static_cast<std::size_t>(y - crop_.y0) * static_cast<std::size_t>(crop_.width()) +
        static_cast<std::size_t>(x - crop_.x0);
    return pixel * layers_[layer].names.size();
}

void MatteFilm::add(int x, int y, const StoppedLight& ray) {
    for (std::size_t layer = 0; layer < layers_.size(); ++layer) {
        double* const sums = &sums_[layer][first(layer, x, y)];
        for (const StoppedLight::Stop& stop : ray.stops)
            sums[layers_[layer].nameOf.at(stop.owner)] += stop.amount();
    }
}

std::vector<double> MatteFilm::coverage(std::size_t layer, int x, int y,
                                        std::uint64_t samples) const {
    std::vector<double> coverage(layers_[layer].names.size());
    if (samples == 0) return coverage;
    const double* const sums = &sums_[layer][first(layer, x, y)];
    for (std::size_t i = 0; i < coverage.size(); ++i)
        coverage[i] = sums[i] / static_cast<double>(samples);
    return coverage;
}

void MatteFilm::ranks(std::size_t layer, int x, int y, std::uint64_t samples,
                      std::span<float> to) const {
    const std::vector<double> all = coverage(layer, x, y, samples);
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::erase_if(order, [&](std::size_t i) { return !(all[i] > 0); });
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return all[a] > all[b]; });
    std::fill(to.begin(), to.end(), 0.0f);
    for (std::size_t rank = 0; rank < std::min<std::size_t>(order.size(), matteRanks); ++rank) {
        to[2 * rank] = matteId(layers_[layer].names[order[rank]]);
        to[2 * rank + 1] = static_cast<float>(all[order[rank]]);
    }
}

bool MatteFilm::isLike(const MatteFilm& other) const {
    return crop_ == other.crop_ &&
           std::equal(layers_.begin(), layers_.end(), other.layers_.begin(), other.layers_.end(),
                      [](const MatteLayer& a, const MatteLayer& b) {
                          return a.name == b.name && a.names == b.names;
                      });
}

std::vector<Film::Plane> MatteFilm::planes() {
    std::vector<Film::Plane> planes;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        const std::size_t names = layers_[i].names.size();
        planes.push_back({layers_[i].name, static_cast<int>(names), names, sums_[i].data()});
    }
    return planes;
}

std::vector<Film::ConstPlane> MatteFilm::planes() const {
    std::vector<Film::ConstPlane> planes;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        const std::size_t names = layers_[i].names.size();
        planes.push_back({layers_[i].name, static_cast<int>(names), names, sums_[i].data()});
    }
    return planes;
}

double MatteFilm::bytesPerPixel(const std::vector<MatteLayer>& layers) {
    double bytes = 0;
    for (const MatteLayer& layer : layers)
        bytes += sizeof(double) * static_cast<double>(layer.names.size());
    return bytes;
}

std::string matteNamesText(const std::vector<MatteLayer>& layers) {
    if (layers.empty()) return "";
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const MatteLayer& layer : layers)
        all.push_back({{"layer", layer.name}, {"names", layer.names}});
    return all.dump();
}

std::optional<std::vector<MatteLayer>> matteLayersOf(const std::string& text) {
    std::vector<MatteLayer> layers;
    if (text.empty()) return layers;
    try {
        for (const nlohmann::json& layer : nlohmann::json::parse(text))
            layers.push_back({layer.at("layer"), layer.at("names"), {}});
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    }
    return layers;
}

}  // namespace woodcock::image
