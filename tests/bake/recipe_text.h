// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/bake/baker.h"
#include "woodcock/bake/recipe.h"

namespace woodcock::test {

/// A recipe with one output, `density`, of these nodes.
inline bake::Recipe recipeOf(const std::string& nodes, const std::string& output = "thing",
                             const std::string& bounds = "min = [-2, -2, -2]\nmax = [2, 2, 2]") {
    return bake::makeRecipe({"[bounds]\n" + bounds + "\n" + nodes +
                                 "\n[[output]]\nname = \"density\"\nnode = \"" + output + "\"\n",
                             "test.toml", ""},
                            {});
}

}  // namespace woodcock::test
