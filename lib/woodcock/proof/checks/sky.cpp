// SPDX-License-Identifier: Apache-2.0
// The sky as it is drawn and sampled, an image of the model, against quadrature of the model.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/random.h"
#include "woodcock/light/light.h"
#include "woodcock/light/sky_model.h"
#include "woodcock/proof/checks/cells.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::proof {
namespace {

/// On a plane with this normal, by the model: Gauss and Legendre's rule in the zenith angle.
double irradianceByModel(const light::SkyModel& sky, Rgb ground, Vec3d normal, int channel) {
    constexpr int around = 720;
    const auto ring = [&](double zenith) {
        double sum = 0;
        for (int i = 0; i < around; ++i) {
            const double phi = 2 * pi * (i + 0.5) / around, sine = std::sin(zenith);
            const Vec3d d{sine * std::sin(phi), std::cos(zenith), -sine * std::cos(phi)};
            const Rgb l = d.y > 0 ? sky.radiance(d) : ground;
            sum += std::max(0.0, dot(d, normal)) * double{l[channel]} * sine;
        }
        return sum * 2 * pi / around;
    };
    // Apart where the sky begins, and finer above it.
    return integrate(0, 1.4, 200, ring) + integrate(1.4, pi / 2, 200, ring) +
           integrate(pi / 2, pi, 200, ring);
}

void skyImages(Lab& lab) {
    const struct {
        double elevation, turbidity;
        Rgb albedo;
    } skies[]{{60, 2, Rgb(0.2f)},
              {15, 4, {0.3f, 0.2f, 0.1f}},
              {2, 3, Rgb(0.2f)},
              {0, 10, Rgb(0.8f)},
              {90, 1, Rgb(0)}};
    const Affine3d turned = Affine3d::rotate(1, 40) * Affine3d::rotate(0, 90);
    for (const auto& k : skies) {
        const light::SkyModel sky({k.elevation, k.turbidity, k.albedo});
        const Rgb ground = light::groundRadiance(sky, k.albedo, 1);
        constexpr int width = light::skyImageWidth;
        const light::Environment image({width, width / 2, light::skyImage(sky, ground, width)},
                                       Rgb(1.0f), turned, true);
        const std::string name =
            fmt::format("sun {} degrees high, turbidity {}", k.elevation, k.turbidity);

        const Vec3d level{0, 1, 0}, facing = normalize(Vec3d{0.3, 0.1, -1});
        const double onLevel = irradianceByModel(sky, ground, level, 2);
        const double onFacing = irradianceByModel(sky, ground, facing, 0);
        lab.add(exactCase("irradiance of the level ground, as the model says, " + name, 1,
                          sky.skyIrradiance()[2] / onLevel, 1e-3, "its quadrature is coarser"));
        RandomStream random(lab.seed(name));
        Moments toLevel, toFacing;
        double worst = 0;
        const int n = lab.pick(100000, 2000000);
        for (int i = 0; i < n; ++i) {
            const light::LightSample s = image.sample({}, random.uniform(), random.uniform());
            const Vec3d d = turned.inverse().vector(s.direction);
            toLevel.add(s.weight[2] * std::max(0.0, dot(d, level)) / onLevel);
            toFacing.add(s.weight[0] * std::max(0.0, dot(d, facing)) / onFacing);
            const double density = image.pdf({}, s.direction);
            const double radiance = double{image.radiance(s.direction)[1]};
            // Between two pixels, rounding decides on the density.
            if (std::abs(density / s.pdf - 1) < 1e-6)
                worst = std::max(worst, std::abs(s.weight[1] * density / radiance - 1));
            else
                worst += 1e-3 / n;
        }
        const auto add = [&](const std::string& what, const Moments& moments) {
            Case c = meanCase(what + name, 1, moments, lab.pick(2e-2, 4e-3));
            c.allowance += 1e-3;
            c.note = "interpolation in the image is allowed for";
            lab.add(c);
        };
        add("irradiance of the level ground over that by quadrature, ", toLevel);
        add("irradiance of a plane that stands over that by quadrature, ", toFacing);
        lab.add(exactCase("largest difference of weight times density and radiance, " + name, 0,
                          worst, 1e-5));
    }
}

}  // namespace

std::vector<Check> skies() { return {{Kind::Sampling, "skies", skyImages}}; }

}  // namespace woodcock::proof
