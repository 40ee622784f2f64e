// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "woodcock/base/keyframes.h"
#include "woodcock/base/polar.h"
#include "woodcock/base/toml_reader.h"

namespace woodcock::scene {

/// The curve of an animated value: `{ keys = [[frame, value], ...], interpolation = ... }`. All its
/// values are numbers, lists of equally many numbers, 4 x 4 matrices, or transforms.
class ValueCurve {
public:
    /// Whether a node is meant as a curve: a table with `keys` or `interpolation`.
    static bool is(const toml::node& node);

    /// Throws Error{Input} with the place of what is wrong.
    explicit ValueCurve(const TomlValue& value);

    const std::vector<double>& frames() const { return keys_.frames(); }
    /// The value at a frame, as TOML.
    std::string at(double frame) const;
    /// Where that value was written: the key's own place at its frame, else the curve's.
    std::string placeAt(double frame) const;

private:
    enum class Shape { Number, List, Matrix, Transform };
    std::optional<Shape> shape_;
    std::vector<PolarMap> matrices_;  ///< at the keys, of Shape::Matrix
    Keyframes keys_{{0}, {{0}}, Interpolation::Linear};
    std::string place_;
    std::vector<std::string> keyPlaces_;

    std::vector<double> read(const TomlValue& value);
    void readMatrices(const std::vector<TomlValue>& values);
    std::string matrixAt(double frame) const;
};

/// A node as TOML writes it, on one line.
std::string tomlOf(const toml::node& node);

}  // namespace woodcock::scene
