// SPDX-License-Identifier: Apache-2.0
// Isotropic scattering in a half-space, where everything follows from one function.
//
// Chandrasekhar, Radiative Transfer (1960), chapters 3 to 5; Stibbs and Weir, Mon. Not. R. Astron.
// Soc. 119, 512 (1959), for H as an integral; Case and Zweifel, Linear Transport Theory (1967).
// Cosines in [0, 1] are between the direction and the half-space's normal. Lengths are in mean free
// paths. Relative errors are about 1e-13.
#pragma once

namespace woodcock::oracle {

/// Chandrasekhar's H function of isotropic scattering with `albedo` in [0, 1].
double chandrasekharH(double albedo, double mu);

/// The integral of mu^order H(mu) over [0, 1].
double chandrasekharMoment(double albedo, int order);

/// Part of a beam's power that a half-space reflects: 1 - sqrt(1 - albedo) H(mu). By reciprocity,
/// the radiance seen in that direction under an environment of radiance 1.
double halfSpaceAlbedo(double albedo, double mu);

/// The same for diffuse light, the integral of 2 mu halfSpaceAlbedo: 1 - 2 sqrt(1 - albedo) times
/// the first moment.
double halfSpaceWhiteSkyAlbedo(double albedo);

/// Radiance that leaves an isothermal half-space relative to a black body's (Kirchhoff).
double halfSpaceEmissivity(double albedo, double mu);

/// Radiance that leaves at `mu`, from a beam of irradiance 1 (across the beam) that enters at mu0,
/// at any azimuth: albedo / (4 pi) mu0 / (mu + mu0) H(mu) H(mu0).
double halfSpaceRadiance(double albedo, double mu, double mu0);

/// Milne's problem: radiance that leaves a conservative half-space lit from its depths, relative to
/// that along the normal. H(mu) / H(1) at albedo 1.
double milneLimbDarkening(double mu);

/// Hopf's constant, where the diffuse flux seems to vanish above a conservative half-space: the
/// ratio of the second to the first moment, 0.7104...
double hopfConstant();

/// Case's discrete eigenvalue nu0, the diffusion length: deep in a medium fluence falls as
/// exp(-depth / nu0). The solution above 1 of 1 = albedo nu / 2 ln((nu + 1) / (nu - 1)): 1 at
/// albedo 0, infinite at albedo 1.
double caseEigenvalue(double albedo);

}  // namespace woodcock::oracle
