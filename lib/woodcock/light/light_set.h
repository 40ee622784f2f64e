// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "woodcock/base/moving_numbers.h"
#include "woodcock/base/moving_transform.h"
#include "woodcock/light/light.h"

namespace woodcock::light {

/// How a local light changes within the shutter.
struct LightMotion {
    /// From where it is at rest to where it is at a time: rotations and translations. Null: it
    /// stands still.
    std::shared_ptr<const MovingTransform> place;
    std::shared_ptr<const MovingNumbers<std::tuple_size_v<LightForm>>> form;  ///< null: it stays
};

/// The lights of a scene, and the choice among them. Local lights may move and change within the
/// shutter: a light of the form that it has at a time is asked where it is at rest, for points that
/// were taken there. Emissive surfaces know their motion themselves. Times are those of paths,
/// within the shutter.
class LightSet {
public:
    LightSet() = default;
    /// `motions`: of each light or of none. `groups`: as group(), one for each light; empty: 0.
    using Motions = std::vector<LightMotion>;
    explicit LightSet(std::vector<Light> lights, Motions motions = {},
                      std::vector<std::uint8_t> groups = {});

    const std::vector<Light>& lights() const { return lights_; }
    const Light& operator[](int light) const { return lights_[static_cast<std::size_t>(light)]; }
    /// Its position is that at rest: see position().
    const LightTraits& traits(int light) const { return traits_[static_cast<std::size_t>(light)]; }
    bool moves() const { return !moving_.empty(); }  ///< whether any light moves or changes

    /// The number of the light group that a light, or one of the mesh's triangles, counts to; 0:
    /// none.
    std::uint8_t group(int light, std::uint32_t emitter = LightSample::none) const {
        return emitter == LightSample::none ? groups_[static_cast<std::size_t>(light)]
                                            : mesh()->triangles()[emitter].group;
    }

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

    LightSample sample(int light, Vec3d from, double u0, double u1, float time = 0) const {
        if (moves(light)) [[unlikely]]
            return sampleMoving(light, from, u0, u1, time);
        return (*this)[light].sample(from, u0, u1);
    }
    /// 0 for emissive surfaces: a direction does not say which triangle it meets. Ask mesh().
    double pdf(int light, Vec3d from, Vec3d direction, float time = 0) const {
        if (moves(light)) [[unlikely]]
            return pdfMoving(light, from, direction, time);
        return (*this)[light].pdf(from, direction);
    }
    /// Where a ray meets the light; see Light::meet().
    LightHit meet(int light, Vec3d origin, Vec3d direction, float time = 0) const {
        if (moves(light)) [[unlikely]]
            return meetMoving(light, origin, direction, time);
        return (*this)[light].meet(origin, direction);
    }
    /// See Light::narrow().
    void narrow(int light, Vec3d origin, Vec3d direction, float time, double& t0,
                double& t1) const {
        if (moves(light)) [[unlikely]]
            return narrowMoving(light, origin, direction, time, t0, t1);
        (*this)[light].narrow(origin, direction, t0, t1);
    }
    /// Of a local light; see LightTraits.
    std::optional<Vec3d> position(int light, float time = 0) const {
        const std::optional<Vec3d>& at = traits(light).position;
        return moves(light) && at ? positionMoving(light, *at, time) : at;
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
    bool moves(int light) const {
        return !moving_.empty() && moving_[static_cast<std::size_t>(light)] != 0;
    }
    LightSample sampleMoving(int light, Vec3d from, double u0, double u1, float time) const;
    double pdfMoving(int light, Vec3d from, Vec3d direction, float time) const;
    LightHit meetMoving(int light, Vec3d origin, Vec3d direction, float time) const;
    void narrowMoving(int light, Vec3d origin, Vec3d direction, float time, double& t0,
                      double& t1) const;
    Vec3d positionMoving(int light, Vec3d atRest, float time) const;
    double importance(int light, const ScatterPoint& at) const;

    std::vector<Light> lights_;
    Motions motions_;           // of each
    std::vector<char> moving_;  // whether it moves or changes, of each; empty: none does
    std::vector<LightTraits> traits_;
    std::vector<std::uint8_t> groups_;
    std::vector<int> sampled_, local_, meetable_, distant_;
    int mesh_ = -1;
};

}  // namespace woodcock::light
