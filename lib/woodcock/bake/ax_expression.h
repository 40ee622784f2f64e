// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace woodcock {

class AxProgram;
struct VdbGrids;

/// Whether this build has OpenVDB AX. Without it, AxExpression's constructor says how to get it.
bool axAvailable();

/// Code in OpenVDB's expression language AX, compiled once and run over the voxels of grids:
/// `@density *= 1 - v@Cd.y;`. A name stands for the grid of that name, whose type it must give
/// (float where it gives none).
///
/// Only active values change, never which are active, and no grid is made. An active tile is taken
/// for the voxels that it stands for, and becomes leaves where they come to differ. The same code
/// and grids give the same bits on one machine, whatever the number of threads; AX compiles for the
/// processor at hand, so the last bit may depend on that.
///
/// Refused is what AX itself would let end the program or depend on threads: integers divided by
/// anything but a number other than 0; a component's index that is not a number or does not exist;
/// rand() without a seed; text; print(), external() and $variables. Loops may go round a million
/// times at a voxel.
class AxExpression {
public:
    /// `name` is the position of the code, as "cumulus.toml:12:8"; messages begin with it, followed
    /// by AX's own line and column within the code: "cumulus.toml:12:8: AX 2:14: ...". Errors:
    /// Input, for code that AX cannot compile or that is refused, and in a build without AX;
    /// Failure, where the library that holds it cannot be loaded.
    AxExpression(const std::string& code, const std::string& name);

    /// Runs the code over the grids that it writes. `goesOn` is asked now and then, from one other
    /// thread, whether it shall go on; returns false where it said no, and the grids are of no use
    /// then. Errors: Input, where the code names a grid that does not exist or has another type
    /// (the grids are untouched then), and where its loops go on for too long.
    bool run(VdbGrids& grids, const std::function<bool()>& goesOn = {}) const;

private:
    std::shared_ptr<const AxProgram> program_;
};

}  // namespace woodcock
