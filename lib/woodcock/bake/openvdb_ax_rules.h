// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb_ax/ast/AST.h>

#include <functional>
#include <string>

namespace woodcock::bake {

/// Reports code that AX compiles although it could end the program, or make its result depend on
/// threads; see AxExpression.
void checkAxRules(
    const openvdb::ax::ast::Tree& code,
    const std::function<void(const std::string& message, const openvdb::ax::ast::Node&)>& report);

}  // namespace woodcock::bake
