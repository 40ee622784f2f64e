# SPDX-License-Identifier: Apache-2.0
# What `woodcock --version` tells of a build. woodcock_facts(target) makes two headers for it:
# build_facts.h, when CMake configures, and build_commit.h, with every build.

function(woodcock_facts target)
    set(libraries)
    foreach(library
            "OpenVDB:${OpenVDB_VERSION}" "OpenVDB AX:${OpenVDBAX_VERSION}" "NanoVDB:${NANOVDB_VERSION}"
            "Embree:${embree_VERSION}" "oneTBB:${TBB_VERSION}${Tbb_VERSION}" "Assimp:${Assimp_VERSION}"
            "Blosc:${Blosc_VERSION}" "zlib:${ZLIB_VERSION_STRING}" "fmt:${fmt_VERSION}"
            "spdlog:${spdlog_VERSION}" "toml++:${tomlplusplus_VERSION}"
            "muParser:${muparser_VERSION}" "JSON for Modern C++:${nlohmann_json_VERSION}"
            "CLI11:${CLI11_VERSION}")
        string(REPLACE ":" ";" library ${library})
        list(POP_FRONT library name)
        if(NOT library)
            set(library "none")
        endif()
        list(APPEND libraries "${name} ${library}")
    endforeach()
    list(JOIN libraries ", " WOODCOCK_LIBRARIES)
    set(WOODCOCK_COMPILER "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
    set(WOODCOCK_BUILD_TYPE "${CMAKE_BUILD_TYPE}")
    file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/facts/build_facts.h @ONLY CONTENT [[
#pragma once
#define WOODCOCK_LIBRARIES "@WOODCOCK_LIBRARIES@"
#define WOODCOCK_COMPILER "@WOODCOCK_COMPILER@"
#define WOODCOCK_BUILD_TYPE "@WOODCOCK_BUILD_TYPE@"
]])
    add_custom_target(${target}_commit
        COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR}
            -DOUTPUT=${CMAKE_CURRENT_BINARY_DIR}/facts/build_commit.h
            -P ${PROJECT_SOURCE_DIR}/cmake/write-commit.cmake
        BYPRODUCTS ${CMAKE_CURRENT_BINARY_DIR}/facts/build_commit.h
        VERBATIM)
    add_dependencies(${target} ${target}_commit)
    target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/facts)
endfunction()
