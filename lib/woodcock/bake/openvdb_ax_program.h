// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>

#include <functional>
#include <string>

namespace woodcock::bake {

/// Compiled AX code. It is in a library of its own, woodcock_ax, which is loaded when it is first
/// needed: OpenVDB AX loads LLVM, which would slow every start of the program.
class AxProgram {
public:
    virtual ~AxProgram() = default;
    /// Calls `goesOn`, unless it is empty, now and then from another thread. If that returns false,
    /// so does run(), and the grids are void.
    virtual bool run(openvdb::GridPtrVec& grids, const std::function<bool()>& goesOn) const = 0;
};

/// The library's function woodcockCompileAx; see AxExpression. The caller owns the program.
using CompileAx = AxProgram*(const std::string& code, const std::string& name);

}  // namespace woodcock::bake
