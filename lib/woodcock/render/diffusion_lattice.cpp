// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/diffusion_lattice.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "woodcock/light/even_light.h"
#include "woodcock/medium/line_depths.h"
#include "woodcock/render/media_table.h"

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

DiffusionLattice::Light lightOf(const light::LightSet& lights) {
    DiffusionLattice::Light light;
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
    light.sun = lights.sample(*sun, {}, 0, 0).weight;
    light.towardsSun = *lights.traits(*sun).parallel;
    return light;
}

}  // namespace

std::unique_ptr<const DiffusionLattice> DiffusionLattice::make(const Scene& scene) {
    const auto isOrdinary = [](const medium::MediumPart& part) {
        return part.field() && !part.unbounded() && !part.extinctionVaries() && !part.moved() &&
               !part.readElsewhere() && !part.support().empty();
    };
    const Light light = lightOf(scene.lights);
    if (!(light.environment.maximum() > 0 || light.sun.maximum() > 0) ||
        !isThick(MediumSummary(scene.medium)) || medium::moves(scene.medium) ||
        !std::ranges::all_of(scene.medium.parts, isOrdinary))
        return nullptr;
    return make(scene.medium, light);
}

std::unique_ptr<const DiffusionLattice> DiffusionLattice::make(const medium::Medium& medium,
                                                               const Light& light) {
    Rgb absorption, scattering;
    for (const medium::MediumPart& part : medium.parts)
        absorption += part.absorption(), scattering += part.scattering();
    if (!(absorption.maximum() > 0 && scattering.maximum() > 0)) return nullptr;
    const Box3d box = medium.worldBounds();
    const Vec3d size = box.size();
    std::unique_ptr<DiffusionLattice> made(new DiffusionLattice);
    DiffusionLattice& lattice = *made;
    lattice.edge_ = std::max({size.x, size.y, size.z}) / mostCells;
    if (!(lattice.edge_ > 0) || !std::isfinite(lattice.edge_)) return nullptr;
    for (int i = 0; i < 3; ++i)
        lattice.cells_[i] =
            std::clamp(static_cast<int>(std::ceil(size[i] / lattice.edge_)), 1, mostCells) + 2;
    lattice.origin_ =
        (box.lower + box.upper) * 0.5 - lattice.cells_.as<double>() * (lattice.edge_ / 2);
    lattice.latticeFromWorld_ = Affine3d::scale(Vec3d{1, 1, 1} * (1 / lattice.edge_)) *
                                Affine3d::translate(-lattice.origin_);
    lattice.content_.resize(static_cast<std::size_t>(lattice.cells_.x) *
                            static_cast<std::size_t>(lattice.cells_.y) *
                            static_cast<std::size_t>(lattice.cells_.z));
    Rates rates[3];
    lattice.survey(medium, rates);
    for (int c = 0; c < 3; ++c) {
        const bool asBefore = c > 0 && rates[c].absorption == rates[c - 1].absorption &&
                              rates[c].transport == rates[c - 1].transport &&
                              light.environment[c] == light.environment[c - 1] &&
                              light.sun[c] == light.sun[c - 1];
        if (asBefore) {
            for (Cell& cell : lattice.content_) cell.channels[c] = cell.channels[c - 1];
            continue;
        }
        std::vector<float> source(lattice.content_.size());
        if (light.sun[c] > 0) {
            source = lattice.sunlight(rates[c], light.towardsSun);
            for (std::size_t i = 0; i < source.size(); ++i)
                source[i] *= (rates[c].transport[i] - rates[c].absorption[i]) * light.sun[c] *
                             static_cast<float>(1 / (4 * pi));
        }
        lattice.keep(lattice.solve(rates[c], light.environment[c], source), rates[c], c);
    }
    return made;
}

void DiffusionLattice::survey(const medium::Medium& medium, Rates rates[3]) const {
    for (int c = 0; c < 3; ++c) {
        rates[c].absorption.assign(content_.size(), 0);
        rates[c].transport.assign(content_.size(), 0);
    }
    tbb::parallel_for(0, cells_.y, [&](int y) {
        for (const medium::MediumPart& part : medium.parts)
            for (int ray = 0; ray < raysAcross * raysAcross * cells_.x; ++ray)
                surveyRay(part, y, ray, rates);
    });
}

/// Adds what one of the rays through a row of cells, from low to high z, finds in them.
void DiffusionLattice::surveyRay(const medium::MediumPart& part, int row, int ray,
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
                rates[c].transport[i] += (absorption + (1 - forward) * scattering) * f;
            }
        });
}

/// The transmittance of `transport` from the middle of each cell to the sun, in steps of half a
/// cell.
std::vector<float> DiffusionLattice::sunlight(const Rates& rates, Vec3d towardsSun) const {
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
                    depth += rates.transport[numberOf(cell.x, cell.y, cell.z)];
                }
                passes[numberOf(x, y, z)] = std::exp(-0.5f * depth);
            }
    });
    return passes;
}

/// By successive over-relaxation of the finite volumes' equations. `around`: phi at the border.
std::vector<float> DiffusionLattice::solve(const Rates& rates, float around,
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

void DiffusionLattice::keep(const std::vector<float>& phi, const Rates& rates, int channel) {
    const auto stepY = static_cast<std::size_t>(cells_.x),
               stepZ = stepY * static_cast<std::size_t>(cells_.y);
    const std::size_t steps[3] = {1, stepY, stepZ};
    for (std::size_t i = 0; i < phi.size(); ++i) content_[i].channels[channel].phi = phi[i];
    forInner([&](int x, int y, int z) {
        const std::size_t i = numberOf(x, y, z);
        Channel& out = content_[i].channels[channel];
        float square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            out.slope[axis] = (phi[i + steps[axis]] - phi[i - steps[axis]]) / 2;
            square += out.slope[axis] * out.slope[axis];
        }
        const float longest = phi[i] / std::max(1e-30f, std::sqrt(square));
        out.path = std::min(1 / std::max(1e-3f, rates.transport[i]), longest);
    });
}

}  // namespace woodcock::render
