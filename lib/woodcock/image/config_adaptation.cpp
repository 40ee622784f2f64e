// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/config_adaptation.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <regex>
#include <vector>

namespace woodcock::image {

namespace {

// Their repetitions are bounded: each letter takes some of the stack.
const std::regex& versionLine() {
    static const std::regex line(
        R"((^|\n)ocio_profile_version:[ \t]{0,9}(\d{1,11})(?:\.(\d{1,11}))?)");
    return line;
}

const std::regex& builtinTransform() {
    static const std::regex text(
        R"re(!<BuiltinTransform>[ \t]{0,99}\{[ \t]{0,99}style:[ \t]{0,99})re"
        R"re((?:"([^"\n]{1,200})"|([^",}\n]{0,200}[^",} \t\n])))re");
    return text;
}

/// Where there are too many digits, the largest number: later than every known version.
int versionNumber(const std::string& digits) {
    int number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return error == std::errc::result_out_of_range ? std::numeric_limits<int>::max() : number;
}

}  // namespace

ConfigVersion configVersion(std::string_view text) {
    std::match_results<std::string_view::const_iterator> found;
    if (!std::regex_search(text.begin(), text.end(), found, versionLine())) return {};
    return {versionNumber(found[2]), found[3].matched ? versionNumber(found[3]) : 0};
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

double yamlExpansion(std::string_view text) {
    struct Anchor {
        std::string name;
        std::size_t indent = 0;  ///< of its line: more indented lines below belong to it
        double weight = 1;
    };
    std::map<std::string, double, std::less<>> weights;
    std::vector<Anchor> open;
    double total = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line = text.substr(at, end - at);
        at = end + 1;
        const std::size_t indent = line.find_first_not_of(' ');
        if (indent == std::string_view::npos) continue;
        while (!open.empty() && open.back().indent >= indent) {
            weights[open.back().name] = open.back().weight;
            open.pop_back();
        }
        for (std::size_t i = indent; i < line.size(); ++i) {
            const bool begins =
                i == indent || std::string_view(" ,[{").find(line[i - 1]) != std::string_view::npos;
            if (!begins || (line[i] != '&' && line[i] != '*')) continue;
            const std::size_t stop = std::min(line.find_first_of(" ,]}[{", i), line.size());
            const std::string name(line.substr(i + 1, stop - i - 1));
            if (line[i] == '&') {
                open.push_back({name, indent});
                continue;
            }
            double weight = 1;
            if (const auto known = weights.find(name); known != weights.end())
                weight = known->second;
            for (Anchor& anchor : open) anchor.weight += weight;
            total += weight;
        }
    }
    return total;
}

}  // namespace woodcock::image
