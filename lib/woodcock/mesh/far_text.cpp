// SPDX-License-Identifier: Apache-2.0
#include "woodcock/mesh/mesh_formats.h"

#include <array>
#include <charconv>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "woodcock/grid/input_file.h"
#include "woodcock/mesh/triangle_mesh.h"

namespace woodcock::mesh {

namespace {

constexpr std::string_view spaces = " \t\r";

/// The next word of a line, which moves on.
std::string_view nextWord(std::string_view& line) {
    line.remove_prefix(std::min(line.find_first_not_of(spaces), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(spaces));
    line.remove_prefix(word.size());
    return word;
}

enum class Found { NoPoint, Point, Unusual };

/// Whether a line is a point ("v 1 2 3", "vertex 1 2 3"), and what follows its numbers.
Found readPoint(std::string_view& line, std::string_view keyword, Vec3d& point) {
    std::string_view rest = line;
    if (nextWord(rest) != keyword) return Found::NoPoint;
    for (int i = 0; i < 3; ++i) {
        std::string_view word = nextWord(rest);
        if (word.starts_with('+')) word.remove_prefix(1);
        const auto [stop, error] =
            std::from_chars(word.data(), word.data() + word.size(), point[i]);
        if (error != std::errc() || stop != word.data() + word.size()) return Found::Unusual;
    }
    if (!isFinite(point)) return Found::Unusual;
    line = rest;
    // A single fourth number is a weight that divides the others; three more numbers are a colour.
    const std::string_view fourth = nextWord(rest), fifth = nextWord(rest);
    const bool weightOfOne =
        fourth.starts_with('1') && fourth.find_first_not_of("1.0") == fourth.npos;
    if (!fourth.empty() && fifth.empty() && !weightOfOne) return Found::Unusual;
    return fourth == "\\" ? Found::Unusual : Found::Point;
}

bool isBinaryStl(std::string_view bytes) {
    if (bytes.size() < 84) return false;
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    return bytes.size() == 84 + std::uint64_t{50} * count;
}

template <class Use>
void forEachLine(std::string_view text, Use use) {
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        use(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
}

}  // namespace

std::optional<FarText> withoutOrigin(const std::filesystem::path& file) {
    const std::string extension = file.extension().string();
    const bool obj = extension == ".obj" || extension == ".OBJ";
    const bool stl = extension == ".stl" || extension == ".STL";
    if (!obj && !stl) return {};
    const std::string text = grid::readInput(file);
    if (stl && isBinaryStl(text)) return {};
    const std::string_view keyword = obj ? "v" : "vertex";
    Box3d bounds;
    bool unusual = false;
    forEachLine(text, [&](std::string_view line) {
        Vec3d point;
        const Found found = unusual ? Found::NoPoint : readPoint(line, keyword, point);
        if (found == Found::Point) bounds.add(point);
        unusual |= found == Found::Unusual;
    });
    FarText result{{}, originFor(bounds)};
    if (unusual || result.origin == Vec3d{}) return {};
    forEachLine(text, [&](std::string_view line) {
        Vec3d point;
        std::string_view rest = line;
        if (readPoint(rest, keyword, point) != Found::Point) {
            result.text.append(line).append("\n");
            return;
        }
        const Vec3d p = point - result.origin;
        result.text += fmt::format("{} {} {} {}{}\n", keyword, static_cast<float>(p.x),
                                   static_cast<float>(p.y), static_cast<float>(p.z), rest);
    });
    return result;
}

}  // namespace woodcock::mesh
