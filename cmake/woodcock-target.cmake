# SPDX-License-Identifier: Apache-2.0
# How our own code is compiled: woodcock_target(name) for every target of this project, and
# woodcock_cold(name) after it for those that take no time when they run.

if(PROJECT_IS_TOP_LEVEL)
    find_program(CCACHE ccache)
    mark_as_advanced(CCACHE)
    if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
        # The tests include precompiled headers, which ccache must be told to look into.
        set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
    endif()
    if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
        set(CMAKE_BUILD_TYPE Release)
    endif()
endif()

if(WOODCOCK_BUILD_FUZZERS AND NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "WOODCOCK_BUILD_FUZZERS needs clang and its libFuzzer "
        "(Debian: clang, libclang-rt-14-dev): add -DCMAKE_CXX_COMPILER=clang++; "
        "this is ${CMAKE_CXX_COMPILER_ID}.")
endif()

function(woodcock_target name)
    target_compile_features(${name} PUBLIC cxx_std_20)
    set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF)
    target_compile_options(${name} PRIVATE
        -Wall -Wextra -Wpedantic -Wshadow -Wconversion
        $<$<BOOL:${WOODCOCK_WERROR}>:-Werror>
        # GCC 12 sees overlaps in std::string that are not there (its bug 105651).
        $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
        # Where it optimises less it takes values for uninitialised that are not.
        $<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Debug>>:-Wno-maybe-uninitialized>
        # Where several sources are compiled as one, they see each other's own names.
        $<$<BOOL:${CMAKE_UNITY_BUILD}>:-Wno-shadow>
        -fno-math-errno -fno-trapping-math
        # The same bits on every processor, whatever flags you add: a fused multiply-add rounds once
        # where two instructions round twice.
        -ffp-contract=off)
    if(WOODCOCK_BUILD_FUZZERS)
        target_compile_options(${name} PRIVATE -fsanitize=fuzzer-no-link,address)
        target_link_options(${name} PUBLIC -fsanitize=address)
    endif()
    if(WOODCOCK_SANITIZE)
        set(sanitizers -fsanitize=${WOODCOCK_SANITIZE})
        if(WOODCOCK_SANITIZE STREQUAL "address")
            set(sanitizers -fsanitize=address,undefined -fno-sanitize-recover=all)
        endif()
        target_compile_options(${name} PRIVATE ${sanitizers} -fno-omit-frame-pointer)
        target_link_options(${name} PUBLIC ${sanitizers})
    endif()
endfunction()

# Optimised less in release builds: that takes a third less time to compile.
function(woodcock_cold name)
    target_compile_options(${name} PRIVATE
        $<$<CONFIG:Release>:-O1>
        $<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Release>>:-Wno-maybe-uninitialized>)
endfunction()
