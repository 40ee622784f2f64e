// SPDX-License-Identifier: Apache-2.0
// Answers of radiative transfer that have a formula.
//
// Written to keep their digits where the textbook's form cancels or overflows: at optical depth 0
// and 1e8, at equal angles, at g near 0 and +-1. Cosines mu are between a direction and a slab's
// normal, in (0, 1]. Coefficients are per unit of length, in the unit that distances are in.
#pragma once

namespace woodcock::oracle {

// ---- Transmittance and emission ----

/// exp(-opticalDepth / mu): an absorbing slab (Beer and Lambert).
double slabTransmittance(double opticalDepth, double mu);

/// Radiance that `length` of a medium emits along itself: emission / absorption times
/// (1 - exp(-absorption length)); emission times length where nothing is absorbed.
double emittedRadiance(double emission, double absorption, double length);

/// Mean transmittance over the disc that an absorbing sphere shows to a parallel beam:
/// (1 - (1 + 2T) exp(-2T)) / (2 T^2), where T is the optical depth of the radius.
double sphereDiscTransmittance(double opticalRadius);

/// Optical depth of sigma exp(-r^2 / (2 s^2)) along a whole line that passes the centre at distance
/// `offset`: sqrt(2 pi) sigma s exp(-offset^2 / (2 s^2)).
double gaussianBallOpticalDepth(double sigma, double s, double offset);

/// Optical depth of sigma exp(-z / scaleHeight) between the altitudes, in direction mu. `top` may
/// be infinite.
double exponentialAtmosphereOpticalDepth(double sigma, double scaleHeight, double bottom,
                                         double top, double mu);

/// Optical depth of `length` along which extinction changes evenly between two values. Trilinear
/// interpolation reproduces such a ramp exactly.
double rampOpticalDepth(double sigmaStart, double sigmaEnd, double length);

// ---- Single scattering ----

/// Radiance that leaves a slab after exactly one scattering, on the side that is lit, for a beam of
/// irradiance 1 (across the beam) at mu0. `phase` is the phase function of the angle between the
/// two directions, in 1/sr.
double singleScatterReflected(double opticalDepth, double albedo, double phase, double mu,
                              double mu0);
/// The same on the far side, without the beam itself.
double singleScatterTransmitted(double opticalDepth, double albedo, double phase, double mu,
                                double mu0);

/// Part of a beam's power that leaves an isotropic half-space after exactly one scattering:
/// albedo / 2 (1 + mu ln(mu / (1 + mu))); mu may be 0.
double halfSpaceFirstOrderAlbedo(double albedo, double mu);
/// The same for diffuse light: 2 albedo / 3 (1 - ln 2).
double halfSpaceFirstOrderWhiteSkyAlbedo(double albedo);

/// A homogeneous infinite medium with Henyey-Greenstein scattering around a point light.
struct Airlight {
    double absorption, scattering, g;
    double intensity;  ///< of the light, power per steradian
    double offset;     ///< distance of the light from the line of sight; above 0
};
/// Radiance seen after exactly one scattering ("airlight") on the part of the line of sight between
/// `from` and `to`, measured along the sight from the point nearest to the light, where the eye is
/// at `eye` <= from. `to` may be infinite. By quadrature in the angle around the light
/// (equiangular; Pegoraro and Parker 2009): relative error 1e-10 while (absorption + scattering)
/// times offset is below 200.
double airlight(const Airlight& scene, double eye, double from, double to);

// ---- Infinite media and bodies ----

/// Of a path in an infinite medium, the absorption included: 1 / (1 - albedo).
double meanCollisionCount(double albedo);

/// Mean square of the distance from the start to collision n, in mean free paths, n >= 1:
/// 2 (n / (1 - g) - g (1 - g^n) / (1 - g)^2).
double meanSquareDistance(int n, double g);

/// Mean length of straight paths through a convex body that is lit evenly from everywhere, 4 V / S
/// (Cauchy). Paths that scatter but are not absorbed are as long (Blanco and Fournier 2003).
double meanChord(double volume, double surface);
double cubeMeanChord(double edge);
double sphereMeanChord(double radius);
double slabMeanChord(double thickness);

// ---- The phase function of Henyey and Greenstein (1941) ----
// `cosine` is of the angle by which light turns. Its mean is g; g is in (-1, 1).

/// Per steradian; integrates to 1 over the sphere.
double henyeyGreenstein(double cosine, double g);
/// The probability to turn to `cosine` or below.
double henyeyGreensteinCdf(double cosine, double g);

}  // namespace woodcock::oracle
