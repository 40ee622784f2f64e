// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>

#include <functional>
#include <string>

namespace woodcock {

/// Compiled AX code. It lives in a library of its own, woodcock_ax, which is loaded when it is
/// first needed: OpenVDB AX brings LLVM, which every start of the program would pay for otherwise.
class AxProgram {
public:
    virtual ~AxProgram() = default;
    /// Asks `goesOn` now and then, from another thread, unless it is empty; returns false where
    /// that said no, and the grids are of no use then.
    virtual bool run(openvdb::GridPtrVec& grids, const std::function<bool()>& goesOn) const = 0;
};

/// What the library offers, as woodcockCompileAx; see AxExpression. The program is the caller's.
using CompileAx = AxProgram*(const std::string& code, const std::string& name);

}  // namespace woodcock
