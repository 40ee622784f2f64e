# SPDX-License-Identifier: Apache-2.0
# Writes one source of several tests, which compiles faster than they do one by one: most of their
# time is that of their headers. Tests have short names of their own, so each file's namespace gets
# a namespace inside.
#   cmake -D OUTPUT=FILE -D "SOURCES=FILE;..." -P join_tests.cmake
cmake_minimum_required(VERSION 3.25)
set(text "")
foreach(source IN LISTS SOURCES)
    file(READ ${source} code)
    file(RELATIVE_PATH name ${CMAKE_CURRENT_LIST_DIR} ${source})
    string(MAKE_C_IDENTIFIER ${name} name)
    string(REGEX REPLACE "\nnamespace woodcock::(test|proof) {" "\nnamespace woodcock::\\1::${name} {"
        code "${code}")
    string(APPEND text "#line 1 \"${source}\"\n${code}")
endforeach()
file(WRITE ${OUTPUT} "${text}")
