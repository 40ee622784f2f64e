// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/base/error.h"
#include "woodcock/base/spectrum.h"

namespace woodcock {

// How scenes and recipes are read from TOML: every value knows its place in the file and its name
// in messages, and throws Error{Input} when it is not what was expected.

/// The source path of values that come from an override starts with this.
inline constexpr std::string_view overrideMark = "--set ";

/// That of values of an animated key ends with this and the frame: "scene.toml:12:9, at frame 24".
inline constexpr std::string_view frameMark = ", at frame ";

/// "scene.toml:12:9", or the whole override ("--set volume[0].g=1.5") where the text is one, or
/// with the frame of an animated value.
std::string placeOf(const toml::source_region& source);

/// The numbers that a key accepts; the default accepts every finite number.
struct NumberRange {
    double lower = std::numeric_limits<double>::lowest();
    double upper = std::numeric_limits<double>::max();
    bool strict = false;  ///< the bounds themselves are left out

    bool contains(double v) const {
        return strict ? v > lower && v < upper : v >= lower && v <= upper;
    }
    /// The demand on a number outside of the range, such as "must not be negative".
    std::string demand(double v) const;
};
inline constexpr NumberRange notNegative{0};
inline constexpr NumberRange positive{.lower = 0, .strict = true};

class TomlTable;

/// Parses a text; `name` is the file's name in messages. Errors: Input, with the place.
toml::table parseToml(std::string_view text, const std::string& name);

/// The text of a small file; `what` names its kind ("scene file") in messages. Errors: Input when
/// it is missing, unreadable, or larger than anybody writes.
std::string readTomlFile(const std::filesystem::path& file, std::string_view what);

/// A value of the file, named by its path of keys, such as "volume[0].scale".
class TomlValue {
public:
    TomlValue(const toml::node& node, std::string name) : node_(&node), name_(std::move(name)) {}

    const std::string& name() const { return name_; }
    std::string place() const { return placeOf(node_->source()); }
    bool isTable() const { return node_->is_table(); }
    bool isText() const { return node_->is_string(); }
    bool isArray() const { return node_->is_array(); }
    /// Whether it is the value of an animated key at a frame.
    bool isAtFrame() const;

    double number(NumberRange range = {}) const;
    int integer(int lower, int upper) const;
    std::uint64_t count() const;  ///< a non-negative integer
    bool flag() const;
    std::string text() const;  ///< not empty
    /// Of a date or a time of day, as TOML writes it: "2026-06-21", "14:30:00"; or of a string that
    /// stands for one. `expected` describes it in messages.
    std::string timeText(std::string_view expected) const;
    Vec3d vector() const;
    Rgb colour(NumberRange range) const;  ///< from a number or [r, g, b]
    Vec3d exactColour(NumberRange range) const;
    Affine3d affine() const;  ///< from four rows of four, regular
    /// A path with ~ and variables expanded, relative to `base` (in an override: to the working
    /// directory).
    std::filesystem::path path(const std::filesystem::path& base) const;
    /// The index of this text in `known`; `what` names the kind of choice ("light type").
    size_t choice(std::string_view what, std::span<const std::string> known) const;
    TomlValue element(size_t i) const;
    /// The elements of an array, `size` of them if given. `expected` describes the array in
    /// messages.
    std::vector<TomlValue> elements(std::string_view expected,
                                    std::optional<size_t> size = {}) const;
    TomlTable table() const;

    /// "place: name message".
    template <class... A>
    Error error(fmt::format_string<A...> message, A&&... args) const {
        return inputError("{}: {} {}", place(), name_,
                          fmt::format(message, std::forward<A>(args)...));
    }

private:
    Error wrongType(std::string_view expected) const;

    const toml::node* node_;
    std::string name_;
};

/// A table of the file.
class TomlTable {
public:
    /// `name` is empty for the file itself.
    TomlTable(const toml::table& table, std::string name)
        : table_(&table), name_(std::move(name)) {}

    const std::string& name() const { return name_; }
    std::string place() const { return placeOf(table_->source()); }
    bool has(std::string_view key) const { return table_->contains(key); }
    std::vector<std::string> keys() const;
    std::optional<TomlValue> find(std::string_view key) const;
    /// Throws when there is no such key; `example` shows how to give it.
    TomlValue need(std::string_view key, std::string_view example) const;
    /// Throws on the first key of the file that is not `known`; `where` names the table to the
    /// user.
    void allowOnly(const std::vector<std::string>& known, std::string_view where) const;
    /// Throws when both keys are there.
    void exclude(std::string_view key, std::string_view other, std::string_view why) const;

    template <class... A>
    Error error(fmt::format_string<A...> message, A&&... args) const {
        return inputError("{}: {} {}", place(), name_,
                          fmt::format(message, std::forward<A>(args)...));
    }

private:
    const toml::table* table_;
    std::string name_;
};

}  // namespace woodcock
