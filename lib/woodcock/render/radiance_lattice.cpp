// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/radiance_lattice.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "woodcock/light/even_light.h"
#include "woodcock/medium/line_depths.h"
#include "woodcock/render/needs.h"

namespace woodcock::render {

namespace {

/// Cells along the longest side of the medium's box; one more lies around it on each side.
constexpr int mostCells = 32;
/// Rays along z through each cell, by which its mean density is found: a square of so many.
constexpr int raysAcross = 2;
/// How much a cell resists diffusion at least, as a multiple of one of transport depth 1/3. In
/// empty ones it stands for what radiance falls by in its last steps to the surface. Of 0.5, 1 and
/// 2, this measured best.
constexpr float emptyCell = 1;

/// Directions of discrete ordinates, of equal weights: the level-symmetric set of 24 that
/// integrates second moments exactly (Lathrop and Carlson 1965, "Discrete Ordinates Angular
/// Quadrature of the Neutron Transport Equation", LA-3186). A set of 48 measured alike.
std::vector<Vec3d> ordinates() {
    constexpr double low = 0.3500212, high = 0.8688903;
    std::vector<Vec3d> directions;
    for (int octant = 0; octant < 8; ++octant)
        for (int axis = 0; axis < 3; ++axis) {
            Vec3d d{low, low, low};
            d[axis] = high;
            for (int i = 0; i < 3; ++i)
                if (octant >> i & 1) d[i] = -d[i];
            directions.push_back(d);
        }
    return directions;
}

RadianceLattice::Light lightOf(const light::LightSet& lights) {
    RadianceLattice::Light light;
    int environment = -1;
    for (const int i : lights.distant()) {
        if (!light::isEven(lights, i)) continue;
        light.environment += light::meanRadiance(lights, i);
        if (environment < 0) environment = i;
    }
    const auto sun = std::ranges::find_if(
        lights.sampled(), [&](int i) { return lights.traits(i).parallel.has_value(); });
    if (sun == lights.sampled().end()) return light;
    if (environment >= 0 && lights.group(environment) != lights.group(*sun)) return light;
    light.sun = light::irradiance(lights, *sun);
    light.towardsSun = *lights.traits(*sun).parallel;
    return light;
}

}  // namespace

std::unique_ptr<const RadianceLattice> RadianceLattice::make(const Scene& scene) {
    const auto isOrdinary = [](const medium::MediumPart& part) {
        return part.field() && !part.unbounded() && !part.extinctionVaries() && !part.moved() &&
               !part.readElsewhere() && !part.support().empty();
    };
    const Needs needs = findNeeds(scene);
    if (needs.surfaces || needs.localLights || needs.motion || !needs.scattering ||
        medium::moves(scene.medium) || !std::ranges::all_of(scene.medium.parts, isOrdinary))
        return nullptr;
    return make(scene.medium, lightOf(scene.lights));
}

std::unique_ptr<const RadianceLattice> RadianceLattice::make(const medium::Medium& medium,
                                                             const Light& light) {
    Rgb scattering, absorption;
    float forward = 0;
    bool grey = true;
    for (const medium::MediumPart& part : medium.parts) {
        scattering += part.scattering(), absorption += part.absorption();
        forward += part.scattering().sum() * static_cast<float>(part.phase().meanCosine());
        grey &= isGrey(part.absorption()) && isGrey(part.scattering()) &&
                !(part.field() && part.field()->channels() > 1);
    }
    const Rgb mixed = light.environment + light.sun * static_cast<float>(1 / (4 * pi));
    const Box3d box = medium.worldBounds();
    const Vec3d size = box.size();
    const double edge = std::max({size.x, size.y, size.z}) / mostCells;
    if (!(scattering.maximum() > 0 && std::isnormal(mixed.mean()) && edge > 0) ||
        !std::isfinite(edge))
        return nullptr;
    if (grey && !(absorption.maximum() > 0 || light.sun.maximum() > 0)) return nullptr;
    std::unique_ptr<RadianceLattice> made(new RadianceLattice);
    RadianceLattice& lattice = *made;
    lattice.edge_ = edge;
    for (int i = 0; i < 3; ++i)
        lattice.cells_[i] =
            std::clamp(static_cast<int>(std::ceil(size[i] / edge)), 1, mostCells) + 2;
    lattice.origin_ = (box.lower + box.upper) * 0.5 - lattice.cells_.as<double>() * (edge / 2);
    lattice.latticeFromWorld_ =
        Affine3d::scale(Vec3d{1, 1, 1} * (1 / edge)) * Affine3d::translate(-lattice.origin_);
    lattice.content_.resize(static_cast<std::size_t>(lattice.cells_.x) *
                            static_cast<std::size_t>(lattice.cells_.y) *
                            static_cast<std::size_t>(lattice.cells_.z));
    lattice.towardsSun_ = light.towardsSun;
    lattice.meanCosine_ = std::clamp(forward / scattering.sum(), -0.99f, 0.99f);
    Light used = light;
    if (grey) {
        lattice.unit_ = mixed * (1 / mixed.mean());
        used.environment = Rgb(light.environment.mean()), used.sun = Rgb(light.sun.mean());
    }
    Rates rates[3];
    lattice.survey(medium, rates);
    for (int c = 0; c < 3; ++c) {
        const bool asBefore = c > 0 && rates[c].absorption == rates[c - 1].absorption &&
                              rates[c].scattering == rates[c - 1].scattering &&
                              rates[c].transport == rates[c - 1].transport &&
                              used.environment[c] == used.environment[c - 1] &&
                              used.sun[c] == used.sun[c - 1];
        if (asBefore)
            for (Cell& cell : lattice.content_) cell.channels[c] = cell.channels[c - 1];
        else
            lattice.solve(rates[c], used, c);
    }
    return made;
}

void RadianceLattice::survey(const medium::Medium& medium, Rates rates[3]) const {
    for (int c = 0; c < 3; ++c) {
        for (std::vector<float>* rate :
             {&rates[c].absorption, &rates[c].scattering, &rates[c].transport})
            rate->assign(content_.size(), 0);
    }
    tbb::parallel_for(0, cells_.y, [&](int y) {
        for (const medium::MediumPart& part : medium.parts)
            for (int ray = 0; ray < raysAcross * raysAcross * cells_.x; ++ray)
                surveyRay(part, y, ray, rates);
    });
}

/// Adds what one of the rays through a row of cells, from low to high z, finds in them.
void RadianceLattice::surveyRay(const medium::MediumPart& part, int row, int ray,
                                Rates rates[3]) const {
    const int x = ray / raysAcross, y = row * raysAcross + ray % raysAcross;
    const Vec3d start = origin_ + Vec3d{x + 0.5, y + 0.5, 0} * (edge_ / raysAcross);
    const auto forward = static_cast<float>(part.phase().meanCosine());
    const int channels = part.field() && part.field()->channels() > 1 ? 3 : 1;
    medium::integrateSteps(
        part, part.indexRay(start, {0, 0, 1}), cells_.z, edge_, channels,
        [&](int z, int channel, double integral) {
            const std::size_t i = numberOf(x / raysAcross, row, z);
            const auto f = static_cast<float>(integral / (raysAcross * raysAcross));
            for (int c = 0; c < 3; ++c) {
                if (channels > 1 && c != channel) continue;
                const float absorption = part.absorption()[c], scattering = part.scattering()[c];
                rates[c].absorption[i] += absorption * f;
                rates[c].scattering[i] += scattering * f;
                rates[c].transport[i] += (absorption + (1 - forward) * scattering) * f;
            }
        });
}

/// Fills a channel.
void RadianceLattice::solve(const Rates& rates, const Light& light, int channel) {
    const float sun = light.sun[channel];
    std::vector<float> source(content_.size());
    if (sun > 0) {
        source = sunlight(rates.transport, light.towardsSun);
        for (std::size_t i = 0; i < source.size(); ++i)
            source[i] *=
                (rates.transport[i] - rates.absorption[i]) * sun * static_cast<float>(1 / (4 * pi));
        std::vector<float> extinction = rates.absorption;
        for (std::size_t i = 0; i < extinction.size(); ++i) extinction[i] += rates.scattering[i];
        const std::vector<float> passes = sunlight(extinction, light.towardsSun);
        for (std::size_t i = 0; i < passes.size(); ++i)
            content_[i].channels[channel].sun = passes[i] * sun;
    }
    sweep(rates, light, channel, diffuse(rates, light.environment[channel], source));
}

/// The transmittance of these rates from the middle of each cell to the sun, in steps of half a
/// cell.
std::vector<float> RadianceLattice::sunlight(const std::vector<float>& rates,
                                             Vec3d towardsSun) const {
    std::vector<float> passes(content_.size(), 1);
    const Vec3d step = towardsSun * 0.5;
    const Box3d inner{{1, 1, 1}, (cells_ - Vec3i{1, 1, 1}).as<double>()};
    tbb::parallel_for(1, cells_.z - 1, [&](int z) {
        for (int y = 1; y + 1 < cells_.y; ++y)
            for (int x = 1; x + 1 < cells_.x; ++x) {
                float depth = 0;
                Vec3d at = Vec3d{x + 0.5, y + 0.5, z + 0.5} + step * 0.5;
                for (; inner.contains(at); at += step) {
                    const Vec3i cell = floorToInt(at);
                    depth += rates[numberOf(cell.x, cell.y, cell.z)];
                }
                passes[numberOf(x, y, z)] = std::exp(-0.5f * depth);
            }
    });
    return passes;
}

/// By successive over-relaxation of the finite volumes' equations. `around`: phi at the border.
std::vector<float> RadianceLattice::diffuse(const Rates& rates, float around,
                                            const std::vector<float>& source) const {
    constexpr float relaxation = 1.8f;
    constexpr int sweeps = 60;
    const auto stepY = static_cast<std::size_t>(cells_.x),
               stepZ = stepY * static_cast<std::size_t>(cells_.y), count = content_.size();
    // Of half a cell: how it resists diffusion. Of the face to the next cell along each axis: how
    // well it conducts.
    const auto resistance = [&](std::size_t i) {
        return std::max(1.5f * rates.transport[i], emptyCell / 2);
    };
    const std::size_t steps[3] = {1, stepY, stepZ};
    std::vector<float> faces[3], weight(count), phi(count, around);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        faces[axis].resize(count);
        for (std::size_t i = 0; i + steps[axis] < count; ++i)
            faces[axis][i] = 1 / (resistance(i) + resistance(i + steps[axis]));
    }
    forInner([&](int x, int y, int z) {
        const std::size_t i = numberOf(x, y, z);
        float sum = rates.absorption[i];
        for (std::size_t axis = 0; axis < 3; ++axis)
            sum += faces[axis][i] + faces[axis][i - steps[axis]];
        weight[i] = relaxation / sum;
    });
    for (int sweep = 0; sweep < sweeps; ++sweep)
        forInner([&](int x, int y, int z) {
            const std::size_t i = numberOf(x, y, z);
            float sum = source[i];
            for (std::size_t axis = 0; axis < 3; ++axis)
                sum += faces[axis][i] * phi[i + steps[axis]] +
                       faces[axis][i - steps[axis]] * phi[i - steps[axis]];
            phi[i] = (1 - relaxation) * phi[i] + weight[i] * sum;
        });
    for (float& v : phi) v = std::max(v, 0.0f);
    return phi;
}

/// Solves for the radiance of each ordinate, given phi of what scatters, and keeps its moments.
void RadianceLattice::sweep(const Rates& rates, const Light& light, int channel,
                            const std::vector<float>& phi) {
    const std::vector<Vec3d> directions = ordinates();
    const double g = double{meanCosine_};
    double phases = 0;  // of sunlight; the mean is to be 1 / (4 pi)
    for (const Vec3d d : directions)
        phases += medium::henyeyGreenstein(-dot(light.towardsSun, d), g);
    const double whole = static_cast<double>(directions.size());
    std::vector<std::vector<float>> radiance(directions.size());
    tbb::parallel_for(std::size_t{0}, directions.size(), [&](std::size_t k) {
        const auto phase =
            static_cast<float>(medium::henyeyGreenstein(-dot(light.towardsSun, directions[k]), g) *
                               whole / (4 * pi * phases));
        sweepOrdinate(
            directions[k], rates, light.environment[channel],
            [&](std::size_t i) {
                return (rates.transport[i] - rates.absorption[i]) * phi[i] +
                       rates.scattering[i] * content_[i].channels[channel].sun * phase;
            },
            radiance[k]);
    });
    const auto weight = static_cast<float>(1 / whole);
    tbb::parallel_for(std::size_t{0}, content_.size(), [&](std::size_t i) {
        Channel& out = content_[i].channels[channel];
        for (std::size_t k = 0; k < directions.size(); ++k) {
            const float share = radiance[k][i] * weight;
            out.phi += share;
            // Light that travels along d meets paths that go along -d.
            for (int axis = 0; axis < 3; ++axis)
                out.ahead[axis] -= 3 * share * static_cast<float>(directions[k][axis]);
        }
    });
    const auto stepY = static_cast<std::size_t>(cells_.x),
               stepZ = stepY * static_cast<std::size_t>(cells_.y);
    const std::size_t steps[3] = {1, stepY, stepZ};
    forInner([&](int x, int y, int z) {
        const std::size_t i = numberOf(x, y, z);
        for (std::size_t axis = 0; axis < 3; ++axis)
            content_[i].channels[channel].slope[axis] =
                (content_[i + steps[axis]].channels[channel].phi -
                 content_[i - steps[axis]].channels[channel].phi) /
                2;
    });
}

/// Fills `radiance` with that of one direction, from cell to cell as light travels: by diamond
/// differences, in which a cell's radiance is the mean of what comes in and what goes out along
/// each axis. None is negative. source(i): what cell i sends there.
template <class F>
void RadianceLattice::sweepOrdinate(Vec3d direction, const Rates& rates, float around, F&& source,
                                    std::vector<float>& radiance) const {
    radiance.assign(content_.size(), around);
    float along[3], most = 0;
    for (int i = 0; i < 3; ++i) most += along[i] = 2 * std::abs(static_cast<float>(direction[i]));
    const auto width = static_cast<std::size_t>(cells_.x);
    // What comes into the next cells along y and along z.
    std::vector<float> rows(width), layers(width * static_cast<std::size_t>(cells_.y), around);
    const auto inOrder = [&](int axis, auto&& act) {
        for (int k = 1; k + 1 < cells_[axis]; ++k)
            act(direction[axis] > 0 ? k : cells_[axis] - 1 - k);
    };
    inOrder(2, [&](int z) {
        std::ranges::fill(rows, around);
        inOrder(1, [&](int y) {
            float next = around;
            inOrder(0, [&](int x) {
                const std::size_t i = numberOf(x, y, z);
                float& row = rows[static_cast<std::size_t>(x)];
                float& layer = layers[numberOf(x, y, 0)];
                const float mean =
                    (along[0] * next + along[1] * row + along[2] * layer + source(i)) /
                    (most + rates.transport[i]);
                for (float* face : {&next, &row, &layer}) *face = std::max(0.0f, 2 * mean - *face);
                radiance[i] = mean;
            });
        });
    });
}

}  // namespace woodcock::render
