// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "woodcock/base/path_variables.h"
#include "woodcock/base/toml_text.h"

namespace woodcock::scene {

/// Lines of a scene file.
class SceneWriter {
public:
    /// A file for people, or the text that a digest is taken of: without comments, with all paths
    /// absolute, and with what the image does not show at its defaults.
    enum class Mode { File, Digest };
    SceneWriter(const std::filesystem::path& directory, Mode mode)
        : directory_(directory), digest_(mode == Mode::Digest) {}

    bool isDigest() const { return digest_; }

    void heading(std::string_view text) {
        text_ += fmt::format("{}{}\n", text_.empty() ? "" : "\n", text);
    }
    void line(std::string_view key, std::string_view value, std::string_view comment = "") {
        text_ += fmt::format("{} = {}", key, value);
        if (!digest_ && !comment.empty()) text_ += fmt::format("  # {}", comment);
        text_ += '\n';
    }
    void comment(std::string_view text) {
        if (!digest_) text_ += fmt::format("# {}\n", text);
    }
    const std::string& text() const { return text_; }

    /// A path inside a value.
    std::string quoted(const std::filesystem::path& p) const {
        namespace fs = std::filesystem;
        if (digest_) return tomlText(escapePath(fs::absolute(p).lexically_normal()));
        const bool here = directory_.empty() || directory_ == ".";
        if (here || p.is_absolute()) return tomlText(escapePath(p));
        return tomlText(escapePath(fs::absolute(p).lexically_normal().lexically_proximate(
            fs::absolute(directory_ / "").lexically_normal())));
    }

private:
    std::filesystem::path directory_;
    bool digest_;
    std::string text_;
};

}  // namespace woodcock::scene
