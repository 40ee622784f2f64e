# SPDX-License-Identifier: Apache-2.0
# OpenVDB AX, for expressions in recipes: OpenVDBAX_FOUND and the target OpenVDB::AX. Only building
# needs it, whoever links the library does not.

set(WOODCOCK_WITH_AX AUTO CACHE STRING "Expressions in OpenVDB AX: AUTO (where it is found), ON, OFF")
set_property(CACHE WOODCOCK_WITH_AX PROPERTY STRINGS AUTO ON OFF)

set(OpenVDBAX_FOUND FALSE)
if(WOODCOCK_WITH_AX)
    get_target_property(openvdb OpenVDB::openvdb IMPORTED_LOCATION)
    cmake_path(GET openvdb PARENT_PATH openvdb)
    find_path(OpenVDBAX_INCLUDE_DIR openvdb_ax/ax.h HINTS ${openvdb}/../include)
    find_library(OpenVDBAX_LIBRARY openvdb_ax HINTS ${openvdb})
    mark_as_advanced(OpenVDBAX_INCLUDE_DIR OpenVDBAX_LIBRARY)
    if(OpenVDBAX_INCLUDE_DIR AND OpenVDBAX_LIBRARY)
        set(OpenVDBAX_FOUND TRUE)
        set(OpenVDBAX_VERSION ${OpenVDB_VERSION})  # they are released as one
        add_library(OpenVDB::AX UNKNOWN IMPORTED)
        set_target_properties(OpenVDB::AX PROPERTIES IMPORTED_LOCATION ${OpenVDBAX_LIBRARY})
        target_include_directories(OpenVDB::AX INTERFACE ${OpenVDBAX_INCLUDE_DIR})
        target_link_libraries(OpenVDB::AX INTERFACE OpenVDB::openvdb)
    elseif(NOT WOODCOCK_WITH_AX STREQUAL "AUTO")
        message(FATAL_ERROR "OpenVDB AX is missing (Debian: libopenvdb-ax-dev); "
            "-DWOODCOCK_WITH_AX=OFF builds without expressions.")
    else()
        message(STATUS "OpenVDB AX is missing (Debian: libopenvdb-ax-dev): no expressions")
    endif()
endif()
