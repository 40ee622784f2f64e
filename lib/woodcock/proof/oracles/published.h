// SPDX-License-Identifier: Apache-2.0
// Numbers of radiative transfer that others have published or computed, to be gone through. Those
// without a standard error hold to half a unit of their last digit, unless it says otherwise.
#pragma once

namespace woodcock::oracle {

/// A part of the power of a beam along the normal that a Henyey-Greenstein slab sends back
/// (specular reflection included) or through (unscattered light included).
struct PublishedSlab {
    enum Quantity { Reflectance, Transmittance };
    double g, opticalDepth, albedo, refractiveIndex;
    Quantity quantity;
    double value;
    double error;  ///< at most, or the standard error where `isMonteCarlo`
    bool isMonteCarlo;
    const char* source;
};

/// Stands for a half-space.
inline constexpr double veryDeep = 1000;

inline constexpr PublishedSlab publishedSlabs[]{
    {0.75, 2, 0.9, 1, PublishedSlab::Reflectance, 0.09739, 5e-6, false, "van de Hulst 1980"},
    {0.75, 2, 0.9, 1, PublishedSlab::Transmittance, 0.66096, 5e-6, false, "van de Hulst 1980"},
    {0.75, 2, 0.9, 1, PublishedSlab::Reflectance, 0.09734, 35e-5, true,
     "MCML, Wang and Jacques 1995, table 6.1"},
    {0.75, 2, 0.9, 1, PublishedSlab::Transmittance, 0.66096, 20e-5, true,
     "MCML, Wang and Jacques 1995, table 6.1"},
    {0.75, 2, 0.9, 1, PublishedSlab::Reflectance, 0.09711, 33e-5, true, "Prahl et al. 1989"},
    {0.75, 2, 0.9, 1, PublishedSlab::Transmittance, 0.66159, 49e-5, true, "Prahl et al. 1989"},
    // One unit of the last digit: from Chandrasekhar's H and Fresnel's equations it is 0.25992.
    {0, veryDeep, 0.9, 1.5, PublishedSlab::Reflectance, 0.2600, 1e-4, false, "Giovanelli 1955"},
    {0, veryDeep, 0.9, 1.5, PublishedSlab::Reflectance, 0.25907, 170e-5, true,
     "MCML, Wang and Jacques 1995, table 6.2"},
    {0, veryDeep, 0.9, 1.5, PublishedSlab::Reflectance, 0.26079, 79e-5, true, "Prahl et al. 1989"},
};

/// An isotropic slab of albedo 0.99 and optical depth 32 under diffuse light, a classic of DISORT
/// (Stamnes et al. 1988, test 1f): the flux back, from an environment of radiance 1, and the
/// radiance at three angles.
struct PublishedRadiance {
    double mu, radiance;
};
inline constexpr double disortReflectedFlux = 2.49618;
inline constexpr PublishedRadiance disortRadiances[]{
    {0.1, 0.877510}, {0.5, 0.815136}, {1, 0.752715}};

/// The part of diffuse light that a conservative isotropic slab transmits. The one of optical depth
/// 1 is also in Heaslet and Warming 1965, as 0.5534.
struct PublishedTransmittance {
    double opticalDepth, whiteSkyTransmittance;
};
inline constexpr PublishedTransmittance conservativeSlabs[]{
    {0.1, 0.915703}, {0.2, 0.849179}, {0.5, 0.704169}, {1, 0.553406},
    {2, 0.390060},   {3, 0.301645},   {5, 0.207657},   {10, 0.116745}};

/// Chandrasekhar's H function of isotropic scattering.
struct PublishedH {
    double albedo, mu, H;
};
/// Chandrasekhar 1960, table XI: five decimals.
inline constexpr PublishedH conservativeH[]{{1, 0, 1},         {1, 0.1, 1.24735}, {1, 0.2, 1.45035},
                                            {1, 0.5, 2.01278}, {1, 0.8, 2.55270}, {1, 1, 2.90781}};
/// From its integral, in arithmetic of 25 digits: seven decimals.
inline constexpr PublishedH absorbingH[]{
    {0.2, 1, 1.0786451},  {0.5, 1, 1.2512596},  {0.8, 1, 1.5982195},  {0.9, 1, 1.8500985},
    {0.95, 1, 2.0771238}, {0.99, 1, 2.4727928}, {0.999, 1, 2.7560725}};
/// Ten decimals.
inline constexpr double publishedHopfConstant = 0.7104460896;

/// Reflectance and transmittance of a beam along the normal, from another adding-doubling program
/// with 64 directions per hemisphere: six decimals.
struct ComputedSlab {
    double g, opticalDepth, albedo, reflectance, transmittance;
};
inline constexpr ComputedSlab computedSlabs[]{
    {0, 0.1, 0.5, 0.021733, 0.926465},   {0, 0.1, 0.9, 0.042101, 0.946746},
    {0, 0.1, 0.99, 0.047120, 0.951745},  {0, 0.1, 1, 0.047689, 0.952311},
    {0, 1, 0.5, 0.099119, 0.446058},     {0, 1, 0.9, 0.267410, 0.591625},
    {0, 1, 0.99, 0.332922, 0.650978},    {0, 1, 1, 0.341329, 0.658671},
    {0, 4, 0.5, 0.115172, 0.031989},     {0, 4, 0.9, 0.408142, 0.128524},
    {0, 4, 0.99, 0.645047, 0.275480},    {0, 4, 1, 0.690926, 0.309074},
    {0, 16, 0.5, 0.115226, 0},           {0, 16, 0.9, 0.414947, 0.000240},
    {0, 16, 0.99, 0.751259, 0.029598},   {0, 16, 1, 0.903632, 0.096368},
    {0.5, 1, 0.5, 0.038242, 0.520069},   {0.5, 1, 0.9, 0.129793, 0.739091},
    {0.5, 1, 0.99, 0.170728, 0.814516},  {0.5, 1, 1, 0.176115, 0.823885},
    {0.5, 4, 0.5, 0.047467, 0.055463},   {0.5, 4, 0.9, 0.261179, 0.250533},
    {0.5, 4, 0.99, 0.469796, 0.452650},  {0.5, 4, 1, 0.508967, 0.491033},
    {0.5, 16, 0.5, 0.047541, 0.000003},  {0.5, 16, 0.9, 0.277781, 0.002492},
    {0.5, 16, 0.99, 0.656064, 0.086019}, {0.5, 16, 1, 0.820976, 0.179024},
    {0.75, 1, 0.5, 0.015109, 0.564612},  {0.75, 1, 0.9, 0.055947, 0.827917},
    {0.75, 1, 0.99, 0.076025, 0.911177}, {0.75, 1, 1, 0.078740, 0.921260},
    {0.75, 2, 0.5, 0.018452, 0.305331},  {0.75, 2, 0.9, 0.097395, 0.660958},
    {0.75, 2, 0.99, 0.154400, 0.816038}, {0.75, 2, 1, 0.163176, 0.836824},
    {0.75, 8, 0.5, 0.019528, 0.005388},  {0.75, 8, 0.9, 0.162972, 0.130612},
    {0.75, 8, 0.99, 0.433048, 0.416336}, {0.75, 8, 1, 0.506415, 0.493585}};

}  // namespace woodcock::oracle
