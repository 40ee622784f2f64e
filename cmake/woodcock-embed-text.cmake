# SPDX-License-Identifier: Apache-2.0
# woodcock_embed_text(target namespace file symbol): compiles a text file into `target` as
# `extern const std::string_view namespace::symbol`, remade whenever the file changes.

function(woodcock_embed_text target namespace file symbol)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} text)
    # Compilers limit a literal's length: adjacent literals, one for each line, do not.
    string(REPLACE "\\" "\\\\" text "${text}")
    string(REPLACE "\"" "\\\"" text "${text}")
    string(REPLACE "\n" "\\n\"\n    \"" text "${text}")
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${symbol}.cpp)
    file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[
#include <string_view>

namespace @namespace@ {
extern const std::string_view @symbol@;
const std::string_view @symbol@ =
    "@text@";
}
]])
    target_sources(${target} PRIVATE ${source})
endfunction()

# woodcock_embed_texts(target namespace folder file:symbol...)
function(woodcock_embed_texts target namespace folder)
    foreach(entry IN LISTS ARGN)
        string(REPLACE ":" ";" entry ${entry})
        list(GET entry 0 file)
        list(GET entry 1 symbol)
        woodcock_embed_text(${target} ${namespace} ${folder}/${file} ${symbol})
    endforeach()
endfunction()
