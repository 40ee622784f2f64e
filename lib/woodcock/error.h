// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace woodcock {

/// Where the fault lies: in the options, in the data that they name, or in the machine. The
/// program's main() turns the kind into its exit code; the library itself never exits.
enum class ErrorKind {
    Usage,   ///< contradictory or unknown options (exit 2)
    Input,   ///< a file or scene that cannot be used (exit 3)
    Failure  ///< something broke while working, such as a full disk (exit 1)
};

/// The one exception that the library throws on purpose. The message names the file, the place,
/// what was found, what was expected and what exists, in one sentence that a user can act on.
class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
    ErrorKind kind() const { return kind_; }

private:
    ErrorKind kind_;
};

}  // namespace woodcock
