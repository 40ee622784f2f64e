// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/stand_ins.h"

#include "woodcock/base/error.h"
#include "woodcock/medium/octaves.h"
#include "woodcock/medium/similar_medium.h"

namespace woodcock {

StandIns::StandIns(const Scene& scene, const Approximations& choice) {
    if (choice.similarityAfter && choice.octaves > 0)
        throw usageError("octaves contradict similarity: they have no paths that go on");
    const auto add = [&](auto&& standInOf) {
        Set set{standInOf(scene.medium)};
        for (const Medium& medium : scene.interiors) set.push_back(standInOf(medium));
        sets.push_back(std::move(set));
    };
    if (choice.similarityAfter) add(similarMedium);
    for (int i = 0; i < choice.octaves; ++i)
        add([&](const Medium& medium) { return octaveMedium(medium, i); });
}

}  // namespace woodcock
