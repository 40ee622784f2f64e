// SPDX-License-Identifier: Apache-2.0
#include "tests/support/brute_force.h"

#include <tbb/parallel_for.h>

#include <random>

namespace woodcock::test {

using namespace camera;
using namespace oracle;
using namespace proof;

namespace {

using Random = std::mt19937_64;
double uniform(Random& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

double phase(double cosine, double g) {
    return (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

Vec3d scatteredDirection(Vec3d forward, double g, Random& random) {
    const double u = uniform(random), q = (1 - g * g) / (1 - g + 2 * g * u);
    const double cosine = g == 0 ? 1 - 2 * u : (1 + g * g - q * q) / (2 * g);
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const double phi = 2 * pi * uniform(random);
    Vec3d s, t;
    orthonormalBasis(forward, s, t);
    return normalize(s * (sine * std::cos(phi)) + t * (sine * std::sin(phi)) + forward * cosine);
}

class Tracer {
public:
    explicit Tracer(const BruteScene& scene) : scene_(scene) {
        for (const BruteVolume& v : scene.volumes) {
            indexFromWorld_.push_back(v.worldFromIndex.inverse());
            majorant_ += v.density->largest * (v.absorption + v.scattering);
            const Vec3d one{1, 1, 1};
            const Box3d box{v.density->box.lower.as<double>() - one,
                            v.density->box.upper.as<double>() + one};
            for (int i = 0; i < 8; ++i) bounds_.add(v.worldFromIndex.point(box.corner(i)));
        }
        density_.resize(scene.volumes.size());
    }

    double radiance(Vec3d origin, Vec3d direction, Random& random) {
        double light = 0, throughput = 1;
        while (true) {
            double t = 0;
            if (!collide(origin, direction, t, random))
                return light + throughput * scene_.environment;
            origin += direction * t;
            double weight = 0, sun = 0;
            for (std::size_t i = 0; i < density_.size(); ++i) {
                const double w = density_[i] * scene_.volumes[i].phaseWeight;
                weight += w;
                sun += w * phase(dot(direction, scene_.towardsSun), scene_.volumes[i].g);
            }
            throughput *= scattering_ / (scattering_ + absorption_);
            double pick = uniform(random) * weight;
            std::size_t chosen = 0;
            while (chosen + 1 < density_.size() &&
                   pick >= density_[chosen] * scene_.volumes[chosen].phaseWeight)
                pick -= density_[chosen] * scene_.volumes[chosen].phaseWeight, ++chosen;
            double ignored = 0;
            if (!collide(origin, scene_.towardsSun, ignored, random))
                light += throughput * sun / weight * scene_.sunIrradiance;
            direction = scatteredDirection(direction, scene_.volumes[chosen].g, random);
        }
    }

private:
    /// The next real collision, at `t`; leaves the densities there. False: the ray escapes.
    bool collide(Vec3d origin, Vec3d direction, double& t, Random& random) {
        double t1 = std::numeric_limits<double>::infinity();
        t = 0;
        for (int i = 0; i < 3; ++i) {
            double a = (bounds_.lower[i] - origin[i]) / direction[i];
            double b = (bounds_.upper[i] - origin[i]) / direction[i];
            if (a > b) std::swap(a, b);
            t = std::max(t, a), t1 = std::min(t1, b);
        }
        while (true) {
            t -= std::log(1 - uniform(random)) / majorant_;
            if (!(t < t1)) return false;
            absorption_ = scattering_ = 0;
            for (std::size_t i = 0; i < density_.size(); ++i) {
                density_[i] = lookUp(i, origin + direction * t);
                absorption_ += density_[i] * scene_.volumes[i].absorption;
                scattering_ += density_[i] * scene_.volumes[i].scattering;
            }
            if (uniform(random) * majorant_ < absorption_ + scattering_) return true;
        }
    }

    double lookUp(std::size_t volume, Vec3d world) const {
        const VdbValues& values = *scene_.volumes[volume].density;
        const Vec3d p = indexFromWorld_[volume].point(world);
        const Vec3i v{static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)),
                      static_cast<int>(std::floor(p.z))};
        double sum = 0;
        for (int x = 0; x < 2; ++x)
            for (int y = 0; y < 2; ++y)
                for (int z = 0; z < 2; ++z)
                    sum += (1 - std::abs(p.x - v.x - x)) * (1 - std::abs(p.y - v.y - y)) *
                           (1 - std::abs(p.z - v.z - z)) * values.at(v + Vec3i{x, y, z});
        return sum;
    }

    const BruteScene& scene_;
    std::vector<Affine3d> indexFromWorld_;
    Box3d bounds_;
    double majorant_ = 0, absorption_ = 0, scattering_ = 0;
    std::vector<double> density_;  // of each volume, at the last collision
};

}  // namespace

Estimate bruteRadiance(const BruteScene& scene, int x0, int y0, int x1, int y1, int samples) {
    std::vector<Moments> rows(static_cast<std::size_t>(y1 - y0));
    tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t row) {
        Random random(row);
        Tracer tracer(scene);
        const int y = y0 + static_cast<int>(row);
        for (int x = x0; x < x1; ++x)
            for (int s = 0; s < samples; ++s) {
                const CameraRay ray =
                    scene.camera.ray(x + uniform(random), y + uniform(random), 160, 160);
                rows[row].add(tracer.radiance(ray.origin, ray.direction, random));
            }
    });
    double mean = 0, variance = 0;
    const auto n = static_cast<double>(rows.size());
    for (const Moments& m : rows)
        mean += m.mean() / n, variance += m.standardError() * m.standardError() / (n * n);
    return {mean, std::sqrt(variance)};
}

}  // namespace woodcock::test
