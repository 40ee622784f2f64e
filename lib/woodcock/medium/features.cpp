// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/features.h"

#include "woodcock/medium/medium.h"

namespace woodcock::medium {

Rgb scatteringAlbedo(const Medium& medium, Vec3d world, float time) {
    Rgb scattering, extinction;
    for (const MediumPart& part : medium.parts) {
        scattering += part.sigmaS(world, time);
        extinction += part.sigmaT(world, time);
    }
    return Rgb::map([&](int c) {
        return extinction[c] > 0 ? std::min(scattering[c] / extinction[c], 1.0f) : 0.0f;
    });
}

Vec3d densityNormal(const Medium& medium, Vec3d world, float time) {
    Vec3d gradient;
    for (const MediumPart& part : medium.parts) {
        if (!part.field()) continue;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3d step;
            step[axis] = 1;
            step =
                step * (1 / length(part.indexRay({}, step, time).direction));  // a voxel, in world
            const double difference = double{part.sigmaT(world + step, time).mean()} -
                                      double{part.sigmaT(world - step, time).mean()};
            gradient[axis] += difference / (2 * step[axis]);
        }
    }
    const double slope = length(gradient);
    return slope > 0 ? gradient * (-1 / slope) : Vec3d{};
}

}  // namespace woodcock::medium
