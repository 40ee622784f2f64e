// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/random.h"
#include "woodcock/light/light.h"

namespace woodcock::test {

using Triangle = light::MeshLight::Triangle;
using Triangles = std::vector<Triangle>;

inline Vec3d direction(RandomStream& random) {
    const double z = 2 * random.uniform() - 1, r = std::sqrt(1 - z * z);
    const double phi = 2 * pi * random.uniform();
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Faces along cross(across, up).
inline void addRectangle(Triangles& to, Vec3d corner, Vec3d across, Vec3d up,
                         Rgb radiance = Rgb(1.0f)) {
    to.push_back({{corner, corner + across, corner + across + up}, radiance});
    to.push_back({{corner, corner + across + up, corner + up}, radiance});
}

/// Sides of 2 around the centre; faces outwards, or inwards.
inline Triangles cube(Vec3d centre, bool inwards) {
    Triangles t;
    for (int axis = 0; axis < 3; ++axis)
        for (double sign : {-1.0, 1.0}) {
            Vec3d n, a, b;
            n[axis] = sign, a[(axis + 1) % 3] = 2, b[(axis + 2) % 3] = 2 * sign;
            if (inwards) b = -b;
            addRectangle(t, centre + n - a * 0.5 - b * 0.5, a, b);
        }
    return t;
}

/// A sphere of radius 1 around `centre`, facing outwards; all corners on it.
inline Triangles sphere(Vec3d centre, int rings) {
    const auto at = [&](int ring, int step) {
        const double theta = pi * ring / rings, phi = pi * step / rings;
        return centre + Vec3d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                              std::cos(theta)};
    };
    Triangles t;
    for (int ring = 0; ring < rings; ++ring)
        for (int step = 0; step < 2 * rings; ++step) {
            if (ring > 0)
                t.push_back({{at(ring, step), at(ring + 1, step), at(ring, step + 1)}, Rgb(1.0f)});
            if (ring + 1 < rings)
                t.push_back(
                    {{at(ring + 1, step), at(ring + 1, step + 1), at(ring, step + 1)}, Rgb(1.0f)});
        }
    return t;
}

/// Triangles of size `size` anywhere within 1 of the origin, some of both sides.
inline Triangles cloud(int count, double size, RandomStream& random) {
    Triangles t;
    for (int i = 0; i < count; ++i) {
        const Vec3d p = direction(random) * std::cbrt(random.uniform());
        t.push_back({{p, p + direction(random) * size, p + direction(random) * size},
                     Rgb(static_cast<float>(1 - std::log(1 - 0.99 * random.uniform()))),
                     random.uniform() < 0.2});
    }
    return t;
}

inline Triangles moved(Triangles t, double scale, Vec3d by) {
    for (Triangle& triangle : t)
        for (Vec3d& c : triangle.corner) c = c * scale + by;
    return t;
}

struct Sample {
    light::LightSample light;
    std::uint32_t triangle = 0;
};
inline Sample draw(const light::MeshLight& light, Vec3d from, RandomStream& random) {
    Sample s;
    const double u0 = random.uniform();
    s.light = light.sample(from, u0, random.uniform());
    if (s.light.emitter != light::LightSample::none) s.triangle = s.light.emitter;
    return s;
}

}  // namespace woodcock::test
