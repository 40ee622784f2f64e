// SPDX-License-Identifier: Apache-2.0
// Plane-parallel plates of clear or absorbing dielectric, with all reflections between their faces,
// added without phase: plates many wavelengths thick. Born and Wolf, Principles of Optics, section
// 1.5; Stokes, Proc. R. Soc. 11, 545 (1862), for piles. Absorption is too weak to change what a
// face reflects.
#pragma once

#include <vector>

namespace woodcock::oracle {

/// Parts of a beam's power reflected by a face, of light that is polarised across the plane of
/// incidence and in it.
struct FresnelReflectance {
    double s, p;
    double mean() const { return (s + p) / 2; }
};
/// For a beam at cosine `mu` in [0, 1] in index `from` that meets index `to`. Both are 1 from the
/// critical angle on.
FresnelReflectance fresnelReflectances(double mu, double from, double to);

/// One plate of a pile; it touches its neighbours. An air gap is one of index 1.
struct Plate {
    double index;
    double opticalDepth;  ///< of absorption, along the normal
};

/// Parts of a beam's power.
struct PlateAnswer {
    double reflectance, transmittance;
    double absorptance() const { return 1 - reflectance - transmittance; }
};

/// What renderers that know no polarisation must find: at each face the mean of s and p, as if
/// light had no memory of the face before. `mu`, in (0, 1], is that of the beam outside, where the
/// index is `outside` on both sides. The first plate is met first.
PlateAnswer unpolarisedPlates(const std::vector<Plate>& plates, double mu, double outside = 1);

/// What unpolarised light really does: the mean of what s and p do. Oblique clear plates transmit
/// more than unpolarisedPlates() says, as what has passed one face is of the kind that passes.
PlateAnswer polarisedPlates(const std::vector<Plate>& plates, double mu, double outside = 1);

}  // namespace woodcock::oracle
