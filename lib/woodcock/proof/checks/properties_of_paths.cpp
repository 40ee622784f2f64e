// SPDX-License-Identifier: Apache-2.0
// Free flights and phase functions together: lengths and counts that do not depend on the volume,
// or that are known for an infinite medium.
#include <fmt/format.h>

#include "woodcock/grid/vdb/load_field.h"
#include "woodcock/medium/phase.h"
#include "woodcock/medium/tracking.h"
#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/properties.h"
#include "woodcock/proof/checks/volume.h"
#include "woodcock/proof/oracles/closed_forms.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::proof {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The mean of `sample(stream)`, with as many samples as its precision takes.
Estimate meanOf(const Lab& lab, const std::string& name, double expected,
                const Precision& precision, const std::function<double(RandomStream&)>& sample) {
    const auto moments = [&](std::uint64_t stage, int count) {
        Moments m;
        for (int i = 0; i < count; ++i) {
            RandomStream random(hashOf(lab.seed(name), stage, i));
            m.add(sample(random));
        }
        return m;
    };
    constexpr int pilot = 2000, most = 1 << 24;
    const double ratio = 1.4 * moments(0, pilot).standardError() / precision.of(expected);
    const double count = std::clamp(pilot * ratio * ratio, double{pilot}, double{most});
    return Estimate(moments(1, static_cast<int>(count)));
}

/// Goes to the next scattering before tMax: false when there is none.
bool fly(const medium::Medium& medium, Vec3d& origin, Vec3d direction, double tMax, double& t,
         Spectrum<1>& throughput, RandomStream& random, float roulette = 0) {
    const double u = random.uniformOpenLow();
    medium::DistanceQuery<1> q{.origin = origin,
                               .direction = direction,
                               .tMax = tMax,
                               .u = u,
                               .random = random,
                               .roulette = roulette,
                               .throughput = throughput};
    medium::TrackingCounters counters;
    medium::trackDistance<1>(medium, {&q, 1}, counters);
    random = q.random, throughput = q.throughput, t = q.t;
    if (q.part < 0) return false;
    origin += direction * q.t;
    return true;
}

Vec3d turn(Vec3d direction, double g, RandomStream& random) {
    const double u0 = random.uniform(), u1 = random.uniform();
    return medium::sampleHenyeyGreenstein(direction, g, u0, u1).direction;
}

// ---- path length ----------------------------------------------------------------------------

/// The image of a box, which diffuse light enters.
class Parallelepiped {
public:
    Parallelepiped(const Affine3d& worldFromIndex, const Box3d& box)
        : worldFromUnit_(worldFromIndex * Affine3d::translate(box.lower) *
                         Affine3d::scale(box.size())),
          unitFromWorld_(worldFromUnit_.inverse()) {
        for (int i = 0; i < 3; ++i) area_[i] = length(across(i));
    }

    double meanChord() const {
        return oracle::meanChord(std::abs(worldFromUnit_.determinant()),
                                 2 * (area_.x + area_.y + area_.z));
    }

    /// A uniform point of its surface, and a direction inwards by the cosine law.
    std::pair<Vec3d, Vec3d> enter(RandomStream& random) const {
        double rest = random.uniform() * (area_.x + area_.y + area_.z);
        int axis = 0;
        while (axis < 2 && rest >= area_[axis]) rest -= area_[axis++];
        const double side = random.bits() & 1 ? 1 : 0;
        Vec3d unit{random.uniform(), random.uniform(), random.uniform()};
        unit[axis] = side;
        Vec3d inwards = normalize(across(axis));
        if ((dot(inwards, worldFromUnit_.column[static_cast<std::size_t>(axis)]) > 0) == (side > 0))
            inwards = -inwards;
        Vec3d s, t;
        orthonormalBasis(inwards, s, t);
        const double square = random.uniform(), phi = 2 * pi * random.uniform();
        return {worldFromUnit_.point(unit),
                normalize((s * std::cos(phi) + t * std::sin(phi)) * std::sqrt(square) +
                          inwards * std::sqrt(1 - square))};
    }

    double distanceToExit(Vec3d origin, Vec3d direction) const {
        const Vec3d o = unitFromWorld_.point(origin), d = unitFromWorld_.vector(direction);
        double t = infinity;
        for (int i = 0; i < 3; ++i)
            if (d[i] != 0) t = std::min(t, ((d[i] > 0 ? 1 : 0) - o[i]) / d[i]);
        return std::max(0.0, t);
    }

private:
    Vec3d across(int axis) const {
        const auto column = [&](int i) {
            return worldFromUnit_.column[static_cast<std::size_t>(i % 3)];
        };
        return cross(column(axis + 1), column(axis + 2));
    }

    Affine3d worldFromUnit_, unitFromWorld_;
    Vec3d area_;
};

/// The mean path of diffuse light through a convex body that does not absorb is as long as if it
/// were empty: 4V/S, whatever scatters inside (Blanco and Fournier 2003).
void pathLength(Lab& lab) {
    const Precision precision{lab.pick(1e-2, 2e-3), 0};
    for (const Volume& v : volumes(lab, Endless::Too)) {
        const Parallelepiped body(v.voxels.worldFromIndex, v.field->support());
        for (const double g : {0.0, -0.5, 0.9}) {
            const medium::Medium medium{{v.part(Rgb(0.0f), Rgb(1.0f), g)}};
            const std::string name = fmt::format("mean path length, g {}, {}", g, v.name);
            const auto path = [&](RandomStream& random) {
                auto [origin, direction] = body.enter(random);
                double sum = 0, t = 0;
                Spectrum<1> throughput(1.0f);
                while (fly(medium, origin, direction, body.distanceToExit(origin, direction), t,
                           throughput, random)) {
                    sum += t;
                    direction = turn(direction, g, random);
                }
                return (sum + t) * throughput[0];
            };
            const double expected = body.meanChord();
            Case c =
                caseOf(name, expected, meanOf(lab, name, expected, precision, path), precision);
            c.note = "4V/S of the box around it";
            lab.add(std::move(c));
        }
    }
}

// ---- infinite media -------------------------------------------------------------------------

struct InfiniteMedium {
    std::string name;
    medium::Medium medium;  // sigma_t is 1
};

/// Made in three ways; two of them are finite, but 1e6 mean free paths wide.
std::vector<InfiniteMedium> infiniteMedia(const Lab& lab) {
    const auto medium = [](medium::MediumPart::Description d) {
        d.absorption = Rgb(0.0f), d.scattering = Rgb(1.0f);
        return medium::Medium{{medium::MediumPart(std::move(d))}};
    };
    const auto field = [&](const char* file, GridSpec grid) {
        writeVdb(lab.file(file), {std::move(grid)});
        return std::make_shared<const grid::Field>(grid::loadGrid(lab.file(file), "density").field);
    };
    GridSpec fog, tile;
    fog.background = {1};
    fog.voxels = {{{0, 0, 0}, {1}}};
    tile.tiles = {{{0, 0, 0}, 4096, {1}}};
    medium::MediumPart::Description box, endless, wide;
    box.box = {{-5e5, -5e5, -5e5}, {5e5, 5e5, 5e5}};
    endless.field = field("fog.vdb", fog);
    wide.field = field("tile.vdb", tile);
    wide.worldFromIndex =
        Affine3d::scale({244, 244, 244}) * Affine3d::translate({-2048.3, -2048.2, -2048.1});
    wide.majorantScale = 2;
    return {{"a box", medium(box)},
            {"a background without end", medium(endless)},
            {"a tile under twice its majorant", medium(wide)}};
}

/// Mean square of the distance to the n-th collision.
void distances(Lab& lab) {
    const std::vector<InfiniteMedium> media = infiniteMedia(lab);
    const Precision precision{lab.pick(1e-2, 3e-3), 0};
    for (const InfiniteMedium& m : media)
        for (const double g : {0.0, 0.5, -0.5, 0.9, 0.99})
            for (const int n : lab.full() ? std::vector{1, 2, 10, 30} : std::vector{2, 10}) {
                const std::string name = fmt::format("R^2 at collision {}, g {}, {}", n, g, m.name);
                const auto walk = [&](RandomStream& random) {
                    Vec3d position, direction = anyDirection(random);
                    Spectrum<1> throughput(1.0f);
                    double t = 0;
                    for (int i = 0; i < n; ++i) {
                        if (i > 0) direction = turn(direction, g, random);
                        if (!fly(m.medium, position, direction, infinity, t, throughput, random))
                            return std::nan("");
                    }
                    return dot(position, position);
                };
                const double expected = oracle::meanSquareDistance(n, g);
                Case c =
                    caseOf(name, expected, meanOf(lab, name, expected, precision, walk), precision);
                c.curve = fmt::format("R^2 at g {}, {}", g, m.name);
                c.xName = "collisions", c.x = n;
                lab.add(std::move(c));
            }
}

/// Absorption is a weight on which Russian roulette acts, and the sum of a path's weights counts
/// its collisions. That holds where voxels differ but the albedo does not, as in any infinite
/// medium.
void collisions(Lab& lab) {
    std::vector<InfiniteMedium> media = infiniteMedia(lab);
    for (const Volume& v : volumes(lab, Endless::Too))
        if (v.endless()) media.push_back({v.name, {{v.part(Rgb(0.0f), Rgb(1.0f), 0)}}});
    const Precision precision{lab.pick(1e-2, 2e-3), 0};
    for (const InfiniteMedium& m : media)
        for (const float albedo : {0.2f, 0.9f, 0.99f}) {
            medium::MediumPart::Description d = m.medium.parts[0].description();
            d.absorption = d.scattering * (1 - albedo), d.scattering *= albedo;
            const medium::Medium medium{{medium::MediumPart(d)}};
            const std::string name = fmt::format("collisions, albedo {}, {}", albedo, m.name);
            const auto count = [&](RandomStream& random) {
                Vec3d position, direction = anyDirection(random);
                Spectrum<1> throughput(1.0f);
                double sum = 1, t = 0;
                while (fly(medium, position, direction, infinity, t, throughput, random, 0.1f)) {
                    sum += throughput[0];
                    direction = anyDirection(random);
                }
                return sum;
            };
            const double expected = oracle::meanCollisionCount(
                double{d.scattering[0]} / (double{d.scattering[0]} + d.absorption[0]));
            Case c =
                caseOf(name, expected, meanOf(lab, name, expected, precision, count), precision);
            c.note = "1 / (1 - albedo)";
            lab.add(std::move(c));
        }
}

}  // namespace

std::vector<Check> propertiesOfPaths() {
    return {{Kind::Property, "path length of any volume", pathLength},
            {Kind::Property, "distances in infinite media", distances},
            {Kind::Property, "collisions in infinite media", collisions}};
}

}  // namespace woodcock::proof
