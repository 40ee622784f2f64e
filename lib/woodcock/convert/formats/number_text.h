// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace woodcock::convert {

/// The whole text as a number; a plus sign is allowed. Absent where it is not a number.
std::optional<double> parseDouble(std::string_view text);

/// Numbers one after the other, with white space or commas between them.
class NumberText {
public:
    explicit NumberText(std::string_view text) : rest_(text) {}

    /// The next number. Absent at the end, and where the next word is not a number.
    std::optional<double> next();
    bool atEnd();
    std::string describeRest();  ///< "the end", or "'...'"

private:
    void skipSpace();
    std::string_view rest_;
};

}  // namespace woodcock::convert
