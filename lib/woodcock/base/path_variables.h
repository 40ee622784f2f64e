// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace woodcock {

/// `text` with a leading ~ replaced by $HOME, $NAME and ${NAME} by the environment's values and
/// $$ by a dollar sign. $F, $F4 and ${F4} stand for a frame's number and stay. Throws Error{Input}
/// on a variable that is not set.
std::filesystem::path expandPath(std::string_view text);

/// The text that expandPath() turns into `path`.
std::string escapePath(const std::filesystem::path& path);

}  // namespace woodcock
