// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>

#include <string>

namespace woodcock {

/// Compiled AX code. It lives in a library of its own, woodcock_ax, which is loaded when it is
/// first needed: OpenVDB AX brings LLVM, which every start of the program would pay for otherwise.
class AxProgram {
public:
    virtual ~AxProgram() = default;
    virtual void run(openvdb::GridPtrVec& grids) const = 0;
};

/// What the library offers, as woodcockCompileAx; see AxExpression. The program is the caller's.
using CompileAx = AxProgram*(const std::string& code, const std::string& name);

}  // namespace woodcock
