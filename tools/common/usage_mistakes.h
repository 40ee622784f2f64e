// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "woodcock/base/error.h"

namespace woodcock::tool {

/// A mistake in the command line, in words that help to mend it.
Error explain(const CLI::ParseError& error, const CLI::App& app);

}  // namespace woodcock::tool
