// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/animation_curve.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "woodcock/base/nearest_name.h"
#include "woodcock/base/printable.h"
#include "woodcock/base/toml_text.h"

namespace woodcock::scene {

namespace {

const std::string keysKey = "keys", interpolationKey = "interpolation";
/// Of a transform, with what they are where they are not given.
const std::array<std::pair<std::string, double>, 3> components{
    {{"translate", 0}, {"rotate", 0}, {"scale", 1}}};

Interpolation readInterpolation(const TomlTable& table) {
    const auto value = table.find(interpolationKey);
    if (!value) return Interpolation::Linear;
    const std::string word = value->text();
    const auto found = std::find(interpolationNames.begin(), interpolationNames.end(), word);
    if (found == interpolationNames.end())
        throw inputError("{}: unknown interpolation '{}'{}", value->place(), shown(word),
                         suggestName(word, "known", interpolationNames));
    return static_cast<Interpolation>(found - interpolationNames.begin());
}

std::string describe(std::size_t numbers) {
    return numbers == 1 ? "a number" : fmt::format("a list of {} numbers", numbers);
}

std::string listOf(const double* numbers, std::size_t count) {
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < count; ++i) texts.push_back(tomlNumber(numbers[i]));
    return fmt::format("[{}]", fmt::join(texts, ", "));
}

/// What would be flattened on the way: a scale must not go through 0.
void refuseZeroScale(const TomlValue& value, const std::vector<double>& before,
                     const std::vector<double>& after, std::size_t first, double frame) {
    for (std::size_t i = first; i < after.size(); ++i)
        if (before[i] * after[i] < 0)
            throw value.error(
                "scales by {} where the key of frame {} scales by {}; on the way it would be 0, "
                "and flatten what it places",
                after[i], frame, before[i]);
}

bool placesByScale(const std::string& name) {
    return name.ends_with(".scale") && (name.find(".transform.") != std::string::npos ||
                                        name.find(".instances[") != std::string::npos);
}

Quaternion turned(Quaternion q, double sign) { return {q.w * sign, q.v * sign}; }

std::vector<double> numbersOf(const PolarMap& m) {
    const auto& s = m.stretch;
    return {m.translation.x, m.translation.y, m.translation.z, m.rotation.w, m.rotation.v.x,
            m.rotation.v.y,  m.rotation.v.z,  s[0].x,          s[1].y,       s[2].z,
            s[0].y,          s[0].z,          s[1].z};
}

PolarMap polarOf(const std::vector<double>& n) {
    const double size = std::sqrt(n[3] * n[3] + n[4] * n[4] + n[5] * n[5] + n[6] * n[6]);
    return {{n[0], n[1], n[2]},
            {n[3] / size, Vec3d{n[4], n[5], n[6]} * (1 / size)},
            {Vec3d{n[7], n[10], n[11]}, {n[10], n[8], n[12]}, {n[11], n[12], n[9]}}};
}

std::string oneLine(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

}  // namespace

bool ValueCurve::is(const toml::node& node) {
    const toml::table* const table = node.as_table();
    return table && (table->contains(keysKey) || table->contains(interpolationKey));
}

ValueCurve::ValueCurve(const TomlValue& value) : place_(value.place()) {
    const TomlTable table = value.table();
    table.allowOnly({keysKey, interpolationKey}, value.name());
    const Interpolation interpolation = readInterpolation(table);
    const std::string expected = "[[frame, value], ...]";
    const std::vector<TomlValue> keys =
        table.need(keysKey, keysKey + " = [[0, 1.0], [24, 2.5]]").elements(expected);
    if (keys.size() < 2)
        throw value.error("has {}; give two or more, or the value itself",
                          keys.empty() ? "no keys" : "one key, so it does not move");
    std::vector<double> frames;
    std::vector<std::vector<double>> values;
    std::vector<TomlValue> written;
    for (const TomlValue& key : keys) {
        const auto pair = key.elements("[frame, value]", 2);
        const double frame = pair[0].number({-1e9, 1e9});
        if (!frames.empty() && !(frame > frames.back()))
            throw pair[0].error("is frame {}; it must come after {}, the frame of the key before",
                                frame, frames.back());
        values.push_back(read(pair[1]));
        if (values.back().size() != values.front().size())
            throw pair[1].error("is {}, but the first key is {}", describe(values.back().size()),
                                describe(values.front().size()));
        if (values.size() > 1 && (shape_ == Shape::Transform || placesByScale(value.name())))
            refuseZeroScale(pair[1], values[values.size() - 2], values.back(),
                            shape_ == Shape::Transform ? 6 : 0, frames.back());
        frames.push_back(frame);
        written.push_back(pair[1]);
        keyPlaces_.push_back(pair[1].place());
    }
    if (shape_ == Shape::Matrix) {
        readMatrices(written);
        for (std::size_t i = 0; i < matrices_.size(); ++i) values[i] = numbersOf(matrices_[i]);
    }
    keys_ = Keyframes(std::move(frames), std::move(values), interpolation);
}

/// The numbers of a value, which has the shape of those before.
std::vector<double> ValueCurve::read(const TomlValue& value) {
    const auto as = [&](Shape shape) {
        static const std::array<std::string, 4> names{"a number", "a list of numbers", "a matrix",
                                                      "a transform"};
        if (shape_ && *shape_ != shape)
            throw value.error("is {}, but the first key is {}",
                              names[static_cast<std::size_t>(shape)],
                              names[static_cast<std::size_t>(*shape_)]);
        shape_ = shape;
    };
    std::vector<double> numbers;
    if (value.isTable()) {
        const TomlTable table = value.table();
        std::vector<std::string> names;
        for (const auto& component : components) names.push_back(component.first);
        table.allowOnly(names, value.name() +
                                   ", a transform; other tables take keys for each of their "
                                   "own numbers");
        as(Shape::Transform);
        for (const auto& [name, otherwise] : components) {
            Vec3d v = Vec3d{1, 1, 1} * otherwise;
            if (const auto part = table.find(name))
                v = part->isArray() || name != "scale" ? part->vector()
                                                       : Vec3d{1, 1, 1} * part->number();
            numbers.insert(numbers.end(), {v.x, v.y, v.z});
        }
        return numbers;
    }
    if (!value.isArray()) {
        if (value.isText())
            throw value.error(
                "is a string; only numbers, colours, vectors, matrices and transforms have values "
                "between keys");
        as(Shape::Number);
        return {value.number()};
    }
    const auto elements = value.elements("a list of numbers");
    if (!elements.empty() && elements.front().isArray()) {
        as(Shape::Matrix);
        return {};
    }
    as(Shape::List);
    for (const TomlValue& element : elements) numbers.push_back(element.number());
    return numbers;
}

void ValueCurve::readMatrices(const std::vector<TomlValue>& values) {
    bool mirrors = false;
    for (const TomlValue& value : values) {
        const Affine3d map = value.affine();
        const bool mirrored = map.determinant() < 0;
        if (!matrices_.empty() && mirrored != mirrors)
            throw value.error("{}, and the key before does{}; on the way it would flatten space",
                              mirrored ? "mirrors" : "does not mirror", mirrored ? " not" : "");
        mirrors = mirrored;
        PolarMap polar = woodcock::polarOf(map);
        if (!matrices_.empty()) {  // of the two quaternions that are one rotation, the nearer one
            const Quaternion& a = matrices_.back().rotation;
            if (a.w * polar.rotation.w + dot(a.v, polar.rotation.v) < 0)
                polar.rotation = turned(polar.rotation, -1);
        }
        matrices_.push_back(polar);
    }
}

std::string ValueCurve::matrixAt(double frame) const {
    const auto [key, share] = keys_.placeOf(frame);
    PolarMap polar;
    switch (keys_.interpolation()) {
        case Interpolation::Linear:
            polar = between(matrices_[key], matrices_[key + 1], share);
            break;
        case Interpolation::Constant:
            polar = matrices_[share == 1 ? key + 1 : key];
            break;
        case Interpolation::Smooth:
            polar = polarOf(keys_.at(frame));
    }
    return oneLine(tomlMatrix(polar.map()));
}

std::string ValueCurve::at(double frame) const {
    if (shape_ == Shape::Matrix) return matrixAt(frame);
    const std::vector<double> numbers = keys_.at(frame);
    if (shape_ == Shape::Number) return tomlNumber(numbers[0]);
    if (shape_ == Shape::List) return listOf(numbers.data(), numbers.size());
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < components.size(); ++i)
        parts.push_back(fmt::format("{} = {}", components[i].first, listOf(&numbers[3 * i], 3)));
    return fmt::format("{{ {} }}", fmt::join(parts, ", "));
}

std::string ValueCurve::placeAt(double frame) const {
    const auto found = std::find(frames().begin(), frames().end(), frame);
    return found == frames().end() ? place_
                                   : keyPlaces_[static_cast<std::size_t>(found - frames().begin())];
}

std::string tomlOf(const toml::node& node) {
    std::vector<std::string> parts;
    if (const toml::table* table = node.as_table()) {
        for (const auto& [key, value] : *table)
            parts.push_back(fmt::format("{} = {}", std::string(key.str()), tomlOf(value)));
        return fmt::format("{{ {} }}", fmt::join(parts, ", "));
    }
    if (const toml::array* array = node.as_array()) {
        for (const toml::node& element : *array) parts.push_back(tomlOf(element));
        return fmt::format("[{}]", fmt::join(parts, ", "));
    }
    if (const auto* text = node.as_string()) return tomlText(text->get());
    if (const auto* real = node.as_floating_point()) return tomlNumber(real->get());
    std::ostringstream out;
    node.visit([&](const auto& value) {
        if constexpr (toml::is_value<decltype(value)>) out << value;
    });
    return out.str();
}

}  // namespace woodcock::scene
