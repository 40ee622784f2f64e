// SPDX-License-Identifier: Apache-2.0
// The one-definition rule over all source files that end in one program. Two types, or two inline
// functions, of one name in one namespace link without a word, and then one of them is used for
// both.
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "tests/support/paths.h"

namespace woodcock::test {

using namespace proof;

namespace {

namespace fs = std::filesystem;

/// Words and single signs of a source file, without comments, literals and preprocessor lines.
class Tokens {
public:
    explicit Tokens(std::string_view text) : text_(text) {
        while (at_ < text_.size()) next();
    }
    std::vector<std::string> take() { return std::move(tokens_); }

private:
    static bool isWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
    bool follows(std::string_view what) const { return text_.substr(at_).starts_with(what); }
    /// To behind the next `end`, or to the end of the text.
    void skipTo(std::string_view end, std::size_t from) {
        const std::size_t found = text_.find(end, from);
        at_ = found == text_.npos ? text_.size() : found + end.size();
    }
    void skipLiteral(char quote) {
        for (++at_; at_ < text_.size() && text_[at_] != quote; ++at_) at_ += text_[at_] == '\\';
        ++at_;
    }
    void skipDirective() {
        do skipTo("\n", at_);
        while (at_ >= 2 && at_ < text_.size() && text_[at_ - 2] == '\\');
    }
    void takeWord() {
        const std::size_t begin = at_;
        const bool number = std::isdigit(static_cast<unsigned char>(text_[at_])) != 0;
        // Digits may be parted by quotes.
        while (at_ < text_.size() && (isWord(text_[at_]) || (number && text_[at_] == '\''))) ++at_;
        tokens_.emplace_back(text_.substr(begin, at_ - begin));
    }
    void next() {
        if (follows("//")) return skipTo("\n", at_);
        if (follows("/*")) return skipTo("*/", at_ + 2);
        if (follows("R\"")) {
            const std::size_t open = text_.find('(', at_);
            return skipTo(")" + std::string(text_.substr(at_ + 2, open - at_ - 2)) + "\"", open);
        }
        if (follows("::")) {
            tokens_.emplace_back("::");
            at_ += 2;
            return;
        }
        const char c = text_[at_];
        if (c == '"' || c == '\'') return skipLiteral(c);
        if (c == '#') return skipDirective();
        if (isWord(c)) return takeWord();
        if (!std::isspace(static_cast<unsigned char>(c))) tokens_.emplace_back(1, c);
        ++at_;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::vector<std::string> tokens_;
};

/// Of `tokens`, without the template <...> that they begin with.
std::vector<std::string> withoutTemplateHead(std::vector<std::string> tokens) {
    while (!tokens.empty() && tokens.front() == "template") {
        int depth = 0;
        auto end = tokens.begin() + 1;
        do depth += *end == "<" ? 1 : *end == ">" ? -1 : 0;
        while (++end != tokens.end() && depth > 0);
        tokens.erase(tokens.begin(), end);
    }
    return tokens;
}

/// What the tokens before a `{` of a namespace define, where several files must not define it:
/// "type Stage", "half ( float v )"; empty otherwise.
std::string definitionOf(const std::vector<std::string>& statement) {
    const std::vector<std::string> rest = withoutTemplateHead(statement);
    const auto has = [&](const char* word) {
        return std::find(rest.begin(), rest.end(), word) != rest.end();
    };
    static const std::set<std::string> kinds{"struct", "class", "enum", "union"};
    const auto parameters = std::find(rest.begin(), rest.end(), "(");
    if (!rest.empty() && kinds.contains(rest.front()) && parameters == rest.end()) {
        std::size_t name = 1;
        while (name < rest.size() && kinds.contains(rest[name])) ++name;
        auto end = std::find(rest.begin(), rest.end(), ":");  // bases
        if (name >= rest.size()) return {};
        const auto first = rest.begin() + static_cast<std::ptrdiff_t>(name);
        return fmt::format("type {}", fmt::join(first, std::find(first, end, "final"), " "));
    }
    const bool isInline = rest.size() < statement.size() || has("inline") || has("constexpr");
    if (!isInline || has("static") || has("=") || parameters == rest.begin() ||
        parameters == rest.end())
        return {};
    return fmt::format("{}", fmt::join(parameters - 1, rest.end(), " "));
}

/// Adds the definitions of a file, with their namespaces; unnamed namespaces are a file's own.
void addDefinitions(const std::string& text, const std::string& file,
                    std::map<std::string, std::set<std::string>>& files) {
    std::vector<std::string> statement, scopes;
    int unnamed = 0, inside = 0;  // inside: braces of anything but a namespace
    std::vector<bool> isUnnamed;
    for (const std::string& token : Tokens(text).take()) {
        if (inside > 0) {
            inside += token == "{" ? 1 : token == "}" ? -1 : 0;
        } else if (token == ";") {
            statement.clear();
        } else if (token == "}") {
            if (isUnnamed.empty()) continue;
            unnamed -= isUnnamed.back();
            isUnnamed.pop_back(), scopes.pop_back();
            statement.clear();
        } else if (token != "{") {
            statement.push_back(token);
        } else if (!statement.empty() && statement.front() == "namespace") {
            isUnnamed.push_back(statement.size() == 1);
            unnamed += isUnnamed.back();
            scopes.push_back(fmt::format("{}", fmt::join(std::span(statement).subspan(1), "")));
            statement.clear();
        } else {
            const std::string definition = definitionOf(statement);
            if (unnamed == 0 && !definition.empty())
                files[fmt::format("{}: {}", fmt::join(scopes, "::"), definition)].insert(file);
            statement.clear();
            inside = 1;
        }
    }
}

/// "woodcock: type Stage is defined by a.cpp and b.cpp".
std::vector<std::string> violations(const fs::path& top, const std::vector<std::string>& folders) {
    std::map<std::string, std::set<std::string>> files;
    for (const std::string& folder : folders)
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(top / folder)) {
            const std::string name = fs::relative(entry.path(), top).string();
            const fs::path extension = entry.path().extension();
            if (extension == ".h" || extension == ".cpp")
                addDefinitions(readText(entry.path()), name, files);
        }
    std::vector<std::string> found;
    for (const auto& [definition, places] : files)
        if (places.size() > 1)
            found.push_back(
                fmt::format("{} is defined by {}", definition, fmt::join(places, " and ")));
    return found;
}

// Programs of their own, such as tests/programs and tests/fuzz, are not among them.
TEST(OneDefinition, IsGivenOfEveryTypeAndInlineFunction) {
    const std::vector<std::string> found = violations(
        sourceDir(), {"lib", "tools", "tests/support", "tests/bake", "tests/base", "tests/camera",
                      "tests/compare", "tests/convert", "tests/grid", "tests/image", "tests/light",
                      "tests/medium", "tests/mesh", "tests/proof", "tests/render", "tests/scene",
                      "tests/surface", "tests/tools", "tests/trade"});
    EXPECT_TRUE(found.empty()) << fmt::format("{}", fmt::join(found, "\n"));
}

TEST(OneDefinition, ViolationsAreFound) {
    const TempDir top;
    fs::create_directories(top / "lib");
    writeText(top / "lib/a.h",
              "#pragma once\nnamespace w::grid {\nstruct Stage { int a; };\nstruct Later { struct "
              "Impl; };\n"
              "enum class Kind : int { A };\ninline int twice(int v) { return 2 * v; }\n"
              "template <class T>\nT same(T v) { return v; }\n}\n");
    writeText(top / "lib/b.cpp",
              "// struct Stage {\nnamespace w {\nnamespace grid {\nclass Stage final : Base {};\n"
              "enum class Kind { B };\n}\nnamespace {\nstruct Own {};\n}\n"
              "namespace other {\nstruct Stage {};\n}\nstruct grid::Later::Impl {};\n}\n");
    writeText(
        top / "lib/c.cpp",
        "namespace w::grid {\nstruct Stage;\nvoid f() { struct Stage { char c = '{'; }; }\n"
        "inline int twice(int v) { return v + v; }\ninline int twice(double v) { return 0; }\n"
        "template <class T>\nT same(T v) { return 2 * v; }\nnamespace {\nstruct Own {};\n}\n}\n");
    EXPECT_EQ(
        violations(top.path(), {"lib"}),
        (std::vector<std::string>{"w::grid: same ( T v ) is defined by lib/a.h and lib/c.cpp",
                                  "w::grid: twice ( int v ) is defined by lib/a.h and lib/c.cpp",
                                  "w::grid: type Kind is defined by lib/a.h and lib/b.cpp",
                                  "w::grid: type Stage is defined by lib/a.h and lib/b.cpp"}));
}

}  // namespace
}  // namespace woodcock::test
