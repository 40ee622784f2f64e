// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace woodcock::render {

/// Approximations that save time. Each changes the expected picture, is off by default, and can be
/// used alone. Those of fields (storage, lookup, level of detail) are chosen when fields are
/// loaded.
struct Approximations {
    /// Ray marching instead of tracking, with steps of so many voxels; 0: tracking. See
    /// medium/marching.h.
    double marchStep = 0;
    /// How marched optical depths become transmittance: by the jackknife of Peters 2025 (see
    /// medium/marching.h), or by plain exp(-tau), whose bias is of first order in their variance.
    bool jackknife = true;
    /// From this scattering order on, media are replaced by isotropic ones of equal transport
    /// coefficient, sigma_s' = (1 - g) sigma_s: similarity of order 1 (Zhao et al. 2014).
    std::optional<int> similarityAfter;
    /// Multiple scattering as this many octaves of single scattering instead of paths; 0: paths.
    /// Wrenninge et al. 2013, "Oz: The Great and Volumetric". See medium/octaves.h.
    int octaves = 0;
    /// The largest radiance (largest channel) of one path; 0: no limit.
    double clamp = 0;
    /// Shadow rays go straight through dielectrics, times the Fresnel transmittance.
    bool transparentShadows = false;

    bool operator==(const Approximations&) const = default;
};

}  // namespace woodcock::render
