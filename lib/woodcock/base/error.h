// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <utility>

#include "woodcock/error.h"

namespace woodcock {

template <class... A>
Error usageError(fmt::format_string<A...> text, A&&... args) {
    return {ErrorKind::Usage, fmt::format(text, std::forward<A>(args)...)};
}
template <class... A>
Error inputError(fmt::format_string<A...> text, A&&... args) {
    return {ErrorKind::Input, fmt::format(text, std::forward<A>(args)...)};
}
template <class... A>
Error failure(fmt::format_string<A...> text, A&&... args) {
    return {ErrorKind::Failure, fmt::format(text, std::forward<A>(args)...)};
}

}  // namespace woodcock
