// SPDX-License-Identifier: Apache-2.0
// Rectangles and disks: what they are sampled by, and the irradiance that they give.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/random.h"
#include "woodcock/light/light.h"
#include "woodcock/proof/checks/cells.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::proof {

namespace {

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

void addFlatLights(Lab& lab, bool disk) {
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
void rectangles(Lab& lab) { addFlatLights(lab, false); }
void disks(Lab& lab) { addFlatLights(lab, true); }

}  // namespace

std::vector<Check> flatLights() {
    return {{Kind::Sampling, "rectangles", rectangles}, {Kind::Sampling, "disks", disks}};
}

}  // namespace woodcock::proof
