// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "woodcock/camera/camera_rays.h"
#include "woodcock/render/media_table.h"
#include "woodcock/render/nested_media.h"
#include "woodcock/render/path_state.h"
#include "woodcock/render/path_tracer.h"

namespace woodcock::render {

/// A scene as the stages read it. It does not change while paths are traced.
struct TracedScene {
    const Scene& scene;
    const Needs needs;
    const PathTracer::Options options;
    const camera::CameraRays cameraRays;
    const float typicalRadiance;  ///< in the scene's media; what roulette compares with
    const MediaTable media;
    const bool severalEvents;  ///< near suns: see several_events.h
    // Where there are surfaces:
    std::optional<NestedMedia> surfaces;
    /// Where all camera rays start at one point of a scene at rest.
    std::optional<NestedMedia::CameraPosition> aroundCamera;

    TracedScene(const Scene& s, const Needs& n, const PathTracer::Options& o)
        : scene(s),
          needs(n),
          options(o),
          cameraRays(s.camera, o.width, o.height),
          typicalRadiance(s.lights.typicalRadiance(s.bounds())),
          media(s, n, o.approximations, o.approximateMedia),
          severalEvents(o.lightDepths && !media.replaces() && thickAndPeaked(media[0])) {
        if (!n.surfaces) return;
        surfaces.emplace(s);
        if (s.camera.kind == camera::Camera::Kind::Perspective && !s.camera.motion &&
            !s.surfaces->geometry.moves())
            aroundCamera = surfaces->cameraPosition(s.camera.worldFromCamera.translation, 0);
    }

    /// The start of a camera ray, where there are surfaces.
    NestedMedia::RayStart startOf(Vec3d origin, Vec3d direction, float time) const {
        return surfaces->rayStart(
            aroundCamera ? *aroundCamera : surfaces->cameraPosition(origin, time), direction);
    }

    /// The number in `media` of the medium around a ray.
    std::uint32_t mediumAround(std::uint8_t mediumSet, const MediumStack& inside) const {
        return media.number(mediumSet, surfaces->medium(inside));
    }
    /// The medium around a path, as that set of media has it.
    template <int N, bool Surfaces>
    const MediumSummary& mediumAround(const PathState<N, Surfaces>& p,
                                      std::uint8_t mediumSet) const {
        if constexpr (Surfaces)
            return media[mediumAround(mediumSet, p.surfaces.way.inside())];
        else
            return media[media.number(mediumSet, 0)];
    }
    /// The medium outside of all surfaces, in a set of media.
    const medium::Medium& mediumOfSet(std::uint8_t mediumSet) const {
        return *media[media.number(mediumSet, 0)].medium;
    }
    /// The grid of a light's optical depth in a set of media; null: there is none.
    const medium::DepthGrid* lightDepth(std::uint8_t mediumSet, int light) const {
        return options.lightDepths ? options.lightDepths->find(mediumSet, light) : nullptr;
    }
    /// Whether a path that has scattered so often may do so again.
    bool mayScatter(std::int64_t scatterings) const {
        return !options.maxScatterings || scatterings < *options.maxScatterings;
    }
    template <int N, bool Surfaces>
    Flight flightOf(const PathState<N, Surfaces>& p) const {
        Flight flight{.origin = p.origin,
                      .direction = p.direction,
                      .time = p.time,
                      .medium = &media[p.medium]};
        if constexpr (Surfaces) flight.tMax = p.surfaces.way.tMax();
        return flight;
    }
};

}  // namespace woodcock::render
