// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/approximate_media.h"

#include "woodcock/base/error.h"
#include "woodcock/medium/octaves.h"
#include "woodcock/medium/similar_medium.h"

namespace woodcock::render {

ApproximateMedia::ApproximateMedia(const Scene& scene, const Approximations& choice) {
    if (choice.similarityAfter && choice.octaves > 0)
        throw usageError(
            "octaves and similarity exclude each other: octaves end the paths that similarity "
            "changes; "
            "choose one");
    const auto add = [&](auto&& replacementOf) {
        Set set{replacementOf(scene.medium)};
        for (const medium::Medium& medium : scene.interiorMedia)
            set.push_back(replacementOf(medium));
        sets.push_back(std::move(set));
    };
    if (choice.similarityAfter) add(medium::similarMedium);
    for (int i = 0; i < choice.octaves; ++i)
        add([&](const medium::Medium& medium) { return medium::octaveMedium(medium, i); });
}

}  // namespace woodcock::render
