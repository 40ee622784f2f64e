// SPDX-License-Identifier: Apache-2.0
#include "tools/pages/page.h"

#include <fmt/core.h>

namespace woodcock::tool {

// Of this folder, see CMakeLists.txt.
extern const std::string_view pageFrame, pageStyle, pageCommon;

namespace {

/// JSON has < in strings only, where it may be written so: no name can end the script.
std::string insideScript(const std::string& json) {
    std::string text;
    for (const char c : json) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
    return text;
}

/// The text with this in place of that.
std::string with(std::string_view text, std::string_view place, std::string_view by) {
    const std::size_t at = text.find(place);
    return fmt::format("{}{}{}", text.substr(0, at), by, text.substr(at + place.size()));
}

}  // namespace

std::string makePage(const PageParts& parts) {
    std::string style(pageStyle), data, script(pageCommon);
    for (const std::string_view text : parts.styles) style += text;
    for (const auto& [id, json] : parts.data)
        data += fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id,
                            insideScript(json));
    for (const std::string_view text : parts.scripts) script += text;
    // The last place first: what is put in cannot be mistaken for one.
    std::string page = with(pageFrame, "@SCRIPT@", script);
    page = with(page, "@DATA@", data);
    page = with(page, "@STYLE@", style);
    return with(page, "@TITLE@", parts.title);
}

}  // namespace woodcock::tool
