// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/toml_reader.h"

#include <cmath>
#include <fstream>

#include "woodcock/base/nearest_name.h"
#include "woodcock/base/path_variables.h"
#include "woodcock/base/printable.h"
#include "woodcock/base/toml_nesting.h"

namespace woodcock {
namespace {

constexpr std::uintmax_t largestFile = 4 << 20;

std::string_view typeName(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::string:
            return "a string";
        case toml::node_type::integer:
            return "an integer";
        case toml::node_type::floating_point:
            return "a float";
        case toml::node_type::boolean:
            return "a boolean";
        default:
            return "a date or time";
    }
}

}  // namespace

std::string NumberRange::demand(double v) const {
    const NumberRange all;
    if (lower != all.lower && upper < std::numeric_limits<float>::max())
        return fmt::format("must lie {} {} and {}", strict ? "strictly between" : "between", lower,
                           upper);
    if (v > lower) return fmt::format("must be {} {}", strict ? "less than" : "at most", upper);
    if (lower == 0) return strict ? "must be positive" : "must not be negative";
    return fmt::format("must be {} {}", strict ? "more than" : "at least", lower);
}

std::string placeOf(const toml::source_region& source) {
    const std::string path = source.path ? *source.path : std::string();
    const bool whole = path.starts_with(overrideMark) || path.starts_with(frameMark.substr(2)) ||
                       path.find(frameMark) != std::string::npos;
    if (whole) return path;
    return fmt::format("{}:{}:{}", path, source.begin.line, source.begin.column);
}

toml::table parseToml(std::string_view text, const std::string& name) {
    refuseDeepKeys(text, name);
    try {
        return toml::parse(text, name);
    } catch (const toml::parse_error& e) {
        throw inputError("{}: {}", placeOf(e.source()), e.description());
    }
}

std::string readTomlFile(const std::filesystem::path& file, std::string_view what) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status))
        throw inputError("{} '{}' does not exist", what, file.string());
    if (std::filesystem::is_directory(status))
        throw inputError("{} '{}' is a directory", what, file.string());
    const auto tooLarge = [&] {
        return inputError("{} '{}' is larger than {} MB: is it a {}?", what, file.string(),
                          largestFile >> 20, what);
    };
    if (std::filesystem::is_regular_file(status) &&
        std::filesystem::file_size(file, error) > largestFile)
        throw tooLarge();
    // Pipes are read too, for a script may write the text. Some pipes would never end.
    std::ifstream stream(file, std::ios::binary);
    std::string text(largestFile + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!stream.is_open() || stream.bad())
        throw inputError("{} '{}' cannot be read", what, file.string());
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.size() > largestFile) throw tooLarge();
    return text;
}

Error TomlValue::wrongType(std::string_view expected) const {
    return error("is {}; expected {}", typeName(*node_), expected);
}

bool TomlValue::isAtFrame() const {
    const auto& path = node_->source().path;
    return path && path->find(frameMark) != std::string::npos;
}

double TomlValue::number(NumberRange range) const {
    double v = 0;
    if (const auto* integer = node_->as_integer())
        v = static_cast<double>(integer->get());
    else if (const auto* real = node_->as_floating_point())
        v = real->get();
    else
        throw wrongType("a number");
    if (!std::isfinite(v)) throw error("is {}; it must be finite", v);
    if (!range.contains(v)) throw error("is {}; it {}", v, range.demand(v));
    return v;
}

int TomlValue::integer(int lower, int upper) const {
    const auto* value = node_->as_integer();
    if (!value) throw wrongType("an integer");
    if (value->get() < lower || value->get() > upper)
        throw error("is {}; it must lie between {} and {}", value->get(), lower, upper);
    return static_cast<int>(value->get());
}

std::uint64_t TomlValue::count() const {
    const auto* value = node_->as_integer();
    if (!value) throw wrongType("an integer");
    if (value->get() < 0) throw error("is {}; it must not be negative", value->get());
    return static_cast<std::uint64_t>(value->get());
}

bool TomlValue::flag() const {
    const auto* value = node_->as_boolean();
    if (!value) throw wrongType("true or false");
    return value->get();
}

std::string TomlValue::text() const {
    const auto* value = node_->as_string();
    if (!value) throw wrongType("a string");
    if (value->get().empty()) throw error("is empty; give a name or leave the key out");
    return value->get();
}

std::string TomlValue::timeText(std::string_view expected) const {
    if (const auto* date = node_->as_date())
        return fmt::format("{:04}-{:02}-{:02}", date->get().year, date->get().month,
                           date->get().day);
    if (const auto* time = node_->as_time())
        return fmt::format("{:02}:{:02}:{:02}", time->get().hour, time->get().minute,
                           time->get().second);
    if (!isText()) throw wrongType(expected);
    return text();
}

TomlValue TomlValue::element(size_t i) const {
    return {*node_->as_array()->get(i), fmt::format("{}[{}]", name_, i)};
}

std::vector<TomlValue> TomlValue::elements(std::string_view expected,
                                           std::optional<size_t> size) const {
    const auto* array = node_->as_array();
    if (!array) throw wrongType(expected);
    if (size && array->size() != *size)
        throw error("has {} element{}; expected {}", array->size(), array->size() == 1 ? "" : "s",
                    expected);
    std::vector<TomlValue> values;
    for (size_t i = 0; i < array->size(); ++i) values.push_back(element(i));
    return values;
}

Vec3d TomlValue::vector() const {
    const auto v = elements("[x, y, z]", 3);
    return {v[0].number(), v[1].number(), v[2].number()};
}

Vec3d TomlValue::exactColour(NumberRange range) const {
    range.upper = std::min<double>(range.upper, std::numeric_limits<float>::max());
    if (node_->is_number()) return Vec3d{1, 1, 1} * number(range);
    const auto v = elements("a number or [r, g, b]", 3);
    return {v[0].number(range), v[1].number(range), v[2].number(range)};
}

Rgb TomlValue::colour(NumberRange range) const {
    const Vec3d v = exactColour(range);
    return Rgb::map([&](int i) { return static_cast<float>(v[i]); });
}

Affine3d TomlValue::affine() const {
    const auto rows = elements("four rows of four numbers", 4);
    double m[4][4];
    for (size_t i = 0; i < 4; ++i) {
        const auto row = rows[i].elements("a row of four numbers", 4);
        for (size_t j = 0; j < 4; ++j) m[i][j] = row[j].number();
    }
    if (m[3][0] != 0 || m[3][1] != 0 || m[3][2] != 0 || m[3][3] != 1)
        throw error(
            "is not affine: its last row is [{}, {}, {}, {}] instead of [0, 0, 0, 1] "
            "(the translation is the last column)",
            m[3][0], m[3][1], m[3][2], m[3][3]);
    Affine3d map;
    for (size_t j = 0; j < 3; ++j) map.column[j] = {m[0][j], m[1][j], m[2][j]};
    map.translation = {m[0][3], m[1][3], m[2][3]};
    if (const std::string flaw = flawOf(map); !flaw.empty()) throw error("{}", flaw);
    return map;
}

std::filesystem::path TomlValue::path(const std::filesystem::path& base) const {
    const std::string written = text();
    std::filesystem::path expanded;
    try {
        expanded = expandPath(written);
    } catch (const Error& e) {
        throw error("is '{}': {}", shown(written), e.what());
    }
    const bool overridden = place().starts_with(overrideMark);
    return (overridden ? expanded : base / expanded).lexically_normal();
}

size_t TomlValue::choice(std::string_view what, std::span<const std::string> known) const {
    const std::string word = text();
    for (size_t i = 0; i < known.size(); ++i)
        if (known[i] == word) return i;
    throw inputError("{}: unknown {} '{}'; known: {}", place(), what, shown(word),
                     joinNames(known));
}

TomlTable TomlValue::table() const {
    const auto* table = node_->as_table();
    if (!table) throw wrongType("a table");
    return {*table, name_};
}

std::vector<std::string> TomlTable::keys() const {
    std::vector<std::string> keys;
    for (const auto& entry : *table_) keys.emplace_back(entry.first.str());
    return keys;
}

std::optional<TomlValue> TomlTable::find(std::string_view key) const {
    const toml::node* node = table_->get(key);
    if (!node) return std::nullopt;
    return TomlValue(*node,
                     fmt::format("{}{}{}", name_, name_.empty() ? "" : ".", shown(key, 100)));
}

TomlValue TomlTable::need(std::string_view key, std::string_view example) const {
    if (const auto value = find(key)) return *value;
    throw error("has no {}; give one, such as {}", key, example);
}

void TomlTable::allowOnly(const std::vector<std::string>& known, std::string_view where) const {
    // The table is sorted by name; the user wants the first unknown key of the file.
    const toml::key* first = nullptr;
    const auto position = [](const toml::key& k) {
        return std::pair(k.source().begin.line, k.source().begin.column);
    };
    for (const auto& [key, node] : *table_) {
        const bool isKnown = std::find(known.begin(), known.end(), key.str()) != known.end();
        if (!isKnown && (!first || position(key) < position(*first))) first = &key;
    }
    if (first)
        throw inputError("{}: unknown key '{}' in {}{}", placeOf(first->source()),
                         shown(first->str()), where,
                         suggestName(first->str(), "known keys", known));
}

void TomlTable::exclude(std::string_view key, std::string_view other, std::string_view why) const {
    if (has(key) && has(other))
        throw find(key)->error("cannot be used together with {}; give one of them: {}", other, why);
}

}  // namespace woodcock
