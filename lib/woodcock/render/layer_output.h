// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "woodcock/render/path_tracer.h"

namespace woodcock::render {

/// Where paths write what layers ask of them. A path is known by its PathResult.
class LayerOutput {
public:
    LayerOutput() = default;
    /// `parts` must outlive this.
    LayerOutput(const image::LightParts& parts, std::span<const PathResult> results,
                const PathLayers& layers)
        : parts_(&parts), count_(parts.count()), first_(results.data()), layers_(layers) {}

    bool splitsLight() const { return count_ > 0; }
    /// The parts of a path's light; empty where none are asked for.
    std::span<Rgb> partsOf(const PathResult& result) const {
        return splitsLight() ? layers_.parts.subspan(indexOf(result) * count_, count_)
                             : std::span<Rgb>();
    }
    void add(const PathResult& result, image::LightKind kind, image::LightGroup group,
             Rgb light) const {
        const std::span<Rgb> parts = partsOf(result);
        if (parts_->kinds) parts[parts_->placeOf(kind)] += light;
        if (!parts_->groups.empty()) parts[parts_->placeOf(group)] += light;
    }
    image::PlaceSample* placeOf(const PathResult& result) const {
        return layers_.places.empty() ? nullptr : &layers_.places[indexOf(result)];
    }
    image::StopSample& stopsOf(const PathResult& result) const {
        return layers_.stops[indexOf(result)];
    }

private:
    std::size_t indexOf(const PathResult& result) const {
        return static_cast<std::size_t>(&result - first_);
    }

    const image::LightParts* parts_ = nullptr;
    std::size_t count_ = 0;
    const PathResult* first_ = nullptr;
    PathLayers layers_;
};

}  // namespace woodcock::render
