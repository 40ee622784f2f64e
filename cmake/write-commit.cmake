# SPDX-License-Identifier: Apache-2.0
# Writes the commit of the source tree SOURCE into the header OUTPUT, which stays untouched where
# that is what it says already. Empty where SOURCE is not the top of a Git repository.

set(commit "")
find_program(GIT git)
if(GIT)
    set(git env GIT_OPTIONAL_LOCKS=0 ${GIT} -C ${SOURCE})
    execute_process(COMMAND ${git} rev-parse --show-toplevel
        OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    file(REAL_PATH ${SOURCE} source)
    if(top STREQUAL source)
        execute_process(COMMAND ${git} describe --always --dirty=+changes --exclude=* --abbrev=12
            OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define WOODCOCK_COMMIT \"${commit}\"\n")
