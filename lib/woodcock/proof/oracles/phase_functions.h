// SPDX-License-Identifier: Apache-2.0
// Phase functions as their papers write them: with sines and cosines, and no care for the digits
// that this costs close to straight on. `cosine` is of the angle by which light turns. Each is per
// steradian, and integrates to 1 over the sphere.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace woodcock::oracle {

/// Rayleigh 1871.
double rayleigh(double cosine);
/// Draine 2003, eq. 4.
double draine(double cosine, double g, double alpha);
double draineMeanCosine(double g, double alpha);
/// (1 - mix) of Henyey-Greenstein with g, mix with g2.
double twoLobes(double cosine, double g, double g2, double mix);
/// Jendersie and d'Eon 2023, for droplets of water from 5 to 50 micrometres.
double mieDroplets(double cosine, double diameter);
/// Fournier and Jonasz 1999, eq. 3 by the angle; not at 0, nor where delta is 1.
double fournierForand(double angle, double ior, double backscatter);

/// The Legendre series with these moments: the sum of (2l + 1) moments[l] P_l(cosine), over 4 pi.
double legendreSeries(double cosine, const std::vector<double>& moments);
/// The means of P_l over a phase function, l from 0 to count - 1, by quadrature.
std::vector<double> legendreMoments(const std::function<double(double)>& phase, std::size_t count);

/// The part of light that turns to less than a cosine, by quadrature of a density. The cosines of
/// `kinks` are where the density is not smooth.
class TurnDistribution {
public:
    explicit TurnDistribution(std::function<double(double)> density,
                              const std::vector<double>& kinks = {});

    double total() const { return parts_.back(); }  ///< should be 1
    double meanCosine() const { return meanCosine_; }
    /// The probability to turn to `cosine` or below, over the total.
    double operator()(double cosine) const;

private:
    std::function<double(double)> density_;
    std::vector<double> cosines_, parts_;  // rising; the integral up to each
    double meanCosine_ = 0;
};

}  // namespace woodcock::oracle
