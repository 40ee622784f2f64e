// SPDX-License-Identifier: Apache-2.0
// Spots, rectangles, disks and photometric profiles: what they are sampled by, the irradiance that
// they give, and the fog that they light.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/random.h"
#include "woodcock/light/light.h"
#include "woodcock/proof/checks/cells.h"
#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/oracles/closed_forms.h"
#include "woodcock/proof/support/sky.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::proof {

namespace {

// ---- flat lights ------------------------------------------------------------------------------

/// A light that lies askew: centre, axes, half sizes 1.5 and 0.5, or a disk of radius 1.
light::FlatLight askew(bool disk, double spreadDegrees) {
    light::FlatLight flat{};
    flat.centre = {5, -3, 2}, flat.halfX = 1.5, flat.halfY = 0.5, flat.radiance = Rgb(2);
    if (disk) flat.halfX = flat.halfY = 1;
    flat.normal = normalize(Vec3d{0.3, 0.8, -0.4});
    orthonormalBasis(flat.normal, flat.x, flat.y);
    flat.spread = light::Spread(spreadDegrees);
    return flat;
}

light::Light lightOf(const light::FlatLight& flat, bool disk) {
    if (disk) return light::DiskLight{flat};
    return light::RectangleLight{flat};
}

/// Irradiance over pi radiance of a plane parallel to a rectangle, under its corner, in distances.
double cornerFormFactor(double a, double b) {
    const double x = std::sqrt(1 + a * a), y = std::sqrt(1 + b * b);
    return (a / x * std::atan(b / x) + b / y * std::atan(a / y)) / (2 * pi);
}

/// Irradiance at (x, y) at `height` before the light, of a plane that faces it; radiance 1.
double irradianceOf(bool disk, const light::FlatLight& flat, double x, double y, double height) {
    if (disk) {
        const double r2 = flat.halfX * flat.halfX, a2 = x * x + y * y, h2 = height * height;
        const double sum = h2 + a2 + r2;
        // 1 - q / sqrt(q^2 + rest), without the cancellation from afar
        const double q = h2 + a2 - r2, root = std::sqrt(sum * sum - 4 * a2 * r2);
        return pi / 2 * (q > 0 ? 4 * h2 * r2 / (root * (root + q)) : 1 - q / root);
    }
    const double far2 = x * x + y * y + height * height;
    if (far2 > 1e10)  // where the sum below has no digits left, the rectangle is a point
        return 4 * flat.halfX * flat.halfY * height * height / (far2 * far2);
    const auto corner = [&](double sx, double sy) {
        const double a = (sx * flat.halfX - x) / height, b = (sy * flat.halfY - y) / height;
        return std::copysign(1, a) * std::copysign(1, b) *
               cornerFormFactor(std::abs(a), std::abs(b));
    };
    return pi * (corner(1, 1) - corner(-1, 1) - corner(1, -1) + corner(-1, -1));
}

struct Seat {
    const char* name;
    double x, y, height;
};
const std::vector<Seat> seats{
    {"before its middle", 0, 0, 1},      {"close to its middle", 0.1, 0, 1e-3},
    {"beside it", 2.5, 1, 0.5},          {"almost in its plane", 2.5, 0, 1e-3},
    {"close to its edge", 1, 0.5, 0.02}, {"far away", 30, -40, 20},
    {"very far away", 1e6, 2e6, 1e6}};

Vec3d positionOf(const light::FlatLight& f, const Seat& s) {
    return f.centre + f.x * s.x + f.y * s.y + f.normal * s.height;
}

/// Shares of a disk's or a rectangle's cells, by the density that the light states.
std::vector<double> sharesOf(const light::Light& light, const light::FlatLight& flat, bool disk,
                             Vec3d from, double height, int side) {
    constexpr int fine = 12;
    std::vector<double> shares;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            double sum = 0;
            for (int i = 0; i < fine * fine; ++i) {
                const double u = (row + (i / fine + 0.5) / fine) / side;
                const double v = (column + (i % fine + 0.5) / fine) / side;
                const double r = std::sqrt(u), phi = 2 * pi * v;
                const double x = flat.halfX * (disk ? r * std::cos(phi) : 2 * u - 1);
                const double y = flat.halfY * (disk ? r * std::sin(phi) : 2 * v - 1);
                const Vec3d d = flat.centre + flat.x * x + flat.y * y - from;
                const double distance = length(d);
                const double area = (disk ? pi : 4) * flat.halfX * flat.halfY;
                sum += light.pdf(from, d / distance) * area * height /
                       (distance * distance * distance);
            }
            shares.push_back(sum / (fine * fine * side * side));
        }
    return shares;
}

void addFlatLight(Lab& lab, bool disk, double spread, const Seat& seat) {
    constexpr int side = 8;
    const light::FlatLight flat = askew(disk, spread);
    const light::Light light = lightOf(flat, disk);
    const Vec3d from = positionOf(flat, seat);
    const std::string name =
        fmt::format("{} of spread {}, {}", disk ? "disk" : "rectangle", spread, seat.name);
    const bool even = spread == 180;
    // The sum over cells needs a density that is smooth in each.
    const bool counted = even && seat.height >= 0.5;
    std::vector<double> shares(side * side, 0);
    if (counted) shares = sharesOf(light, flat, disk, from, seat.height, side);
    double found = 0;
    for (const double share : shares) found += share;
    for (double& share : shares) share /= counted ? found : 1;

    RandomStream random(lab.seed(name));
    Cells cells(side, side, shares);
    Moments facing, fallen;
    double worst = 0, worstRadiance = 0;
    const int n = lab.pick(40000, 1000000);
    for (int i = 0; i < n; ++i) {
        const double u = random.uniform();
        const light::LightSample s = light.sample(from, u, random.uniform());
        fallen.add(s.pdf > 0);
        facing.add(s.weight[0] * -dot(s.direction, flat.normal) / 2);
        if (!(s.pdf > 0)) continue;
        const Vec3d p = from + s.direction * s.distance - flat.centre;
        const double x = dot(p, flat.x) / flat.halfX, y = dot(p, flat.y) / flat.halfY;
        const double turned = std::atan2(y, x) / (2 * pi);
        if (disk)
            cells.add(x * x + y * y, turned < 0 ? turned + 1 : turned);
        else
            cells.add((x + 1) / 2, (y + 1) / 2);
        const double edge = disk ? std::hypot(x, y) : std::max(std::abs(x), std::abs(y));
        // The rim itself is in or out by rounding, and so is the edge of the spread.
        const double brightness = flat.spread.factor(-dot(s.direction, flat.normal));
        if (edge > 1 - 1e-6 * std::max(1.0, s.distance) || brightness < 1e-6) continue;
        worst = std::max(worst, std::abs(light.pdf(from, s.direction) / s.pdf - 1));
        const light::LightHit hit = light.meet(from, s.direction);
        worstRadiance =
            std::max({worstRadiance, std::abs(s.weight[0] * s.pdf / hit.radiance[0] - 1),
                      std::abs(hit.distance / s.distance - 1)});
    }
    lab.add(
        exactCase("largest difference of sampled and evaluated density, " + name, 0, worst, 1e-7));
    lab.add(exactCase(
        "largest difference of weight x density and the radiance that a ray meets, " + name, 0,
        worstRadiance, 1e-6, "weights are floats"));
    if (counted) {
        lab.add(cells.asCase("points, " + name));
        Case hits = meanCase("directions that hit over the integral of the density, " + name, 1,
                             Moments(), lab.pick(2e-2, 4e-3));
        hits.measured = fallen.mean() / found;
        hits.standardError = fallen.standardError() / found;
        hits.allowance = 2e-3;
        hits.note = "the integral is a sum over 9216 points";
        lab.add(hits);
    }
    if (even) {
        const double exact = irradianceOf(disk, flat, seat.x, seat.y, seat.height);
        Moments relative = facing;
        Case c = meanCase("irradiance over its form factor, " + name, 1, Moments(),
                          lab.pick(3e-2, 5e-3));
        c.measured = relative.mean() / exact;
        c.standardError = relative.standardError() / exact;
        c.allowance = seat.height > 1e5 ? 1e-5 : 2e-6;
        lab.add(c);
    }
}

/// Radiance by quadrature where the spread lets only a part of the light through.
void addSpreadIrradiance(Lab& lab, bool disk, double spread, const Seat& seat) {
    const light::FlatLight flat = askew(disk, spread);
    const light::Light light = lightOf(flat, disk);
    const Vec3d from = positionOf(flat, seat);
    const std::string name =
        fmt::format("{} of spread {}, {}", disk ? "disk" : "rectangle", spread, seat.name);
    const double a = spread * pi / 360, tangent = std::tan(a);
    // Over the circle that the slats leave, around the foot of the receiver.
    double exact = 0;
    const double reach = seat.height * tangent;
    constexpr int rings = 400, turns = 800;
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < turns; ++j) {
            const double r = reach * (i + 0.5) / rings, phi = 2 * pi * (j + 0.5) / turns;
            const double x = seat.x + r * std::cos(phi), y = seat.y + r * std::sin(phi);
            const bool inside =
                disk ? x * x + y * y <= 1 : std::abs(x) <= flat.halfX && std::abs(y) <= flat.halfY;
            if (!inside) continue;
            const double d2 = r * r + seat.height * seat.height;
            exact += r * (tangent - r / seat.height) / (tangent - a) * seat.height * seat.height /
                     (d2 * d2);
        }
    exact *= reach / rings * 2 * pi / turns;
    RandomStream random(lab.seed(name));
    Moments facing;
    for (int i = 0; i < lab.pick(40000, 1000000); ++i) {
        const double u = random.uniform();
        const light::LightSample s = light.sample(from, u, random.uniform());
        facing.add(s.weight[0] * -dot(s.direction, flat.normal) / 2 / exact);
    }
    Case c =
        meanCase("irradiance over that by quadrature, " + name, 1, facing, lab.pick(3e-2, 5e-3));
    c.allowance = 3e-3;
    c.note = "quadrature to 3e-3, as the light's edge cuts its cells";
    lab.add(c);
}

void flatLights(Lab& lab, bool disk) {
    for (const double spread : {180.0, 100.0, 20.0})
        for (const Seat& seat : seats) addFlatLight(lab, disk, spread, seat);
    for (const double spread : {150.0, 100.0, 40.0})
        for (const Seat& seat : {Seat{"before its middle", 0, 0, 1}, Seat{"beside it", 1, 0.3, 0.7},
                                 Seat{"before its edge", 0.9, 0.4, 0.3}})
            addSpreadIrradiance(lab, disk, spread, seat);
    for (const double spread : {180.0, 179.0, 90.0, 4.0, 3.3, 0.01}) {
        const light::Spread s(spread);
        const double half = spread * pi / 360;
        const double power =
            2 * pi * integrate(0, half, 64, [&](double angle) {
                return s.factor(std::cos(angle)) * std::cos(angle) * std::sin(angle);
            });
        lab.add(exactCase(fmt::format("power over pi radiance and area, spread {}", spread), 1,
                          power / pi, spread < 1 ? 1e-7 : 1e-9));
    }
}
void rectangles(Lab& lab) { flatLights(lab, false); }
void disks(Lab& lab) { flatLights(lab, true); }

// ---- spots ------------------------------------------------------------------------------------

const Vec3d axis = normalize(Vec3d{0.3, 0.8, -0.4});

void spots(Lab& lab) {
    const Vec3d position{1, 2, 3};
    for (const double cone : {180.0, 90.0, 30.0, 1.0, 1e-3})
        for (const double blend : {0.0, 0.15, 1.0}) {
            const light::SpotLight light(position, axis * 3.0, Rgb(5.0f), cone, blend);
            const std::string name = fmt::format("spot of {} degrees, blend {}", cone, blend);
            const double half = 2 * std::pow(std::sin(cone * pi / 720), 2);  // 1 - cos
            const auto intensity = [&](double below, double turned, double distance) {
                const Vec3d from = position + around(axis, below, turned) * distance;
                return light.sample(from, 0.3, 0.7).weight[0] * distance * distance;
            };
            double worst = 0;
            for (int i = 0; i < 1000; ++i) {
                const double below = std::min(2.0, half * 1.5) * (i + 0.5) / 1000;
                const double x = blend > 0 ? std::clamp((half - below) / (half * blend), 0.0, 1.0)
                                           : double(below < half);
                const double expected = 5 * (3 * x * x - 2 * x * x * x);
                worst = std::max(worst, std::abs(intensity(below, 2.4 * i, 0.1 + i) - expected));
            }
            lab.add(exactCase("largest difference of intensity and smoothstep, " + name, 0, worst,
                              cone < 0.1 ? 1e-4 : 2e-6, "positions are rounded"));
            // The cone's integral, in two pieces: smoothstep between 0 and 1 has the mean 1/2.
            const double edge = half * (1 - blend);
            const double power =
                2 * pi *
                (integrate(0, edge, 32, [&](double b) { return intensity(b, 1, 2); }) +
                 integrate(edge, half, 32, [&](double b) { return intensity(b, 1, 2); }));
            lab.add(exactCase("power over its closed form, " + name, 1,
                              power / (5 * 2 * pi * half * (1 - blend / 2)),
                              cone < 0.1 ? 1e-4 : 2e-6, "positions are rounded"));
        }
}

// ---- photometric profiles ---------------------------------------------------------------------

struct Luminaire {
    const char* name;
    std::vector<double> vertical, horizontal;
};
const std::vector<Luminaire> luminaires{
    {"all around", {0, 30, 60, 90, 135, 180}, {0}},
    {"of four quadrants", {0, 20, 45, 90}, {0, 30, 45, 90}},
    {"of two halves", {0, 10, 45, 90, 180}, {0, 45, 90, 135, 180}},
    {"of two other halves", {0, 45, 90, 180}, {90, 150, 180, 270}},
    {"of two halves without a plane between", {0, 45, 90, 180}, {90, 150, 270}},
    {"without symmetry", {90, 120, 150, 180}, {0, 60, 90, 180, 270, 360}},
    {"that leaves out 360", {0, 45, 90}, {0, 90, 180, 270}}};

double candelaOf(std::size_t h, std::size_t v, std::size_t horizontals) {
    const std::size_t plane = horizontals == 6 && h == 5 ? 0 : h;  // 360 is 0
    return 100 + 70 * std::cos(3.0 * static_cast<double>(v) + 1.7 * static_cast<double>(plane));
}

std::string textOf(const Luminaire& l) {
    std::string text = "IESNA:LM-63-2002\r\n[TEST] made up\r\nTILT=NONE\r\n";
    text += fmt::format("1 1000 2 {} {} 1 2 0 0 0\r\n0.5 1.5 100\r\n", l.vertical.size(),
                        l.horizontal.size());
    for (double v : l.vertical) text += fmt::format("{} ", v);
    text += "\r\n";
    for (double h : l.horizontal) text += fmt::format("{},", h);
    for (std::size_t h = 0; h < l.horizontal.size(); ++h) {
        text += "\r\n";
        for (std::size_t v = 0; v < l.vertical.size(); ++v)
            text += fmt::format("{:.17g}\r\n", candelaOf(h, v, l.horizontal.size()));
    }
    return text;
}

/// The file's candela, as its symmetry says, linear between angles; `h` in [0, 360).
double candelaTowards(const Luminaire& l, double v, double h) {
    const double last = l.horizontal.back();
    if (l.horizontal.size() == 1)
        h = 0;
    else if (last == 90)
        h = h > 180 ? 360 - h : h, h = h > 90 ? 180 - h : h;
    else if (last == 180)
        h = h > 180 ? 360 - h : h;
    else if (l.horizontal.front() == 90)
        h = h < 90 ? 180 - h : h > 270 ? 540 - h : h;
    std::size_t i = 0, j = 0;
    while (i + 2 < l.horizontal.size() && h > l.horizontal[i + 1]) ++i;
    while (j + 2 < l.vertical.size() && v > l.vertical[j + 1]) ++j;
    if (v < l.vertical.front() || v > l.vertical.back()) return 0;
    std::size_t next = i + 1;
    double width = l.horizontal.size() > 1 ? l.horizontal[next] - l.horizontal[i] : 1;
    if (l.horizontal.size() == 1) next = 0;
    if (last == 270 && l.horizontal.front() == 0 && h > 270) i = 3, next = 0, width = 90;
    const double fh = (h - l.horizontal[i]) / width;
    const double fv = (v - l.vertical[j]) / (l.vertical[j + 1] - l.vertical[j]);
    const auto at = [&](std::size_t a, std::size_t b) {
        return candelaOf(a, b, l.horizontal.size());
    };
    return (at(i, j) * (1 - fv) + at(i, j + 1) * fv) * (1 - fh) +
           (at(next, j) * (1 - fv) + at(next, j + 1) * fv) * fh;
}

void profiles(Lab& lab) {
    const Affine3d worldFromLight =
        Affine3d::rotate(0, 30) * Affine3d::rotate(1, 40) * Affine3d::rotate(2, 50);
    for (const Luminaire& l : luminaires) {
        const auto profile = std::make_shared<const light::IesProfile>(
            light::IesProfile::read(textOf(l), "made.ies"));
        const light::PointLight light{
            {1, 2, 3}, Rgb(static_cast<float>(1 / (4 * pi))), profile, worldFromLight.inverse()};
        double worst = 0, sum = 0, solidAngle = 0;
        constexpr int rows = 360, columns = 720;
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < columns; ++j) {
                const double v = 180 * (i + 0.5) / rows, h = 360 * (j + 0.5) / columns;
                const double sine = std::sin(v * pi / 180), turned = h * pi / 180;
                // 0 is -z and -y, 90 of the horizontal angles -x
                const Vec3d local{-sine * std::sin(turned), -sine * std::cos(turned),
                                  -std::cos(v * pi / 180)};
                const Vec3d from = light.position + worldFromLight.vector(local) * 2.0;
                const double watts = light.sample(from, 0, 0).weight[0] * 4;
                const double candela = 1.5 * candelaTowards(l, v, h);  // multiplier x ballasts
                worst = std::max(worst, std::abs(watts * 177.83 / candela - 1) * (candela > 0));
                worst = std::max(worst, watts * (candela == 0));
                sum += watts * sine, solidAngle += sine;
            }
        lab.add(
            exactCase(fmt::format("largest difference of intensity and file, luminaire {}", l.name),
                      0, worst, 1e-5, "floats"));
        lab.add(exactCase(fmt::format("mean over that by quadrature, luminaire {}", l.name), 1,
                          profile->mean() / (4 * pi) / (sum / solidAngle), 1e-3,
                          "quadrature in steps of half a degree"));
    }
}

// ---- fog --------------------------------------------------------------------------------------

constexpr double sigmaA = 0.3, sigmaS = 0.7, sigmaT = sigmaA + sigmaS, half = 2;

/// Scattered once, in a box of fog of half width 2, into a view along -z: by quadrature along the
/// view and over what `shine` hands out, which are directions towards the light, distances within
/// the box, and radiance times solid angle.
double scatteredOnce(
    double g,
    const std::function<void(Vec3d at, const std::function<void(Vec3d direction, double distance,
                                                                double light)>& visit)>& shine,
    int steps) {
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double z = half * (2 * (i + 0.5) / steps - 1);
        shine({0, 0, z}, [&](Vec3d direction, double distance, double light) {
            sum += 2 * half / steps * sigmaS * oracle::henyeyGreenstein(-direction.z, g) * light *
                   std::exp(-sigmaT * (half - z + distance));
        });
    }
    return sum;
}

void inFog(Lab& lab) {
    const Precision precision = lab.full() ? Precision{2e-3, 4e-6} : Precision{1e-2, 0};
    for (const double g : {0.0, 0.8, -0.5}) {
        render::Scene scene =
            sceneIn(lab, fmt::format("[[volume]]\nbox = {{ min = [-2, -2, -2], max = [2, 2, 2] }}\n"
                                     "sigma_a = {}\nsigma_s = {}\ng = {}\n",
                                     sigmaA, sigmaS, g) +
                             pencilCamera({0, 0, 10}, {0, 0, -1}));
        const auto add = [&](const std::string& name, const light::Light& light, double expected) {
            scene.lights = light::LightSet({light});
            Case c = caseOf(name, expected, evenPicture(lab, name, scene, precision, {0}, 1)[0],
                            precision);
            c.allowance += 1e-3 * c.expected;
            c.note = "quadrature to 1e-3";
            lab.add(c);
        };

        const Vec3d lamp{1.2, 0.3, 0.9}, aim = normalize(Vec3d{-1, -0.2, -0.6});
        for (const double blend : {0.0, 0.5}) {
            const light::SpotLight spot(lamp, aim, Rgb(4), 40, blend);
            const double exact = scatteredOnce(
                g,
                [&](Vec3d at, const auto& visit) {
                    const Vec3d d = lamp - at;
                    const double distance = length(d), cosHalf = std::cos(20 * pi / 180);
                    const double inside = dot(d, aim) / -distance - cosHalf;
                    const double x = blend > 0
                                         ? std::clamp(inside / (blend * (1 - cosHalf)), 0.0, 1.0)
                                         : double(inside > 0);
                    visit(d / distance, distance, 4 * x * x * (3 - 2 * x) / (distance * distance));
                },
                20000);
            add(fmt::format("spot in fog, blend {}, g {}", blend, g), spot, exact);
        }

        for (const bool disk : {false, true})
            for (const double spread : {180.0, 90.0}) {
                light::FlatLight flat{};
                flat.centre = {1.2, 0.3, 0.5}, flat.normal = aim, flat.radiance = Rgb(3);
                flat.halfX = 0.6, flat.halfY = disk ? 0.6 : 0.4, flat.visible = false;
                orthonormalBasis(flat.normal, flat.x, flat.y);
                flat.spread = light::Spread(spread);
                const double a = spread * pi / 360;
                constexpr int side = 40;
                const double exact = scatteredOnce(
                    g,
                    [&](Vec3d at, const auto& visit) {
                        for (int i = 0; i < side * side; ++i) {
                            const double u = (i / side + 0.5) / side, v = (i % side + 0.5) / side;
                            const double r = std::sqrt(u), phi = 2 * pi * v;
                            const double x = flat.halfX * (disk ? r * std::cos(phi) : 2 * u - 1);
                            const double y = flat.halfY * (disk ? r * std::sin(phi) : 2 * v - 1);
                            const Vec3d d = flat.centre + flat.x * x + flat.y * y - at;
                            const double distance = length(d), cosine = -dot(d, aim) / distance;
                            if (!(cosine > 0)) continue;
                            const double area = (disk ? pi : 4) * flat.halfX * flat.halfY;
                            const double tangent = std::sqrt(1 - cosine * cosine) / cosine;
                            const double factor =
                                spread == 180
                                    ? 1
                                    : std::max(0.0, std::tan(a) - tangent) / (std::tan(a) - a);
                            visit(
                                d / distance, distance,
                                3 * factor * cosine * area / (side * side) / (distance * distance));
                        }
                    },
                    400);
                add(fmt::format("{} in fog, spread {}, g {}", disk ? "disk" : "rectangle", spread,
                                g),
                    lightOf(flat, disk), exact);
            }
    }
}

}  // namespace

std::vector<Check> lamps() {
    return {{Kind::Sampling, "spots", spots},
            {Kind::Sampling, "rectangles", rectangles},
            {Kind::Sampling, "disks", disks},
            {Kind::Sampling, "photometric profiles", profiles},
            {Kind::ClosedForm, "lamps in fog", inFog}};
}

}  // namespace woodcock::proof
