// SPDX-License-Identifier: Apache-2.0
// Exact answers of plane-parallel slabs, with no random numbers: the adding-doubling method.
//
// van de Hulst, Multiple Light Scattering (1980), chapter 4; Plass, Kattawar and Catchings, Appl.
// Opt. 12, 314 (1973); Wiscombe, J. Quant. Spectrosc. Radiat. Transfer 16, 637 (1976), for the
// start from a thin layer; Prahl, in Optical-Thermal Response of Laser-Irradiated Tissue (1995),
// chapter 5, for boundaries with refraction.
#pragma once

#include <cstddef>
#include <vector>

namespace woodcock::oracle {

/// Homogeneous, with Henyey-Greenstein scattering, or any other by its Legendre moments. Layers of
/// equal albedo and scattering are equal if their optical depths are, however extinction varies
/// inside them.
struct Layer {
    double opticalDepth;  ///< along the normal; 0 or more, finite
    double albedo;        ///< of single scattering, in [0, 1]
    double g;             ///< mean cosine, in (-1, 1)
    /// Of the phase function, in place of g: the means of P_l, from l = 0 on, which is 1. With more
    /// moments than twice the nodes, more nodes are needed.
    std::vector<double> moments = {};
};

struct Slab {
    std::vector<Layer> layers;  ///< the uppermost first
    /// Of the layers relative to what is around them, 1 or more: both faces then reflect and
    /// refract unpolarised light by Fresnel's equations.
    double refractiveIndex = 1;
};

/// What a slab does with light that meets one of its faces.
///
/// For a beam at each of the cosines asked for: the parts of its power that leave on the side it
/// came from (`reflectance`) and on the other (`transmittance`, unscattered light included). By
/// reciprocity the same numbers are radiances. An eye on that side, looking at the slab at that
/// cosine, sees `reflectance` where the only light is an environment of radiance 1 on its own
/// side, and `transmittance` where it is one on the far side.
struct Face {
    std::vector<double> reflectance, transmittance;
    /// The same for diffuse light: the integrals of 2 mu times the above over mu in (0, 1).
    double whiteSkyReflectance, whiteSkyTransmittance;
};

struct SlabAnswer {
    Face above, below;
};

/// The answers of `slab` at the cosines `mu`, each in (0, 1], measured outside the slab.
///
/// `nodes` is the number of directions per hemisphere, of Gauss-Legendre quadrature in mu. The
/// angles of `mu` join them with weight 0, so that no answer is interpolated. The phase function is
/// averaged over azimuth in closed form, not cut off at an order; what the nodes miss of its peak
/// goes straight on, so that energy is conserved to rounding for any g.
///
/// Errors of an answer, from more nodes: at cosines from 0.1, 16 nodes give 3e-6 and 32 nodes 1e-7
/// for |g| up to 0.75; 64 nodes give 2e-8 for |g| up to 0.9, 2e-6 at 0.95, 6e-4 at 0.99. At a
/// cosine of 0.01 it is some thirty times as much. Rounding adds 2e-15 times the optical depth
/// where nothing is absorbed. Time grows like the cube of nodes: some 15 ms for a layer with 64.
/// Throws a usage error where a number is out of its range.
SlabAnswer solveSlab(const Slab& slab, const std::vector<double>& mu, std::size_t nodes = 64);

/// The Henyey-Greenstein phase function times 4 pi, averaged over azimuth, from direction cosine
/// `from` to `to`, both in [-1, 1]. Half its integral over `to` is 1.
double azimuthMeanOfHenyeyGreenstein(double to, double from, double g);

/// The part of unpolarised light that a plane boundary reflects, coming at cosine `mu` from the
/// thinner side, where the other is `index` times as dense (index >= 1).
double fresnelReflectance(double mu, double index);

}  // namespace woodcock::oracle
