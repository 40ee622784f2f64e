# SPDX-License-Identifier: Apache-2.0
# Writes the file of tests that ctest includes: one for each suite of GoogleTest, as starting the
# program takes longer than most cases. Suites of SPLIT are one for each case.
#   cmake -D TESTS=PROGRAM -D OUTPUT=FILE -D TIMEOUT=SECONDS -D SPLIT="NAME..." -D LONG="NAME..."
#         -P discover_tests.cmake
# LONG: tests that ctest begins with, where it runs several at a time, the longest first.
cmake_minimum_required(VERSION 3.25)
separate_arguments(SPLIT)
separate_arguments(LONG)

execute_process(COMMAND ${TESTS} --gtest_list_tests OUTPUT_VARIABLE list
    COMMAND_ERROR_IS_FATAL ANY OUTPUT_STRIP_TRAILING_WHITESPACE)
string(REPLACE "\n" ";" list "${list}")
# "Suite." begins a line, "  Case" or "  Case/Parameter  # GetParam() = 1" is of the suite above.
set(names)
foreach(line IN LISTS list)
    if(line MATCHES "^([A-Za-z0-9_/]+)\\.( |$)")
        set(suite ${CMAKE_MATCH_1})
        if(NOT suite IN_LIST SPLIT)
            list(APPEND names ${suite}.*)
        endif()
    elseif(line MATCHES "^  ([A-Za-z0-9_/]+)" AND suite IN_LIST SPLIT)
        list(APPEND names ${suite}.${CMAKE_MATCH_1})
    endif()
endforeach()

list(LENGTH LONG cost)
set(text "")
foreach(name IN LISTS names)
    string(APPEND text "add_test([[${name}]] \"${TESTS}\" [[--gtest_filter=${name}]])\n"
        "set_tests_properties([[${name}]] PROPERTIES TIMEOUT ${TIMEOUT} SKIP_RETURN_CODE 77")
    list(FIND LONG ${name} place)
    if(NOT place EQUAL -1)
        math(EXPR points "${cost} - ${place}")
        string(APPEND text " COST ${points}")
    endif()
    string(APPEND text ")\n")
endforeach()
foreach(name IN LISTS LONG)
    if(NOT name IN_LIST names)
        message(FATAL_ERROR "tests/CMakeLists.txt names the long test ${name}, which is none")
    endif()
endforeach()
file(WRITE ${OUTPUT} "${text}")
