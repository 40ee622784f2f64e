// SPDX-License-Identifier: Apache-2.0
// Properties of every volume, whatever is in it, that need no reference picture.
//
// One that oracles know is missing: thermal equilibrium (a medium that emits what it absorbs is
// invisible in light of its own colour), as media do not emit yet.
#include "woodcock/proof/checks/properties.h"

#include "woodcock/proof/checks/subjects.h"

namespace woodcock::proof {

std::vector<Check> properties() {
    std::vector<Check> all;
    for (const auto& part :
         {propertiesOfRays(), propertiesOfPaths(), propertiesOfPictures(), propertiesOfFilms()})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace woodcock::proof
