// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "woodcock/base/path_variables.h"
#include "woodcock/base/toml_text.h"

namespace woodcock {

/// Lines of a scene file.
class SceneWriter {
public:
    enum class Comments { No, Yes };
    SceneWriter(const std::filesystem::path& directory, Comments comments)
        : directory_(directory), comments_(comments == Comments::Yes) {}

    void heading(std::string_view text) {
        text_ += fmt::format("{}{}\n", text_.empty() ? "" : "\n", text);
    }
    void line(std::string_view key, std::string_view value, std::string_view comment = "") {
        text_ += fmt::format("{} = {}", key, value);
        if (comments_ && !comment.empty()) text_ += fmt::format("  # {}", comment);
        text_ += '\n';
    }
    void path(std::string_view key, const std::filesystem::path& p) { line(key, quoted(p)); }
    void paths(std::string_view key, const std::vector<std::filesystem::path>& all) {
        std::vector<std::string> items;
        for (const auto& p : all) items.push_back(quoted(p));
        line(key, fmt::format("[{}]", fmt::join(items, ", ")));
    }
    void comment(std::string_view text) {
        if (comments_) text_ += fmt::format("# {}\n", text);
    }
    const std::string& text() const { return text_; }

    /// A path inside a value.
    std::string quoted(const std::filesystem::path& p) const {
        namespace fs = std::filesystem;
        const bool here = directory_.empty() || directory_ == ".";
        if (here || p.is_absolute()) return tomlText(escapePath(p));
        return tomlText(escapePath(fs::absolute(p).lexically_normal().lexically_proximate(
            fs::absolute(directory_ / "").lexically_normal())));
    }

private:
    std::filesystem::path directory_;
    bool comments_;
    std::string text_;
};

}  // namespace woodcock
