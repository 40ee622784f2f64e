// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/formats/nrrd_header.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "woodcock/base/printable.h"
#include "woodcock/convert/formats/number_text.h"

namespace woodcock::convert {

namespace {

std::string trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t\r");
    if (begin == text.npos) return {};
    return std::string(text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1));
}

/// The next line, of a sane length; nothing at the end of the file.
std::optional<std::string> readLine(grid::FileBytes& file) {
    if (file.left() == 0) return {};
    std::string line;
    while (file.left() > 0) {
        const char c = file.value<char>();
        if (c == '\n') break;
        line += c;
        if (line.size() > 65536)
            throw inputError("{}: the NRRD header has a line of over 65536 characters",
                             file.path().string());
    }
    if (line.ends_with('\r')) line.pop_back();
    return line;
}

void readMagic(grid::FileBytes& file) {
    const std::span<const char> magic = file.bytes(std::min<std::uint64_t>(file.left(), 8));
    const std::string_view text(magic.data(), magic.size());
    if (text.size() < 8 || !text.starts_with("NRRD000") || text[7] < '1' || text[7] > '6')
        throw inputError(
            "{} is not a NRRD file: it begins with '{}' instead of NRRD0001 to NRRD0006",
            file.path().string(), printable(text));
    readLine(file);
}

double numberOf(const NrrdHeader& header, const std::string& field, std::string_view word) {
    const auto value = parseDouble(trimmed(word));
    if (!value || !std::isfinite(*value)) throw header.wrong(field, "finite numbers");
    return *value;
}

/// The numbers of "(0,0,1)". A space with time has a fourth.
std::vector<double> vectorOf(const NrrdHeader& header, const std::string& field,
                             const std::string& word) {
    if (word.size() < 2 || word.front() != '(' || word.back() != ')')
        throw header.wrong(field, "vectors such as (0,0,1)");
    std::vector<double> v;
    std::string_view rest(word.data() + 1, word.size() - 2);
    while (true) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        v.push_back(numberOf(header, field, rest.substr(0, comma)));
        if (comma == rest.size() || v.size() > 4) break;
        rest.remove_prefix(comma + 1);
    }
    if (v.size() != 3 && v.size() != 4)
        throw header.wrong(field, "vectors of three numbers, or four in a space with time");
    return v;
}

Vec3d spaceOf(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

/// What a kind of axis is.
enum class AxisKind { Unknown, Space, List, Together };

AxisKind kindOf(const std::string& kind) {
    if (kind == "space" || kind == "domain") return AxisKind::Space;
    if (kind == "time" || kind == "list") return AxisKind::List;
    if (kind == "???" || kind == "none") return AxisKind::Unknown;
    return AxisKind::Together;  // vectors, colours, matrices
}

/// An entry of a field for each axis; empty where the field is missing.
std::vector<std::string> perAxis(const NrrdHeader& header, const std::string& field,
                                 std::size_t axes) {
    if (!header.has(field)) return {};
    std::vector<std::string> words = nrrdWords(header.get(field));
    if (words.size() != axes) throw header.wrong(field, "an entry for each of the axes");
    return words;
}

std::vector<AxisKind> kindsOf(const NrrdHeader& header, std::size_t count) {
    std::vector<AxisKind> kinds(count, AxisKind::Unknown);
    const auto words = perAxis(header, "kinds", count);
    const auto directions = perAxis(header, "spacedirections", count);
    for (std::size_t a = 0; a < count; ++a) {
        if (!words.empty()) kinds[a] = kindOf(nrrdLower(words[a]));
        if (directions.empty()) continue;
        if (nrrdLower(directions[a]) == "none") {
            if (kinds[a] == AxisKind::Unknown || kinds[a] == AxisKind::Space)
                kinds[a] = AxisKind::Together;
            continue;
        }
        const auto v = vectorOf(header, "spacedirections", directions[a]);
        const bool isTime = v.size() == 4 && spaceOf(v) == Vec3d{} && v[3] != 0;
        kinds[a] = isTime ? AxisKind::List : AxisKind::Space;
    }
    return kinds;
}

/// The first letters of an anatomical space, by its name or its letters; empty for others.
std::string anatomyOf(std::string space) {
    if (space.ends_with("-time")) space.resize(space.size() - 5);
    if (space.size() == 4 && space.back() == 't') space.pop_back();
    std::string letters = space;
    if (space.find('-') != space.npos) {
        letters.clear();
        static const std::set<std::string> known{"left",      "right",    "anterior",
                                                 "posterior", "superior", "inferior"};
        for (std::size_t at = 0; at <= space.size();) {
            const std::size_t end = std::min(space.find('-', at), space.size());
            const std::string word = space.substr(at, end - at);
            if (!known.contains(word)) return {};
            letters += word[0];
            at = end + 1;
        }
    }
    return letters.size() == 3 ? letters : "";
}

/// The world's direction of each of the space's axes. Nothing where the space has no such name.
std::optional<Affine3d> worldFromSpace(const std::string& space) {
    Affine3d map;
    if (space == "3d-left-handed" || space == "3d-left-handed-time") {
        map.column[2].z = -1;
        return map;
    }
    for (const char* same : {"3d-right-handed", "3d-right-handed-time", "scanner-xyz",
                             "scanner-xyz-time", "3dr", "3drt", "xyz"})
        if (space == same) return map;
    if (space == "3dl" || space == "3dlt") return worldFromSpace("3d-left-handed");
    const std::string letters = anatomyOf(space);
    if (letters.empty()) return {};
    static const std::map<char, Vec3d> directions{{'r', {1, 0, 0}}, {'l', {-1, 0, 0}},
                                                  {'a', {0, 1, 0}}, {'p', {0, -1, 0}},
                                                  {'s', {0, 0, 1}}, {'i', {0, 0, -1}}};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto found = directions.find(letters[i]);
        if (found == directions.end()) return {};
        map.column[i] = found->second;
    }
    if (map.determinant() == 0) return {};
    return map;
}

}  // namespace

const std::string& NrrdHeader::get(const std::string& name) const {
    const auto found = fields.find(name);
    if (found == fields.end())
        throw inputError("{}: the NRRD header has no field '{}'", file.string(), name);
    return found->second;
}

Error NrrdHeader::wrong(const std::string& name, const std::string& expected) const {
    return inputError("{}: the NRRD field '{}' is '{}'; expected {}", file.string(), name,
                      printable(get(name).substr(0, 100)), expected);
}

std::string nrrdLower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::vector<std::string> nrrdWords(const std::string& text) {
    std::vector<std::string> found;
    for (std::size_t at = 0; (at = text.find_first_not_of(" \t", at)) != text.npos;) {
        // A vector may have spaces within its parentheses.
        const std::size_t close = text[at] == '(' ? text.find(')', at) : at;
        const std::size_t end = std::min(text.find_first_of(" \t", close), text.size());
        found.push_back(text.substr(at, end - at));
        at = end;
    }
    return found;
}

std::int64_t nrrdWhole(const NrrdHeader& header, const std::string& field,
                       const std::string& word) {
    std::int64_t n = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), n);
    if (error != std::errc() || end != word.data() + word.size())
        throw header.wrong(field, "whole numbers");
    return n;
}

NrrdHeader readNrrdHeader(grid::FileBytes& file) {
    NrrdHeader header{file.path(), {}, {}};
    readMagic(file);
    while (true) {
        const std::optional<std::string> line = readLine(file);
        if (!line) {
            const bool detached =
                header.has("datafile") && nrrdLower(header.get("datafile")) != "local";
            if (detached) return header;
            throw inputError("{}: the NRRD header does not end: no empty line follows it",
                             file.path().string());
        }
        if (line->empty()) return header;
        if (line->starts_with('#') || line->find(":=") != line->npos) continue;
        const std::size_t colon = line->find(':');
        if (colon == line->npos)
            throw inputError("{}: the NRRD header has the line '{}', which is not 'field: value'",
                             file.path().string(), printable(line->substr(0, 100)));
        std::string name = nrrdLower(trimmed(line->substr(0, colon)));
        std::erase(name, ' ');
        header.fields[name] = trimmed(line->substr(colon + 1));
        if (name != "datafile" || !header.fields[name].starts_with("LIST")) continue;
        // This is the last field; all lines below are names.
        while (const std::optional<std::string> listed = readLine(file)) {
            if (!trimmed(*listed).empty()) header.listed.push_back(trimmed(*listed));
            if (header.listed.size() > 100000) throw header.wrong(name, "at most 100000 files");
        }
        return header;
    }
}

SampleType nrrdType(const NrrdHeader& header) {
    static const std::map<std::string, SampleType> types = [] {
        std::map<std::string, SampleType> names;
        const auto add = [&](SampleType type, std::initializer_list<const char*> all) {
            for (const char* name : all) names[name] = type;
        };
        add(SampleType::I8, {"signed char", "int8", "int8_t"});
        add(SampleType::U8, {"uchar", "unsigned char", "uint8", "uint8_t"});
        add(SampleType::I16,
            {"short", "short int", "signed short", "signed short int", "int16", "int16_t"});
        add(SampleType::U16,
            {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"});
        add(SampleType::I32, {"int", "signed int", "int32", "int32_t"});
        add(SampleType::U32, {"uint", "unsigned int", "uint32", "uint32_t"});
        add(SampleType::I64, {"longlong", "long long", "long long int", "signed long long",
                              "signed long long int", "int64", "int64_t"});
        add(SampleType::U64,
            {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"});
        add(SampleType::F32, {"float"});
        add(SampleType::F64, {"double"});
        return names;
    }();
    const auto found = types.find(nrrdLower(header.get("type")));
    if (found == types.end()) throw header.wrong("type", "int8 to uint64, float or double");
    return found->second;
}

NrrdAxes nrrdAxes(const NrrdHeader& header) {
    NrrdAxes axes;
    for (const std::string& word : nrrdWords(header.get("sizes"))) {
        axes.sizes.push_back(nrrdWhole(header, "sizes", word));
        if (axes.sizes.back() < 1 || axes.sizes.size() > 16)
            throw header.wrong("sizes", "at most 16 positive whole numbers");
    }
    const std::size_t count = axes.sizes.size();
    if (header.get("dimension") != std::to_string(count))
        throw header.wrong("dimension", fmt::format("{}, the number of sizes", count));
    std::vector<AxisKind> kinds = kindsOf(header, count);
    const auto number = [&](AxisKind kind) { return std::count(kinds.begin(), kinds.end(), kind); };
    // Axes without a kind: they are axes of space if that makes three. If there is one too many,
    // the first is for channels.
    if (number(AxisKind::Unknown) + number(AxisKind::Space) == 4 && number(AxisKind::Unknown) > 0) {
        const auto first = std::find(kinds.begin(), kinds.end(), AxisKind::Unknown);
        const bool sure = number(AxisKind::Unknown) == 1;
        *first = AxisKind::Together;
        if (!sure)
            axes.note = fmt::format(
                "{}: the NRRD header does not say which of its four axes are those of space: axis "
                "{} is "
                "taken for channels, and the others for x, y and z",
                header.file.string(), first - kinds.begin());
    }
    for (AxisKind& kind : kinds)
        if (kind == AxisKind::Unknown) kind = AxisKind::Space;
    for (std::size_t a = 0; a < count; ++a) {
        if (kinds[a] == AxisKind::Space) {
            axes.space.push_back(a);
            continue;
        }
        if (axes.sizes[a] == 1) continue;
        if (axes.channels)
            throw inputError(
                "{}: neither axis {} nor axis {} is an axis of space, and only one such axis can "
                "be read; take a slice of the other, as `unu slice -a {} -p 0` does",
                header.file.string(), *axes.channels, a, a);
        axes.channels = a;
        if (axes.sizes[a] > 1024)
            throw header.wrong("sizes", "at most 1024 along an axis that is not one of space");
        if (kinds[a] != AxisKind::List) continue;
        const auto words = perAxis(header, "kinds", count);
        axes.list = !words.empty() && nrrdLower(words[a]) == "list" ? "entries of a list" : "times";
    }
    if (axes.space.size() != 3)
        throw inputError(
            "{}: {} of the NRRD file's {} axes are axes of space, where 3 are expected; its "
            "'kinds' "
            "say which are (space), and which is a list, time or vector",
            header.file.string(), axes.space.size(), count);
    return axes;
}

void placeNrrd(DenseVolume& volume, const NrrdHeader& header, const NrrdAxes& axes) {
    const std::size_t count = axes.sizes.size();
    if (const auto vectors = perAxis(header, "spacedirections", count); !vectors.empty()) {
        for (std::size_t i = 0; i < 3; ++i)
            volume.worldFromIndex.column[i] =
                spaceOf(vectorOf(header, "spacedirections", vectors[axes.space[i]]));
        volume.placed = true;
    } else if (const auto spacings = perAxis(header, "spacings", count); !spacings.empty()) {
        Vec3d voxel;
        for (std::size_t i = 0; i < 3; ++i)
            voxel[static_cast<int>(i)] = numberOf(header, "spacings", spacings[axes.space[i]]);
        volume.worldFromIndex = Affine3d::scale(voxel);
        volume.placed = true;
    }
    if (header.has("spaceorigin")) {
        volume.worldFromIndex.translation =
            spaceOf(vectorOf(header, "spaceorigin", header.get("spaceorigin")));
        volume.placed = true;
    }
    if (header.has("space")) {
        const auto toWorld = worldFromSpace(nrrdLower(header.get("space")));
        if (!toWorld)
            throw header.wrong("space",
                               "right-anterior-superior (RAS), left-posterior-superior (LPS) and "
                               "their kind, scanner-xyz, 3D-right-handed or 3D-left-handed");
        if (volume.placed) volume.worldFromIndex = *toWorld * volume.worldFromIndex;
    }
    const double determinant = volume.worldFromIndex.determinant();
    if (determinant == 0 || !std::isfinite(determinant))
        throw inputError("{}: the NRRD header's directions or spacings are zero or lie in a plane",
                         header.file.string());
    for (const char* ignored : {"axismins", "axismaxs", "measurementframe"})
        if (header.has(ignored))
            volume.notes.push_back(
                fmt::format("{}: the NRRD field '{}' is ignored", header.file.string(), ignored));
}

}  // namespace woodcock::convert
