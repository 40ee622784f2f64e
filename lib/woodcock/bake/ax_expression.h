// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace woodcock::grid {
struct VdbGrids;
}

namespace woodcock::bake {

class AxProgram;

/// Whether this build has OpenVDB AX. Without it, AxExpression's constructor says how to get it.
bool axAvailable();

/// Code in OpenVDB's expression language AX, compiled once and run over the voxels of grids:
/// `@density *= 1 - v@Cd.y;`. A name is that of a grid, with the grid's type (float if none is
/// given).
///
/// Only active values change; active states stay, and no grid is made. An active tile counts as its
/// voxels, and becomes leaves where their values differ. The same code and grids give the same bits
/// on one machine, whatever the number of threads. AX compiles for the processor at hand, so the
/// last bit may differ between machines.
///
/// Code that could end the program, or whose result could depend on threads, is refused: integers
/// divided by anything but a constant other than 0; a component's index that is not a constant or
/// does not exist; rand() without a seed; text; print(), external() and $variables. Loops may run a
/// million rounds at a voxel.
class AxExpression {
public:
    /// `name` is the position of the code, as "cumulus.toml:12:8"; messages begin with it, followed
    /// by AX's own line and column within the code: "cumulus.toml:12:8: AX 2:14: ...". Errors:
    /// Input, for code that AX cannot compile or that is refused, and in a build without AX;
    /// Failure, where the library that holds it cannot be loaded.
    AxExpression(const std::string& code, const std::string& name);

    /// Runs the code over the grids that it writes. `goesOn` is called now and then, from one other
    /// thread. If it returns false, so does run(), and the grids are void. Errors: Input, where the
    /// code names a grid that does not exist or has another type (then the grids are unchanged),
    /// and where its loops run for too long.
    bool run(grid::VdbGrids& grids, const std::function<bool()>& goesOn = {}) const;

private:
    std::shared_ptr<const AxProgram> program_;
};

}  // namespace woodcock::bake
