// SPDX-License-Identifier: Apache-2.0
// Lights are sampled in proportion to their stated density, and give the right irradiance. Constant
// environments are sampled by the phase function.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/random.h"
#include "woodcock/light/light.h"
#include "woodcock/proof/checks/cells.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/support/sky.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::proof {

namespace {

const Vec3d axis = normalize(Vec3d{0.3, 0.8, -0.4});

// ---- lights that fill a cone, or a point ------------------------------------------------------

/// A light that is even over the cone of 1 - cos = `cone` around the axis.
void addCone(Lab& lab, const std::string& name, double cone, double irradiance,
             const std::function<light::LightSample(double, double)>& sample,
             const std::function<double(Vec3d)>& pdf) {
    const int n = lab.pick(50000, 1000000);
    RandomStream random(lab.seed(name));
    Cells cells(10, 10);
    Moments arriving;
    double worst = 0;
    for (int i = 0; i < n; ++i) {
        const double u = random.uniform();
        const light::LightSample s = sample(u, random.uniform());
        cells.add(below(s.direction, axis) / cone, turn(axis, s.direction));
        arriving.add(s.weight[0] * dot(s.direction, axis) / irradiance);
        // The rim itself is in or out by rounding.
        if (u < 1 - 1e-6) worst = std::max(worst, std::abs(pdf(s.direction) / s.pdf - 1));
    }
    lab.add(cells.asCase("directions, " + name));
    lab.add(
        meanCase("irradiance over its closed form, " + name, 1, arriving, lab.pick(1e-2, 1e-3)));
    lab.add(
        exactCase("largest difference of sampled and evaluated density, " + name, 0, worst, 1e-9));
    // Midpoints, out to four times the cone: its edge falls into one of the cells.
    const int steps = lab.pick(20000, 200000);
    const double reach = std::min(2.0, 4 * cone), step = reach / steps;
    double integral = 0;
    for (int i = 0; i < steps; ++i)
        integral += 2 * pi * step * pdf(around(axis, (i + 0.5) * step, i * 2.4));
    for (double b = reach * 1.01; b < 2; b *= 1.2) integral += pdf(around(axis, b, 100 * b));
    lab.add(exactCase("integral of the density, " + name, 1, integral, step / cone,
                      "the edge lies in one of the quadrature's cells"));
}

void sun(Lab& lab) {
    for (const double degrees : {1e-4, 0.53, 10.0, 90.0}) {
        const light::Sun light(-axis * 7.0, Rgb(3.0f), degrees, true);
        const double half = degrees * pi / 360, cone = 2 * std::pow(std::sin(half / 2), 2);
        const std::string name = fmt::format("sun {} degrees wide", degrees);
        addCone(
            lab, name, cone, 3, [&](double u, double v) { return light.sample({}, u, v); },
            [&](Vec3d d) { return light.pdf({}, d); });
        const double disc = 2 * pi * integrate(0, cone, 64, [&](double b) {
                                return (1 - b) * light.radiance(around(axis, b, 1))[0];
                            });
        lab.add(exactCase("irradiance by its radiance, " + name, 3, disc, 3e-6));
    }
    const light::LightSample s = light::Sun(-axis, Rgb(3.0f), 0, false).sample({}, 0.3, 0.7);
    lab.add(
        exactCase("irradiance of parallel rays", 3, s.weight[0] * dot(s.direction, axis), 1e-6));
}

void localLights(Lab& lab) {
    for (const double distance : {1.0001, 1.01, 1.5, 10.0, 1e4, 1e7}) {
        const double radius = 2.5, sine = 1 / distance;
        const Vec3d from{5, -3, 2};
        const light::SphereLight light{from + axis * (radius * distance), radius, Rgb(2.0f)};
        addCone(
            lab, fmt::format("sphere {:.7g} radii away", distance),
            sine * sine / (1 + std::sqrt(1 - sine * sine)), 2 * pi * sine * sine,
            [&](double u, double v) { return light.sample(from, u, v); },
            [&](Vec3d d) { return light.pdf(from, d); });
    }
    for (const double distance : {1e-3, 1.0, 1e5}) {
        const light::LightSample s = light::PointLight{axis * distance, Rgb(5.0f)}.sample({}, 0, 0);
        lab.add(
            exactCase(fmt::format("irradiance of a point {} away over its closed form", distance),
                      1, s.weight[0] * dot(s.direction, axis) * distance * distance / 5, 1e-6));
    }
}

// ---- environment images -----------------------------------------------------------------------

struct Image {
    const char* name;
    int width, height;
    std::function<double(int x, int y)> value;
};

const std::vector<Image> images{
    {"constant", 16, 8, [](int, int) { return 3.0; }},
    {"gradient", 16, 8, [](int x, int y) { return 1.0 + std::abs(x - 8) + 2 * y; }},
    {"noise", 32, 16, [](int x, int y) { return RandomStream(hashOf(1, x, y)).uniform(); }},
    {"one hot pixel", 16, 8, [](int x, int y) { return x == 5 && y == 3 ? 100.0 : 0.0; }},
    {"pole rows", 16, 8, [](int x, int y) { return y == 0 || y == 7 ? 1.0 + x % 3 : 0.0; }},
    {"pixel at the seam", 16, 8, [](int x, int y) { return x == 0 && y == 5 ? 9.0 : 0.0; }},
    {"black rows", 12, 9, [](int x, int y) { return y < 3 || y == 6 ? 0.0 : 1.0 + x; }},
    {"a single pixel", 1, 1, [](int, int) { return 2.0; }},
    {"range 1e6", 16, 8, [](int x, int y) { return x == 7 && y > 2 && y < 5 ? 1e3 : 1e-3; }},
};

/// The direction of image position (u, v) in [0,1]^2: u from the left, v from the top.
Vec3d towards(double u, double v) {
    const double phi = 2 * pi * (u - 0.5), theta = pi * v;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

/// Image positions, `sub` x `sub` to a pixel, with their solid angles.
void forEachPatch(const Image& image, int sub,
                  const std::function<void(double u, double v, double solidAngle)>& visit) {
    const int columns = image.width * sub, rows = image.height * sub;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            visit((x + 0.5) / columns, (y + 0.5) / rows,
                  2 * pi / columns * (std::cos(pi * y / rows) - std::cos(pi * (y + 1) / rows)));
}

void environments(Lab& lab) {
    const int n = lab.pick(100000, 2000000);
    const Affine3d turned = Affine3d::rotate(1, 40) * Affine3d::rotate(0, 70);
    const Affine3d back = turned.inverse();
    for (const Image& image : images) {
        std::vector<float> pixels;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                pixels.insert(pixels.end(), 3, static_cast<float>(image.value(x, y)));
        const light::Environment light({image.width, image.height, pixels}, Rgb(2.0f), turned,
                                       true);
        const std::string name = fmt::format("environment, {}", image.name);

        std::vector<double> shares;
        double total = 0;
        forEachPatch(image, 2, [&](double u, double v, double solidAngle) {
            shares.push_back(light.pdf({}, turned.vector(towards(u, v))) * solidAngle);
            total += shares.back();
        });
        // On both sides of the image's horizon, where the kink lies between rows.
        const auto irradiance = [&](int sub) {
            double sum = 0;
            forEachPatch(image, sub, [&](double u, double v, double solidAngle) {
                const Vec3d d = towards(u, v);
                sum += solidAngle * std::abs(d.y) * light.radiance(turned.vector(d))[0];
            });
            return sum;
        };
        const double exact = irradiance(32);

        RandomStream random(lab.seed(name));
        Cells cells(2 * image.height, 2 * image.width, shares);
        Moments arriving;
        double worst = 0;
        for (int i = 0; i < n; ++i) {
            const light::LightSample s = light.sample({}, random.uniform(), random.uniform());
            const Vec3d d = back.vector(s.direction);
            const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / pi;
            const double u = 0.5 + std::atan2(d.x, -d.z) / (2 * pi);
            cells.add(v, u);
            arriving.add(s.weight[0] * std::abs(d.y) / exact);
            // Between two pixels, rounding decides.
            const auto clear = [](double at) { return std::abs(at - std::round(at)) > 1e-6; };
            if (clear(u * image.width) && clear(v * image.height))
                worst = std::max(worst, std::abs(light.pdf({}, s.direction) / s.pdf - 1));
        }
        lab.add(exactCase("integral of the density, " + name, 1, total, 1e-12));
        lab.add(cells.asCase("directions, " + name));
        lab.add(exactCase("largest difference of sampled and evaluated density, " + name, 0, worst,
                          1e-9));
        Case mean = meanCase("irradiance over that by quadrature, " + name, 1, arriving,
                             lab.pick(1e-2, 2e-3));
        mean.allowance += std::abs(irradiance(16) / exact - 1);
        mean.note = "the quadrature's change as its steps are halved is allowed for";
        lab.add(mean);
    }
}

}  // namespace

std::vector<Check> lightSampling() {
    return {{Kind::Sampling, "sun", sun},
            {Kind::Sampling, "local lights", localLights},
            {Kind::Sampling, "environment images", environments}};
}

}  // namespace woodcock::proof
