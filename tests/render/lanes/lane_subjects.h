// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "woodcock/base/random.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/proof/support/render_scene.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/render/light_depths.h"
#include "woodcock/render/path_tracer.h"

namespace woodcock::test {

/// Scenes whose paths are traced in lanes, of a ragged ball of radius 1.
class LaneSubjects {
public:
    LaneSubjects() {
        proof::GridSpec grid;
        grid.box = {{0, 0, 0}, {15, 15, 15}};
        grid.value = [](Vec3i v) {
            const double r = length(v.as<double>() - Vec3d{7.5, 7.5, 7.5}) / 7.5;
            const double u = RandomStream(hashOf(31, v.x, v.y, v.z >> 1)).uniform();
            return r > 1 || u < 0.2 ? 0 : 1.6 * u;
        };
        grid.worldFromIndex =
            Affine3d::translate({-1, -1, -1}) * Affine3d::scale({2 / 15.0, 2 / 15.0, 2 / 15.0});
        proof::GridSpec heat = grid;
        heat.name = "heat", heat.box = {{4, 2, 5}, {11, 13, 10}};
        heat.value = [](Vec3i v) {
            return std::pow(RandomStream(hashOf(33, v.x, v.y, v.z)).uniform(), 4);
        };
        proof::writeVdb(dir_ / "ball.vdb", {grid, heat});
    }

    render::Scene scene(const std::string& rest) const {
        return proof::sceneFrom(
            rest + "[camera]\neye = [0, 0.6, 3.5]\nlook_at = [0, 0, 0]\nfov = 40\n", dir_.path());
    }

    static std::string ball(const std::string& keys) {
        return "[[volume]]\nfile = \"ball.vdb\"\n" + keys;
    }
    static std::string sun(double irradiance = 3, double diameter = 0) {
        return fmt::format(
            "[[light]]\ntype = \"sun\"\ndirection = [-0.6, -0.7, -0.4]\n"
            "irradiance = {}\nangular_diameter = {}\n",
            irradiance, diameter);
    }
    static constexpr const char* air =
        "[[light]]\ntype = \"environment\"\nradiance = [0.3, 0.5, 0.7]\n";
    static constexpr const char* lamp =
        "[[light]]\ntype = \"point\"\nposition = [0.7, 3.5, 0.5]\nintensity = 30\n";
    static constexpr const char* globe =
        "[[light]]\ntype = \"sphere\"\nposition = [0.4, 4, -1]\nradius = 0.6\n"
        "radiance = [9, 7, 5]\n";
    static constexpr const char* fire = "emission = { grid = \"heat\", scale = [8, 3, 1] }\n";
    static constexpr const char* turned =
        "transform = { translate = [0.3, 0.1, -0.2], rotate = [20, 40, 60] }\n";

    struct Named {
        const char* name;
        std::string text;
    };
    /// One of each kind.
    static std::vector<Named> kinds() {
        const std::string cloud = "sigma_s = 60\nsigma_a = 0\ng = 0.85\n",
                          coloured = "sigma_s = [30, 20, 5]\nsigma_a = [0.1, 0.5, 1.5]\ng = 0.5\n",
                          droplets = "sigma_s = 5\nphase = { type = \"mie\" }\n";
        return {
            {"grey", ball("sigma_s = 3\nsigma_a = 1\n") + sun() + air},
            {"thick", ball(cloud) + sun() + air},
            {"chromatic", ball(coloured) + sun() + air},
            {"parts", ball(cloud) + ball(turned + coloured) + sun() + air},
            {"a disc", ball(cloud) + sun(3, 0.53) + air},
            {"droplets", ball(droplets) + ball(turned + cloud) + sun(3, 0.53) + air},
            {"no sun", ball(coloured) + air},
            {"absorbing", ball("sigma_s = 2\nsigma_a = 3\n") + sun() + air},
            {"fire", ball("sigma_s = 2\nsigma_a = 3\ng = 0.3\n" + std::string(fire)) + sun() + air},
            {"coloured fires", ball(coloured + fire) + ball(turned + cloud + fire) + air},
            {"a lamp", ball(cloud) + lamp + air},
            {"a globe", ball("sigma_s = 3\nsigma_a = 1\n") + globe + air},
            {"lamps of parts", ball(cloud) + ball(turned + coloured) + globe + lamp + sun(1) + air},
            {"two suns", ball(coloured) + sun() + sun(1, 0.53) + air},
        };
    }

private:
    TempDir dir_;
};

/// Jobs for all pixels of such a picture.
inline std::vector<render::PathJob> jobsOf(int side, std::uint32_t samples) {
    std::vector<render::PathJob> jobs;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (std::uint32_t sample = 0; sample < samples; ++sample)
                jobs.push_back({x, y, sample});
    return jobs;
}

inline std::vector<render::PathResult> trace(const render::Scene& scene,
                                             const render::PathTracer::Options& options,
                                             std::span<const render::PathJob> jobs,
                                             const render::PathLayers& layers = {}) {
    std::vector<render::PathResult> results(jobs.size());
    render::RenderCounters counters;
    render::PathTracer::make(scene, render::findNeeds(scene), options)
        ->trace(
            jobs, results, layers, [] { return false; }, counters);
    return results;
}

}  // namespace woodcock::test
