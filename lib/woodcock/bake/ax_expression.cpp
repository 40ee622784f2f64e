// SPDX-License-Identifier: Apache-2.0
#include "woodcock/bake/ax_expression.h"

#include "woodcock/bake/openvdb_ax_program.h"
#include "woodcock/base/error.h"
#include "woodcock/grid/vdb/openvdb_grids.h"

#ifdef WOODCOCK_AX_LIBRARY
#include <dlfcn.h>

#include <filesystem>
#include <vector>
#endif

namespace woodcock::bake {
namespace {

#ifdef WOODCOCK_AX_LIBRARY

namespace fs = std::filesystem;

/// The directories of the program and of libwoodcock, where that is shared.
std::vector<fs::path> ownDirectories() {
    std::error_code ignored;
    std::vector<fs::path> directories{fs::read_symlink("/proc/self/exe", ignored).parent_path()};
    Dl_info info{};
    dladdr(reinterpret_cast<const void*>(&axAvailable), &info);
    // A name without a directory is the name by which the program was called; here it may be any
    // file.
    const fs::path file = info.dli_fname ? info.dli_fname : "";
    if (file.has_parent_path()) directories.push_back(file.parent_path());
    return directories;
}

/// The library in the same installation or build, else wherever the system finds libraries.
fs::path axLibrary() {
    const fs::path library = WOODCOCK_AX_LIBRARY;
    for (const fs::path& own : ownDirectories()) {
        for (const fs::path& directory : {own, own / ".." / WOODCOCK_AX_DIRECTORY}) {
            std::error_code ignored;
            if (fs::exists(directory / library, ignored)) return directory / library;
        }
    }
    return library;
}

/// Never unloaded, as LLVM does not survive it.
CompileAx* loadAx() {
    void* library = dlopen(axLibrary().c_str(), RTLD_NOW | RTLD_LOCAL);
    void* symbol = library ? dlsym(library, "woodcockCompileAx") : nullptr;
    if (!symbol) throw failure("OpenVDB AX cannot be loaded: {}", dlerror());
    return reinterpret_cast<CompileAx*>(symbol);
}

std::shared_ptr<const AxProgram> compile(const std::string& code, const std::string& name) {
    static CompileAx* const compileAx = loadAx();
    return std::shared_ptr<const AxProgram>(compileAx(code, name));
}

#else

std::shared_ptr<const AxProgram> compile(const std::string&, const std::string& name) {
    throw inputError(
        "{}: this build has no OpenVDB AX; install libopenvdb-ax-dev and configure again", name);
}

#endif

}  // namespace

bool axAvailable() {
#ifdef WOODCOCK_AX_LIBRARY
    return true;
#else
    return false;
#endif
}

AxExpression::AxExpression(const std::string& code, const std::string& name)
    : program_(compile(code, name)) {}

bool AxExpression::run(grid::VdbGrids& grids, const std::function<bool()>& goesOn) const {
    return program_->run(grids.grids, goesOn);
}

}  // namespace woodcock::bake
