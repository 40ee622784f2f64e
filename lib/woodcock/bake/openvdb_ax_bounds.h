// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb_ax/ast/AST.h>
#include <openvdb_ax/compiler/Logger.h>

#include <functional>
#include <memory>
#include <utility>

namespace woodcock::bake {

/// The most rounds of all loops of AX code together, at one voxel.
inline constexpr int mostAxRounds = 1'000'000;

/// External variables of bounded code. A float: where it is not 0, the code does nothing.
inline constexpr const char* axStopVariable = "woodcock_stop";
/// A vec3f that the code sets where its loops exceed mostAxRounds.
inline constexpr const char* axOverrunVariable = "woodcock_overrun";

using AxLocation = openvdb::ax::Logger::CodeLocation;

/// The same code, changed so that it ends. It does nothing while `axStopVariable` is set. Its loops
/// end after mostAxRounds rounds at a voxel, and then set `axOverrunVariable`. Casts are written as
/// assignments to variables of their type, as OpenVDB AX 10 ends the program where a value is cast
/// to the type that it has already. `locate` gives the positions of the code's nodes; the positions
/// of the result are told to the logger. Code that cannot be bounded is reported to it.
std::shared_ptr<const openvdb::ax::ast::Tree> boundAx(
    const openvdb::ax::ast::Tree& code,
    const std::function<AxLocation(const openvdb::ax::ast::Node&)>& locate,
    openvdb::ax::Logger& logger);

}  // namespace woodcock::bake
