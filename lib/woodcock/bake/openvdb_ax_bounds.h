// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb_ax/ast/AST.h>
#include <openvdb_ax/compiler/Logger.h>

#include <functional>
#include <memory>
#include <utility>

namespace woodcock {

/// How often the loops of AX code may go round at one voxel, all of them together.
inline constexpr int mostAxRounds = 1'000'000;

/// External variables of bounded code. A float: where it is not 0, the code does nothing.
inline constexpr const char* axStopVariable = "woodcock_stop";
/// A vec3f that the code sets where its loops go round more often than they may.
inline constexpr const char* axOverrunVariable = "woodcock_overrun";

using AxLocation = openvdb::ax::Logger::CodeLocation;

/// The same code, such that it ends. It does nothing while `axStopVariable` is set, and its loops
/// end after mostAxRounds rounds at a voxel, which `axOverrunVariable` then tells. Casts are
/// written as assignments to variables of their type, as OpenVDB AX 10 ends the program where a
/// value is cast to the type that it has already. `locate` gives the places of the code's nodes;
/// those of the result are told to the logger. What cannot be bounded is reported.
std::shared_ptr<const openvdb::ax::ast::Tree> boundAx(
    const openvdb::ax::ast::Tree& code,
    const std::function<AxLocation(const openvdb::ax::ast::Node&)>& locate,
    openvdb::ax::Logger& logger);

}  // namespace woodcock
