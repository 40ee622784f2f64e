// SPDX-License-Identifier: Apache-2.0
// The guides: their links lead somewhere, their lines fit a terminal, and the README stays short.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/paths.h"

namespace woodcock::test {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t columns = 100, readmeLines = 150;

/// All Markdown files below a folder, but those of builds and of Git.
std::vector<fs::path> guides(const fs::path& top) {
    std::vector<fs::path> files;
    for (auto entry = fs::recursive_directory_iterator(top); entry != end(entry); ++entry) {
        const std::string name = entry->path().filename().string();
        if (entry->is_directory() && (name == ".git" || name.starts_with("build")))
            entry.disable_recursion_pending();
        else if (entry->is_regular_file() && entry->path().extension() == ".md")
            files.push_back(entry->path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

struct Line {
    std::size_t number;
    std::string text;
};

/// The lines outside of code, fenced or indented.
std::vector<Line> prose(const std::string& text) {
    std::vector<Line> lines;
    std::istringstream in(text);
    bool fenced = false, indented = false, afterBlank = true;
    std::size_t number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        const std::size_t start = line.find_first_not_of(' ');
        const bool blank = start == std::string::npos;
        if (!blank && line.compare(start, 3, "```") == 0) {
            fenced = !fenced;
            continue;
        }
        indented = blank ? indented : start >= 4 && (afterBlank || indented);
        afterBlank = blank;
        if (!fenced && !indented && !blank) lines.push_back({number, line});
    }
    return lines;
}

std::string withoutCode(const std::string& text) {
    return std::regex_replace(text, std::regex("`[^`]*`"), "");
}

/// The anchor that a page gets for a heading: in lower case, blanks as hyphens, and of punctuation
/// only hyphens and underscores.
std::string anchorOf(const std::string& heading) {
    std::string anchor;
    for (const char c : heading) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) || c == '-' || c == '_')
            anchor += static_cast<char>(std::tolower(byte));
        else if (c == ' ')
            anchor += '-';
    }
    return anchor;
}

std::set<std::string> anchors(const fs::path& file) {
    std::set<std::string> found;
    std::map<std::string, int> times;
    static const std::regex heading("^#{1,6} +(.*)$");
    std::smatch match;
    for (const Line& line : prose(readText(file))) {
        if (!std::regex_match(line.text, match, heading)) continue;
        const std::string anchor = anchorOf(match[1].str());
        const int before = times[anchor]++;
        found.insert(before ? fmt::format("{}-{}", anchor, before) : anchor);
    }
    return found;
}

struct Link {
    std::string file, anchor;
};

std::vector<Link> links(const fs::path& guide) {
    std::string text;
    for (const Line& line : prose(readText(guide))) text += line.text + "\n";
    text = withoutCode(text);
    static const std::regex link(R"(\]\(([^)\s]+)\))");
    std::vector<Link> found;
    for (std::sregex_iterator match(text.begin(), text.end(), link), last; match != last; ++match) {
        const std::string target = (*match)[1].str();
        if (target.find("://") != std::string::npos) continue;
        const std::size_t hash = target.find('#');
        found.push_back({target.substr(0, hash),
                         hash == std::string::npos ? std::string() : target.substr(hash + 1)});
    }
    return found;
}

std::vector<std::string> brokenLinks(const fs::path& top) {
    std::vector<std::string> broken;
    for (const fs::path& guide : guides(top)) {
        const std::string name = fs::relative(guide, top).string();
        for (const Link& link : links(guide)) {
            const fs::path target = link.file.empty() ? guide : guide.parent_path() / link.file;
            if (!fs::exists(target))
                broken.push_back(fmt::format("{}: there is no {}", name, link.file));
            else if (!link.anchor.empty() && !anchors(target).contains(link.anchor))
                broken.push_back(
                    fmt::format("{}: no heading gives {}#{}", name, link.file, link.anchor));
        }
    }
    return broken;
}

std::size_t widthOf(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0) != 0x80;  // a code point's first byte
    }));
}

/// Tables, pictures and single long words, such as links, cannot be wrapped.
bool canWrap(const std::string& line) {
    if (line.starts_with("|") || line.starts_with("![") || line.starts_with("<!--")) return false;
    const std::size_t start = line.find_first_not_of(" -*0123456789.");
    return line.rfind(' ', columns) != std::string::npos && line.rfind(' ', columns) > start;
}

std::vector<std::string> longLines(const fs::path& top) {
    std::vector<std::string> found;
    for (const fs::path& guide : guides(top))
        for (const Line& line : prose(readText(guide)))
            if (widthOf(line.text) > columns && canWrap(line.text))
                found.push_back(fmt::format("{}:{}: {} columns", fs::relative(guide, top).string(),
                                            line.number, widthOf(line.text)));
    return found;
}

TEST(Guides, LinksLeadSomewhere) {
    EXPECT_GE(guides(sourceDir()).size(), 10u);
    const std::vector<std::string> broken = brokenLinks(sourceDir());
    EXPECT_TRUE(broken.empty()) << fmt::format("{}", fmt::join(broken, "\n"));
}

TEST(Guides, ProseIsWrapped) {
    const std::vector<std::string> found = longLines(sourceDir());
    EXPECT_TRUE(found.empty()) << fmt::format("{}", fmt::join(found, "\n"));
}

TEST(Guides, ReadmeIsShort) {
    const std::string text = readText(sourceDir() / "README.md");
    EXPECT_LE(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')), readmeLines);
}

TEST(Guides, EveryCommandHasAGuideThatTheReadmeNames) {
    const std::vector<Link> named = links(sourceDir() / "README.md");
    for (const fs::directory_entry& folder : fs::directory_iterator(sourceDir() / "tools")) {
        const std::string name = folder.path().filename().string();
        if (!folder.is_directory() || name == "common" || name == "pages") continue;
        EXPECT_TRUE(fs::exists(folder.path() / "README.md")) << name;
        EXPECT_TRUE(std::any_of(named.begin(), named.end(), [&](const Link& link) {
            return link.file == "tools/" + name + "/README.md";
        })) << name;
    }
}

TEST(Guides, MistakesAreFound) {
    const TempDir top;
    fs::create_directory(top / "build");
    writeText(top / "build/skipped.md", "[nowhere](nowhere.md)\n");
    writeText(
        top / "a.md",
        "# A `title`: the first\n\n# Twice\n\n# Twice\n\n[here](#a-title-the-first) "
        "[second](#twice-1) [b](b.md#part_one)\n[far](https://example.org/#x) `[code](c.md)`\n"
        "[gone](c.md) [no\nheading](#third) [none](b.md#part-two)\n\n    [code](d.md)\n\n"
        "```\n[code](e.md)\n```\n");
    writeText(top / "b.md", "## Part_one\n");
    EXPECT_EQ(brokenLinks(top.path()),
              (std::vector<std::string>{"a.md: there is no c.md", "a.md: no heading gives #third",
                                        "a.md: no heading gives b.md#part-two"}));

    const std::string word(60, 'x'), words = word + " " + word;
    writeText(top / "b.md", words + "\n\n| " + words + " |\n\n    " + words + "\n\n- " + word +
                                word + "\n\n- " + words + "\n  " + words + "\n");
    EXPECT_EQ(longLines(top.path()),
              (std::vector<std::string>{"b.md:1: 121 columns", "b.md:9: 123 columns",
                                        "b.md:10: 123 columns"}));
}

}  // namespace
}  // namespace woodcock::test
