// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/config_adaptation.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

namespace woodcock {

namespace {

const std::regex& versionLine() {
    static const std::regex line(R"((^|\n)ocio_profile_version:[ \t]*(\d+)(?:\.(\d+))?)");
    return line;
}

const std::regex& builtinTransform() {
    static const std::regex text(R"re(!<BuiltinTransform>[ \t]*\{[ \t]*style:[ \t]*)re"
                                 R"re((?:"([^"\n]+)"|([^",}\n]*[^",} \t\n])))re");
    return text;
}

}  // namespace

ConfigVersion configVersion(std::string_view text) {
    std::match_results<std::string_view::const_iterator> found;
    if (!std::regex_search(text.begin(), text.end(), found, versionLine())) return {};
    return {std::stoi(found[2]), found[3].matched ? std::stoi(found[3]) : 0};
}

AdaptedConfig adaptConfig(std::string_view text, ConfigVersion library,
                          const std::vector<std::string>& known) {
    AdaptedConfig adapted;
    const std::string claimed = std::regex_replace(
        std::string(text), versionLine(),
        fmt::format("$1ocio_profile_version: {}.{}", library.major, library.minor),
        std::regex_constants::format_first_only);

    auto from = claimed.begin();
    for (std::sregex_iterator i(claimed.begin(), claimed.end(), builtinTransform()), end; i != end;
         ++i) {
        const std::string style = (*i)[1].matched ? (*i)[1] : (*i)[2];
        if (std::find(known.begin(), known.end(), style) != known.end()) continue;
        adapted.text.append(from, (*i)[0].first);
        adapted.text += fmt::format("!<FileTransform> {{src: \"{}\"", style);
        from = (*i)[0].second;
        if (std::find(adapted.missing.begin(), adapted.missing.end(), style) ==
            adapted.missing.end())
            adapted.missing.push_back(style);
    }
    adapted.text.append(from, claimed.end());
    return adapted;
}

}  // namespace woodcock
