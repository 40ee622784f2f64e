// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace woodcock::render {

struct Scene;

/// What a scene needs of the path loop. It is found once, and only what is needed is run.
struct Needs {
    bool chromatic = false;   ///< the medium's channels differ: three are tracked instead of one
    bool overlap = false;     ///< more than one medium component
    bool scattering = false;  ///< sigma_s > 0 somewhere: otherwise camera rays only
    bool lightSampling =
        false;              ///< a light that sampling the phase function would miss or sample badly
    bool surfaces = false;  ///< rays look for surfaces, and media lie within them
    bool emission = false;  ///< media that emit
    bool localLights = false;  ///< lights near or inside the medium: equiangular sampling
    bool motion = false;       ///< something moves while the shutter is open: paths draw a time

    /// One line: what the scene needs and what was left out.
    std::string describe() const;
};

Needs findNeeds(const Scene& scene);

/// "uses scattering, light sampling": the parts of the path loop that a scene runs.
std::string usedOf(const Needs& needs);
/// "does not need emission, surfaces": the others; empty: there are none.
std::string unusedOf(const Needs& needs);

/// Counts of the inner loops, for --stats and for tests of cost.
struct RenderCounters {
    std::uint64_t paths = 0, scatterings = 0, shadowRays = 0;
    std::uint64_t distanceSegments = 0, distanceCollisions = 0;  ///< collisions include null ones
    std::uint64_t shadowSegments = 0, shadowCollisions = 0;
    std::uint64_t surfaceRays = 0;  ///< that looked for the nearest surface
    std::uint64_t clamped = 0;      ///< paths that brought more than Approximations::clamp

    RenderCounters& operator+=(const RenderCounters& b);
};

}  // namespace woodcock::render
