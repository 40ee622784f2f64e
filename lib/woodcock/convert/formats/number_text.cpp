// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/formats/number_text.h"

#include <algorithm>
#include <charconv>

#include "woodcock/base/printable.h"

namespace woodcock::convert {

namespace {

constexpr std::string_view separators = " \t\r\n,";

}  // namespace

std::optional<double> parseDouble(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error != std::errc()) return {};
    return value;
}

std::optional<double> NumberText::next() {
    skipSpace();
    const std::size_t length = std::min(rest_.find_first_of(separators), rest_.size());
    const std::optional<double> value = parseDouble(rest_.substr(0, length));
    if (value) rest_.remove_prefix(length);
    return value;
}

bool NumberText::atEnd() {
    skipSpace();
    return rest_.empty();
}

std::string NumberText::describeRest() {
    if (atEnd()) return "the end";
    const std::size_t length =
        std::min({rest_.find_first_of(separators), rest_.size(), std::size_t{40}});
    return "'" + printable(rest_.substr(0, length)) + "'";
}

void NumberText::skipSpace() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(separators), rest_.size()));
}

}  // namespace woodcock::convert
