// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "woodcock/light/light.h"

namespace woodcock::light {

/// The lights of a scene, and the choice among them.
class LightSet {
public:
    LightSet() = default;
    explicit LightSet(std::vector<Light> lights);

    const std::vector<Light>& lights() const { return lights_; }
    const Light& operator[](int light) const { return lights_[static_cast<std::size_t>(light)]; }
    const LightTraits& traits(int light) const { return traits_[static_cast<std::size_t>(light)]; }

    /// Indices of the lights that next-event estimation samples: all but constant environments,
    /// which the phase function samples perfectly by itself.
    std::span<const int> sampled() const { return sampled_; }
    /// Indices of the local lights: those with a position.
    std::span<const int> local() const { return local_; }
    /// Indices of the lights that rays can meet on their way.
    std::span<const int> meetable() const { return meetable_; }
    /// Indices of the lights whose radiance rays meet that escape.
    std::span<const int> distant() const { return distant_; }
    /// Index of the emissive surfaces, of which a set has at most one; -1: none.
    int meshIndex() const { return mesh_; }
    const MeshLight* mesh() const;  ///< null: none

    /// Probabilities, one for each of sampled(), in proportion to each light's importance: what it
    /// would send through the phase function if nothing were in between. They sum to 1, or are all
    /// zero.
    void pickProbabilities(const ScatterPoint& at, std::span<float> probabilities) const;

    LightSample sample(int light, Vec3d from, double u0, double u1) const {
        return (*this)[light].sample(from, u0, u1);
    }
    /// 0 for emissive surfaces: a direction does not say which triangle it meets. Ask mesh().
    double pdf(int light, Vec3d from, Vec3d direction) const {
        return (*this)[light].pdf(from, direction);
    }

    /// Radiance that an infinitely far light (environment, a sun's disc) sends from a direction
    /// (world). 0 for other lights; 0 for camera rays where the light is invisible to them.
    Rgb distantRadiance(int light, Vec3d direction, bool cameraRay) const;
    /// Whether camera rays may see any such light.
    bool showsBackground() const;

    /// Roughly the radiance, largest channel, that these lights make in a scattering medium of such
    /// bounds (world). Russian roulette compares with it; it changes the cost alone.
    float typicalRadiance(const Box3d& bounds) const;

private:
    std::vector<Light> lights_;
    std::vector<LightTraits> traits_;
    std::vector<int> sampled_, local_, meetable_, distant_;
    int mesh_ = -1;
};

}  // namespace woodcock::light
