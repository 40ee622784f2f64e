// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "woodcock/medium/depth_grid.h"
#include "woodcock/render/approximate_media.h"
#include "woodcock/render/approximations.h"
#include "woodcock/render/scene.h"

namespace woodcock::render {

/// Grids of the optical depth from any point outside of all surfaces to the scene's suns, and to
/// lamps that stand outside of the medium, for the scene's own medium and those that approximations
/// use in its place. Shared by all threads. What they hold decides how large the noise is, and
/// never what is expected.
class LightDepths {
public:
    /// The scene and the media must outlive this.
    LightDepths(const Scene& scene, const Approximations& approximations,
                const ApproximateMedia& media);

    /// For a set of media, as the MediaTable numbers them, and a light by its index. Null: there is
    /// none, and its shadow rays are tracked.
    const medium::DepthGrid* find(std::uint8_t mediumSet, int light) const {
        const std::size_t i = mediumSet * lights_ + static_cast<std::size_t>(light);
        return i < grids_.size() ? grids_[i].get() : nullptr;
    }

    std::size_t bytesAtMost() const;  ///< once all of them are made

private:
    void add(const Scene& scene, const medium::Medium& medium);

    std::size_t lights_;
    std::vector<std::unique_ptr<const medium::DepthGrid>> grids_;  // by set, then by light
};

/// Memory that the grids of a render of the scene take at most, in bytes.
double bytesOfLightDepths(const Scene& scene, const Approximations& approximations);

}  // namespace woodcock::render
