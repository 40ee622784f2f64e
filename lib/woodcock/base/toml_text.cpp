// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/toml_text.h"

#include <fmt/format.h>

#include <cmath>

namespace woodcock {

namespace {

/// Without a point, TOML reads an integer, which has no negative zero.
template <class T>
std::string number(T v) {
    return v == 0 && std::signbit(v) ? "-0.0" : fmt::format("{}", v);
}

}  // namespace

std::string tomlText(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            quoted += '\\', quoted += c;
        else if (byte < 0x20 || byte == 0x7f)
            quoted += fmt::format("\\u{:04x}", byte);
        else
            quoted += c;
    }
    return quoted + '"';
}

std::string tomlNumber(double v) { return number(v); }

std::string tomlVector(Vec3d v) {
    return fmt::format("[{}, {}, {}]", number(v.x), number(v.y), number(v.z));
}

std::string tomlColour(Rgb v) {
    if (isGrey(v)) return number(v[0]);
    return fmt::format("[{}, {}, {}]", number(v[0]), number(v[1]), number(v[2]));
}

std::string tomlColour(Vec3d v) {
    return v.x == v.y && v.x == v.z ? tomlNumber(v.x) : tomlVector(v);
}

std::string tomlMatrix(const Affine3d& m) {
    std::string rows = "[";
    for (int i = 0; i < 3; ++i)
        rows +=
            fmt::format("\n    [{}, {}, {}, {}],", number(m.column[0][i]), number(m.column[1][i]),
                        number(m.column[2][i]), number(m.translation[i]));
    return rows + "\n    [0, 0, 0, 1],\n]";
}

}  // namespace woodcock
