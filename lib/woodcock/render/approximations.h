// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace woodcock {

/// What may be given up for time. Each choice changes the expected picture, is off by default and
/// works by itself. What concerns fields (storage, lookup, level of detail) is chosen when they are
/// loaded.
struct Approximations {
    /// Rays are marched in steps of so many voxels instead of tracked; 0: tracking. See
    /// medium/marching.h.
    double marchStep = 0;
    /// How marched optical depths become transmittance: by the jackknife of Peters 2025 (see
    /// medium/marching.h), or by plain exp(-tau), whose bias is of first order in their variance.
    bool jackknife = true;
    /// From this scattering order on, media are replaced by isotropic ones of equal transport
    /// coefficient, sigma_s' = (1 - g) sigma_s: similarity of order 1 (Zhao et al. 2014).
    std::optional<int> similarityAfter;
    /// Multiple scattering as so many octaves of single scattering instead of paths; 0: paths.
    /// Wrenninge et al. 2013, "Oz: The Great and Volumetric". See medium/octaves.h.
    int octaves = 0;
    /// Largest radiance (largest channel) that one path may bring; 0: any.
    double clamp = 0;
    /// Shadow rays go straight through dielectrics, dimmed by Fresnel's transmittance.
    bool transparentShadows = false;

    bool operator==(const Approximations&) const = default;
};

}  // namespace woodcock
