# SPDX-License-Identifier: Apache-2.0
# What the library needs. The installed package includes this file too: whoever links the static
# library links these.

# OpenVDB installs its find module outside CMake's search path.
find_path(WOODCOCK_OPENVDB_MODULE_DIR FindOpenVDB.cmake
    HINTS $ENV{OPENVDB_ROOT} ${OPENVDB_ROOT}
    PATH_SUFFIXES
        lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB lib/cmake/OpenVDB lib64/cmake/OpenVDB
    REQUIRED)
mark_as_advanced(WOODCOCK_OPENVDB_MODULE_DIR)
list(APPEND CMAKE_MODULE_PATH ${WOODCOCK_OPENVDB_MODULE_DIR})

# A function, because FindOpenVDB sets BUILD_SHARED_LIBS for whoever calls it, and talks a lot.
function(woodcock_find_openvdb)
    set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
    find_package(OpenVDB 10.0 QUIET REQUIRED COMPONENTS openvdb)
    set(OpenVDB_VERSION ${OpenVDB_VERSION} PARENT_SCOPE)
endfunction()
woodcock_find_openvdb()

# Through pkg-config: Debian's CMake packages of these two name files that are not installed.
find_package(PkgConfig REQUIRED)
pkg_check_modules(OpenImageIO REQUIRED IMPORTED_TARGET OpenImageIO>=2.4)
pkg_check_modules(OpenColorIO REQUIRED IMPORTED_TARGET OpenColorIO>=2.1)
# Sums are kept in EXR files by OpenEXR itself: OpenImageIO writes files of several parts to names
# alone, and reports no full disk. Version 2.4 cannot say that the samples of deep pixels are in
# order either. The hash of Cryptomatte is OpenEXR's too. OpenImageIO brings it along.
find_package(OpenEXR 3.1 CONFIG QUIET REQUIRED)

# Vectors of any processor, chosen when the program runs.
pkg_check_modules(Highway REQUIRED IMPORTED_TARGET libhwy>=1.0)
find_package(TBB 2021 REQUIRED COMPONENTS tbb)
find_package(fmt REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(muparser REQUIRED)
find_package(ZLIB REQUIRED)

# Surfaces: either version of Embree. EMBREE_VERSION tells which.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
    find_package(embree 3.12 QUIET)
endif()
if(NOT embree_FOUND)
    message(FATAL_ERROR "Embree 3.12 or newer, or 4, is missing (Debian: libembree-dev)")
endif()

# Without it the library still builds, and says so where a mesh other than PLY is to be read.
pkg_check_modules(Assimp QUIET IMPORTED_TARGET assimp>=5.2)

# NanoVDB is headers alone. Without it, or the compressions of its files, the library still builds,
# and says so where a .nvdb file is to be read or written.
find_path(NANOVDB_INCLUDE_DIR nanovdb/NanoVDB.h)
mark_as_advanced(NANOVDB_INCLUDE_DIR)
find_package(ZLIB QUIET)
pkg_check_modules(Blosc QUIET IMPORTED_TARGET blosc)
if(NANOVDB_INCLUDE_DIR AND ZLIB_FOUND AND Blosc_FOUND)
    set(NanoVDB_FOUND TRUE)
    file(STRINGS ${NANOVDB_INCLUDE_DIR}/nanovdb/NanoVDB.h NANOVDB_VERSION
        REGEX "#define NANOVDB_(MAJOR|MINOR|PATCH)_VERSION_NUMBER")
    string(REGEX REPLACE "[^;]*_NUMBER ([0-9]+)[^;]*" "\\1" NANOVDB_VERSION "${NANOVDB_VERSION}")
    string(REPLACE ";" "." NANOVDB_VERSION "${NANOVDB_VERSION}")
endif()
