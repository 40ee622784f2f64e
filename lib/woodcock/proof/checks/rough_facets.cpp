// SPDX-License-Identifier: Apache-2.0
// Rough metal and glass lose no energy between their facets: in uniform light of radiance 1 they
// are invisible, both by sampling the BSDF and by next-event estimation.
#include <fmt/format.h>

#include <cmath>

#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/subjects.h"

namespace woodcock::proof {

namespace {

void even(Lab& lab, const std::string& name, const std::string& scene, double expected,
          const std::string& note) {
    const Precision precision = dearPrecision(lab);
    Case c = caseOf(name, expected, evenPicture(lab, name, sceneIn(lab, scene), precision, {0})[0],
                    precision);
    c.note = note;
    c.allowance = 5e-4 * expected;  // tables of the losses, with next-event estimation
    lab.add(std::move(c));
}

std::string glass(double roughness, double ior) {
    return fmt::format(
        "[[material]]\nname = \"rough\"\ntype = \"dielectric\"\nior = {}\nroughness = {}\n", ior,
        roughness);
}
std::string metal(double roughness) {
    return fmt::format(
        "[[material]]\nname = \"rough\"\ntype = \"conductor\"\ncolour = 1\nroughness = {}\n",
        roughness);
}

void roughFacets(Lab& lab) {
    const std::string ball = "[[surface]]\nmaterial = \"rough\"\nsphere = {}\n";
    // All light comes from walls that emit and do not reflect, so next-event estimation has a
    // share.
    const std::string room =
        "[[material]]\nname = \"wall\"\ntype = \"emissive\"\nradiance = 1\nboth_sides = true\n"
        "[[surface]]\nmaterial = \"wall\"\nbox = { min = [-3, -3, -3], max = [3, 3, 3] }\n"
        "[camera]\neye = [0, 0.7, 2.8]\nlook_at = [0, 0, 0]\nfov = 50\n";
    const std::string sky = "[[light]]\ntype = \"environment\"\n";
    for (const double roughness : {0.1, 0.3, 0.6, 1.0}) {
        even(lab, fmt::format("a ball of white metal, roughness {}", roughness),
             metal(roughness) + ball + room, 1, "");
        for (const double ior : {1.33, 1.5, 2.4}) {
            even(lab, fmt::format("a ball of glass of {}, roughness {}", ior, roughness),
                 glass(roughness, ior) + ball + room, 1, "both sides of its face");
            // From within, beyond the critical angle too.
            for (const double mu : {0.9, 0.2})
                even(
                    lab,
                    fmt::format("from within glass of {}, roughness {}, mu {}", ior, roughness, mu),
                    glass(roughness, ior) +
                        "[[material]]\nname = \"white\"\ntype = \"diffuse\"\ncolour = 1\n"
                        "[[surface]]\nmaterial = \"rough\"\n"
                        "box = { min = [-1e4, -1, -1e4], max = [1e4, 0, 1e4] }\n"
                        "[[surface]]\nmaterial = \"white\"\nplane = {}\n"
                        "transform = { translate = [0, -0.9, 0] }\n" +
                        sky + pencilCamera({0, -0.5, 0}, {std::sqrt((1 - mu) * (1 + mu)), mu, 0}),
                    ior * ior, "index^2, above a white floor");
        }
    }
}

}  // namespace

std::vector<Check> roughSurfaces() { return {{Kind::Surface, "rough facets", roughFacets}}; }

}  // namespace woodcock::proof
