// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "woodcock/base/path_variables.h"
#include "woodcock/base/toml_reader.h"
#include "woodcock/base/toml_text.h"

namespace woodcock::scene {

// A key of a scene file is written once, in the table of its section: <section>_keys.cpp of this
// folder. Parsing, the keys that messages list, --set, --write-scene, the digest of a scene and the
// tables of the guide (data/scenes/README.md) all follow from that entry.

/// Lines of a scene file.
class SceneWriter {
public:
    /// A file for people, or the text that a digest is taken of: without comments, with all paths
    /// absolute, and with what the image does not show at its defaults.
    enum class Mode { File, Digest };
    SceneWriter(const std::filesystem::path& directory, Mode mode)
        : directory_(directory), digest_(mode == Mode::Digest) {}

    bool isDigest() const { return digest_; }

    void heading(std::string_view text) {
        text_ += fmt::format("{}{}\n", text_.empty() ? "" : "\n", text);
    }
    void line(std::string_view key, std::string_view value, std::string_view comment = "") {
        text_ += fmt::format("{} = {}", key, value);
        if (!digest_ && !comment.empty()) text_ += fmt::format("  # {}", comment);
        text_ += '\n';
    }
    void comment(std::string_view text) {
        if (!digest_) text_ += fmt::format("# {}\n", text);
    }
    const std::string& text() const { return text_; }
    /// A writer of its kind, with nothing written yet.
    SceneWriter empty() const { return {directory_, digest_ ? Mode::Digest : Mode::File}; }
    /// Adds lines that such a writer wrote.
    void append(std::string_view lines) {
        if (!text_.empty()) text_ += '\n';
        text_ += lines;
    }

    /// A path inside a value.
    std::string quoted(const std::filesystem::path& p) const {
        namespace fs = std::filesystem;
        if (digest_) return tomlText(escapePath(fs::absolute(p).lexically_normal()));
        const bool here = directory_.empty() || directory_ == ".";
        if (here || p.is_absolute()) return tomlText(escapePath(p));
        return tomlText(escapePath(fs::absolute(p).lexically_normal().lexically_proximate(
            fs::absolute(directory_ / "").lexically_normal())));
    }

private:
    std::filesystem::path directory_;
    bool digest_;
    std::string text_;
};

/// What is said of a key, whatever it is a key of.
struct KeyInfo {
    std::string name = {};
    std::string doc = {};       ///< what it says, for the guide
    std::string type = {};      ///< in the guide's words; empty: that of its kind of value
    std::string fallback = {};  ///< in the guide's words; empty: that of the described structure
    std::string comment = {};   ///< stands behind the value where it is written
    /// TOML of a value that is not the default; empty: one of `examples`.
    std::string example = {};
    /// The lines beside the key, in an example; absent: those of its table.
    std::optional<std::string> beside = {};
    bool required = false;
    bool always = false;      ///< it is written where it is at its default too
    bool inDigest = true;     ///< it has a say in what the image shows
    bool permission = false;  ///< it allows another key its value, and says nothing itself
    bool choice = false;      ///< it trades accuracy for time: a quality may set it
    bool moves = false;       ///< it may be animated
    bool method = false;      ///< no choice, but how a picture is found rather than what it shows
    std::vector<std::string> examples = {};  ///< of its kind of value
};

/// Members of a description that are names of files.
using Files = std::vector<std::filesystem::path*>;

/// A kind of value: how it is read, with relative paths from a base, and how TOML writes it.
template <class T>
struct Value {
    std::string type;  ///< in the guide's words: "integer >= 0"
    std::vector<std::string> examples;
    std::function<T(const TomlValue&, const std::filesystem::path&)> read;
    std::function<std::string(const T&, const SceneWriter&)> write;
    /// Adds the files that a value names; absent: it names none.
    std::function<void(T&, Files&)> files = {};
    bool moves = false;  ///< numbers between which others lie: it may be animated
};

/// The text of a value, and what is said of it behind.
struct Written {
    std::string value, comment = {};
};

/// A key of a table that describes a D.
template <class D>
struct Key {
    KeyInfo info;
    std::function<void(const TomlValue&, D&, const std::filesystem::path&)> read;
    /// Nothing where there is nothing to say. Keys that say in another way what a key says are
    /// never written; they have no such function.
    std::function<std::optional<Written>(const D&, const SceneWriter&)> write;
    /// The member of a D that holds the value; null where this D has none. Absent: no one member
    /// does.
    std::function<const void*(const D&)> member = {};
    /// Adds the files that the value names; absent: it names none.
    std::function<void(D&, Files&)> files = {};
    /// Whether this D's value changes the expected picture; of choices. Absent: no value does.
    std::function<bool(const D&)> biased = {};
    /// Whether a D has this key at all; absent: every one has.
    std::function<bool(const D&)> belongs = {};
};

/// Two keys that say the same.
struct Exclusion {
    std::string key, other, why;
};

/// The keys of one table of a scene file, in the order in which they are read and written.
template <class D>
struct KeyTable {
    std::string id = {};     ///< "volume.blackbody": the guide's table
    std::string where = {};  ///< "[render]", as messages say it; empty: named by its path
    std::string tag = {};    ///< of a light or a material: its type
    std::vector<Exclusion> exclusions = {};
    std::vector<Key<D>> keys = {};
    /// What keys say together: refuses contradictions, and fills in what follows.
    std::function<void(const TomlTable&, D&)> check = {};
    /// A scene in which this table stands last, and may be continued: all before its own lines; and
    /// then the least of those.
    std::string outer = {}, least = {};
    std::string path = {};  ///< of the table there: "volume[0].blackbody"
};

/// The table of D; specialised in <section>_keys.cpp.
template <class D>
const KeyTable<D>& keysOf();

/// The name of the key that says a member of `d`: "max_bounces" of render.maxBounces. Of a kind of
/// a variant, the key that chooses it. Throws Error{Usage} where no key says the member.
template <class D, class Member>
const std::string& keyName(const D& d, const Member& member) {
    for (const Key<D>& key : keysOf<D>().keys)
        if (key.member && key.member(d) == static_cast<const void*>(&member)) return key.info.name;
    throw usageError("no key of '{}' says this member", keysOf<D>().id);
}

/// Adds the files that `d` names.
template <class D>
void addFiles(D& d, Files& files) {
    for (const Key<D>& key : keysOf<D>().keys)
        if (key.files) key.files(d, files);
}

/// Whether `d` has the key.
template <class D>
bool belongs(const Key<D>& key, const D& d) {
    return !key.belongs || key.belongs(d);
}

/// Adds the names of the keys that `d` has, each once.
template <class D>
void addNames(const D& d, std::vector<std::string>& names) {
    for (const Key<D>& key : keysOf<D>().keys)
        if (belongs(key, d) && std::find(names.begin(), names.end(), key.info.name) == names.end())
            names.push_back(key.info.name);
}

/// Throws Error{Input} where `table` holds a key that `d` does not have, nor `others`; `where`
/// names the table in the message.
template <class D>
void allowKeys(const TomlTable& table, const D& d, std::string_view where,
               std::vector<std::string> others = {}) {
    addNames(d, others);
    table.allowOnly(others, where);
}

/// Throws Error{Input} where `value`, or an element of it, is an animated value (see animation.h),
/// and the key's cannot be. `table` is that of the key.
void refuseMotion(const TomlValue& value, const KeyInfo& info,
                  const std::function<std::vector<std::string>()>& movingNames,
                  const TomlTable& table);

/// The keys of `d` that may be animated.
template <class D>
std::vector<std::string> movingNames(const D& d) {
    std::vector<std::string> names;
    for (const Key<D>& key : keysOf<D>().keys)
        if (key.info.moves && belongs(key, d) &&
            std::find(names.begin(), names.end(), key.info.name) == names.end())
            names.push_back(key.info.name);
    return names;
}

/// Reads what `table` says into `d`, all of whose keys are known. Throws Error{Input}.
template <class D>
void readAllowed(const TomlTable& table, D& d, const std::filesystem::path& base) {
    const KeyTable<D>& keys = keysOf<D>();
    for (const Exclusion& e : keys.exclusions) table.exclude(e.key, e.other, e.why);
    for (const Key<D>& key : keys.keys) {
        const std::string& name = key.info.name;
        if (key.info.required) table.need(name, name + " = " + key.info.example);
        const auto value = table.find(name);
        if (!value) continue;
        refuseMotion(
            *value, key.info, [&] { return movingNames(d); }, table);
        if (key.read) key.read(*value, d, base);
    }
    if (keys.check) keys.check(table, d);
}

/// The same where some may not be; `others` are keys that are read elsewhere.
template <class D>
void readKeys(const TomlTable& table, D& d, const std::filesystem::path& base,
              std::vector<std::string> others = {}) {
    const std::string& where = keysOf<D>().where;
    allowKeys(table, d, where.empty() ? table.name() : where, std::move(others));
    readAllowed(table, d, base);
}

/// Calls line(info, written) for all keys that `d` gives something to say.
template <class D, class Line>
void forWritten(const D& d, const SceneWriter& out, Line line) {
    const D defaults{};
    for (const Key<D>& key : keysOf<D>().keys) {
        if (!key.write || !belongs(key, d)) continue;
        const bool silent = out.isDigest() && !key.info.inDigest;
        if (const auto written = key.write(silent ? defaults : d, out)) line(key.info, *written);
    }
}

/// Writes `d` as lines of a table.
template <class D>
void writeKeys(SceneWriter& out, const D& d) {
    forWritten(d, out, [&](const KeyInfo& info, const Written& written) {
        out.line(info.name, written.value, written.comment);
    });
}

/// `d` as a table in one line.
template <class D>
std::string inlineTable(const D& d, const SceneWriter& out) {
    std::vector<std::string> items;
    forWritten(d, out, [&](const KeyInfo& info, const Written& written) {
        items.push_back(info.name + " = " + written.value);
    });
    return items.empty() ? "{}" : fmt::format("{{ {} }}", fmt::join(items, ", "));
}

/// A table of its own as the value of a key.
template <class D>
Value<D> nested() {
    return {"table",
            {},
            [](const TomlValue& value, const std::filesystem::path& base) {
                D d{};
                readKeys(value.table(), d, base);
                return d;
            },
            [](const D& d, const SceneWriter& out) { return inlineTable(d, out); },
            [](D& d, Files& files) { addFiles(d, files); }};
}

template <class T>
inline constexpr bool isOptional = false;
template <class T>
inline constexpr bool isOptional<std::optional<T>> = true;

/// A key whose value is what access(D&) points to: a T or an std::optional<T>. A null pointer: this
/// D has no such value; it is neither read nor written.
template <class D, class T, class Access>
Key<D> keyAt(KeyInfo info, Access access, Value<T> value) {
    using Member = std::remove_cvref_t<decltype(*access(std::declval<const D&>()))>;
    constexpr bool optional = isOptional<Member>;
    if (info.type.empty()) info.type = value.type;
    info.examples = value.examples;
    info.moves |= value.moves;
    if (info.fallback.empty() && !info.required) {
        const D defaults{};
        const auto* member = access(std::as_const(defaults));
        if constexpr (optional)
            info.fallback = "none";
        else if (member)
            info.fallback = value.write(*member, SceneWriter(".", SceneWriter::Mode::File));
    }
    Key<D> key{info, {}, {}};
    key.member = [=](const D& d) { return static_cast<const void*>(access(d)); };
    if (value.files)
        key.files = [=](D& d, Files& files) {
            // Found in a constant D: looking must not make the member.
            auto* member = const_cast<Member*>(access(std::as_const(d)));
            if constexpr (optional) {
                if (member && *member) value.files(**member, files);
            } else {
                if (member) value.files(*member, files);
            }
        };
    key.read = [=](const TomlValue& v, D& d, const std::filesystem::path& base) {
        if (auto* member = access(d)) *member = value.read(v, base);
    };
    key.write = [=](const D& d, const SceneWriter& out) -> std::optional<Written> {
        const auto* member = access(d);
        if (!member) return std::nullopt;
        if constexpr (optional) {
            if (!*member) return std::nullopt;
            return Written{value.write(**member, out), info.comment};
        } else {
            const D defaults{};
            const auto* fallback = access(std::as_const(defaults));
            if (!info.always && *member == (fallback ? *fallback : Member{})) return std::nullopt;
            return Written{value.write(*member, out), info.comment};
        }
    };
    return key;
}

template <class D, class M, class T>
Key<D> key(KeyInfo info, M D::*member, Value<T> value) {
    return keyAt<D, T>(
        std::move(info), [member](auto& d) { return &(d.*member); }, std::move(value));
}

/// The same of a member of a member.
template <class D, class O, class M, class T>
Key<D> key(KeyInfo info, O D::*outer, M O::*member, Value<T> value) {
    return keyAt<D, T>(
        std::move(info), [=](auto& d) { return &((d.*outer).*member); }, std::move(value));
}

/// The same of a member of one of a variant's kinds.
template <class Kind, class D, class V, class M, class T>
Key<D> keyOfKind(KeyInfo info, V D::*variant, M Kind::*member, Value<T> value) {
    return keyAt<D, T>(
        std::move(info),
        [=](auto& d) {
            auto* kind = std::get_if<Kind>(&(d.*variant));
            return kind ? &(kind->*member) : nullptr;
        },
        std::move(value));
}

/// Another way to say what other keys say; whoever reads the table makes those of it.
template <class D>
Key<D> otherWay(KeyInfo info) {
    for (const char* kind : {"number", "colour", "`[x, y, z]`", "four rows"})
        info.moves |= info.type.starts_with(kind);
    return {std::move(info), {}, {}};
}

/// Marks a key that cannot be animated, although its value is a number.
template <class D>
Key<D> atRest(Key<D> key) {
    key.info.moves = false;
    return key;
}

/// Lists of keys, one after the other.
template <class D, class... More>
std::vector<Key<D>> joined(std::vector<Key<D>> keys, const More&... more) {
    (keys.insert(keys.end(), more.begin(), more.end()), ...);
    return keys;
}

/// Marks a choice that is biased wherever it is said.
template <class D>
Key<D> biasedWhenSaid(Key<D> key) {
    key.biased = [write = key.write](const D& d) {
        return write(d, SceneWriter(".", SceneWriter::Mode::File)).has_value();
    };
    return key;
}

}  // namespace woodcock::scene
