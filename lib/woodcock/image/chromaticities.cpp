// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/chromaticities.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string>

namespace woodcock::image {

namespace {

// ITU-R BT.709 and BT.2020; SMPTE ST 2065-1 and Academy S-2014-004.
constexpr Chromaticities rec709{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
constexpr Chromaticities rec2020{0.708f, 0.292f, 0.170f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.3290f};
constexpr Chromaticities ap0{0.7347f, 0.2653f, 0.0f, 1.0f, 0.0001f, -0.0770f, 0.32168f, 0.33767f};
constexpr Chromaticities ap1{0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};

std::string lettersAndDigits(std::string_view name) {
    std::string s;
    for (char c : name)
        if (std::isalnum(static_cast<unsigned char>(c)))
            s += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return s;
}

}  // namespace

std::optional<Chromaticities> chromaticitiesFromName(std::string_view name) {
    const std::string s = lettersAndDigits(name);
    const auto says = [&](std::initializer_list<const char*> words) {
        return std::any_of(words.begin(), words.end(),
                           [&](const char* word) { return s.find(word) != std::string::npos; });
    };
    if (says({"acescg", "ap1"})) return ap1;
    if (says({"aces2065", "ap0"})) return ap0;
    if (says({"rec2020", "bt2020"})) return rec2020;
    if (says({"rec709", "bt709", "linsrgb", "linearsrgb"})) return rec709;
    return {};
}

std::string interopIdOf(const Chromaticities& chromaticities) {
    if (chromaticities == rec709) return "lin_rec709_scene";
    if (chromaticities == rec2020) return "lin_rec2020_scene";
    if (chromaticities == ap1) return "lin_ap1_scene";
    if (chromaticities == ap0) return "lin_ap0_scene";
    return "";
}

}  // namespace woodcock::image
