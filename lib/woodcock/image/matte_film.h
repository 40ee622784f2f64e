// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "woodcock/image/cryptomatte.h"
#include "woodcock/image/film.h"
#include "woodcock/image/stopped_light.h"

namespace woodcock::image {

/// Sums of coverage over samples, for each pixel, layer and name, in double: beside a Film, which
/// counts the samples. Coverage by something is the share of the camera rays' light that it stops.
/// The coverages of a layer add up to the film's alpha, without shadows on a catcher; catchers come
/// on top.
class MatteFilm {
public:
    /// `crop` as of the Film.
    MatteFilm(Film::Window crop, std::vector<MatteLayer> layers);

    const Film::Window& crop() const { return crop_; }
    const std::vector<MatteLayer>& layers() const { return layers_; }

    void add(int x, int y, const StoppedLight& ray);
    /// Of a pixel with so many samples, each name's, in their order.
    std::vector<double> coverage(std::size_t layer, int x, int y, std::uint64_t samples) const;
    /// The pixel's `matteChannels()`.
    void ranks(std::size_t layer, int x, int y, std::uint64_t samples, std::span<float> to) const;

    /// Whether another film is of the same crop, with the same layers and names.
    bool isLike(const MatteFilm& other) const;
    /// Takes the sums of one like this in place of its own; it need not know the owners.
    void takeSums(MatteFilm&& other) { sums_ = std::move(other.sums_); }

    /// Everything that samples have added to: see Film::planes(). One plane for each layer, with
    /// the names as its components.
    std::vector<Film::Plane> planes();
    std::vector<Film::ConstPlane> planes() const;
    /// Bytes of a pixel.
    static double bytesPerPixel(const std::vector<MatteLayer>& layers);

private:
    std::size_t first(std::size_t layer, int x, int y) const;

    Film::Window crop_;
    std::vector<MatteLayer> layers_;
    std::vector<std::vector<double>> sums_;  // by layer; pixel by pixel, names innermost
};

/// Layers and their names, for files: JSON. Empty: there are none.
std::string matteNamesText(const std::vector<MatteLayer>& layers);
/// The layers of such a text, whose names have no owners. Nothing: it is no such text.
std::optional<std::vector<MatteLayer>> matteLayersOf(const std::string& text);

}  // namespace woodcock::image
