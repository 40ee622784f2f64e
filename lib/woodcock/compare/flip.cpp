// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace woodcock::compare {

namespace {

using Triple = std::array<float, 3>;
using Matrix = std::array<std::array<double, 3>, 3>;

// Linear Rec.709 to XYZ and back, as exact fractions in the paper's supplement.
constexpr Matrix xyzFromRgb{{{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                             {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                             {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}}};
constexpr Matrix rgbFromXyz{{{3.241003232976358, -1.537398969488785, -0.498615881996363},
                             {-0.969224252202516, 1.875929983695176, 0.041554226340085},
                             {0.055639419851975, -0.204011206123910, 1.057148977187533}}};

std::array<double, 3> times(const Matrix& m, const std::array<double, 3>& v) {
    std::array<double, 3> r{};
    for (std::size_t i = 0; i < 3; ++i) r[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return r;
}

std::array<double, 3> white() { return times(xyzFromRgb, {1, 1, 1}); }

std::array<double, 3> whiteRelative(const std::array<double, 3>& rgb) {
    std::array<double, 3> xyz = times(xyzFromRgb, rgb);
    const std::array<double, 3> w = white();
    for (std::size_t i = 0; i < 3; ++i) xyz[i] /= w[i];
    return xyz;
}

/// The opponent space YCxCz, linear in light.
Triple opponentFromRgb(const std::array<double, 3>& rgb) {
    const auto [x, y, z] = whiteRelative(rgb);
    return {static_cast<float>(116 * y - 16), static_cast<float>(500 * (x - y)),
            static_cast<float>(200 * (y - z))};
}

std::array<double, 3> rgbFromOpponent(const Triple& c) {
    const double y = (c[0] + 16) / 116;
    const std::array<double, 3> w = white();
    return times(rgbFromXyz, {(y + c[1] / 500.0) * w[0], y * w[1], (y - c[2] / 200.0) * w[2]});
}

/// CIELAB with chroma damped where it is dark (Hunt 1952), as the paper has it.
std::array<double, 3> huntLab(const std::array<double, 3>& rgb) {
    constexpr double delta = 6.0 / 29;
    std::array<double, 3> f = whiteRelative(rgb);
    for (double& v : f)
        v = v > delta * delta * delta ? std::cbrt(v) : v / (3 * delta * delta) + 4.0 / 29;
    const double l = 116 * f[1] - 16;
    return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}

double hyab(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

constexpr double colourExponent = 0.7;

/// Maps a distance of Lab colours to 0..1 by section 4.1.3 of the paper; small distances get most
/// of the range.
double compressed(double distance) {
    constexpr double knee = 0.4, kneeHeight = 0.95;
    static const double largest =
        std::pow(hyab(huntLab({0, 1, 0}), huntLab({0, 0, 1})), colourExponent);
    const double d = std::pow(distance, colourExponent), at = knee * largest;
    return d < at ? kneeHeight / at * d : kneeHeight + (d - at) / (largest - at) * (1 - kneeHeight);
}

using Kernel = std::vector<float>;
using Plane = std::vector<float>;

Kernel kernel(int radius, auto&& f) {
    Kernel k;
    for (int i = -radius; i <= radius; ++i) k.push_back(static_cast<float>(f(i)));
    return k;
}

void normalise(Kernel& k) {
    float sum = 0;
    for (const float v : k) sum += v;
    for (float& v : k) v /= sum;
}

/// Scales positive weights to a sum of 1, negative ones to -1.
void normaliseSigns(Kernel& k) {
    float above = 0, below = 0;
    for (const float v : k) (v > 0 ? above : below) += v;
    for (float& v : k) v /= v > 0 ? above : -below;
}

struct Size {
    int width, height;
};

/// Along x and then along y; pixels beyond the border are those at it.
Plane filtered(const Plane& from, Size size, const Kernel& alongX, const Kernel& alongY) {
    const auto pass = [size](const Plane& in, const Kernel& k, bool x) {
        Plane out(in.size());
        const int radius = static_cast<int>(k.size()) / 2;
        const int length = x ? size.width : size.height;
        tbb::parallel_for(0, size.height, [&](int row) {
            for (int column = 0; column < size.width; ++column) {
                const int at = x ? column : row;
                const std::ptrdiff_t step = x ? 1 : size.width;
                const float* line = in.data() + (x ? std::ptrdiff_t{row} * size.width : column);
                float sum = 0;
                for (int i = -radius; i <= radius; ++i)
                    sum += k[static_cast<std::size_t>(i + radius)] *
                           line[step * std::clamp(at + i, 0, length - 1)];
                out[static_cast<std::size_t>(row) * static_cast<std::size_t>(size.width) +
                    static_cast<std::size_t>(column)] = sum;
            }
        });
        return out;
    };
    return pass(pass(from, alongX, true), alongY, false);
}

/// A sum of two Gaussians: contrast sensitivity of a colour channel.
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> sensitivities{
    {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};

/// The planes, filtered by the contrast sensitivity of the eye.
std::array<Plane, 3> seen(const std::array<Plane, 3>& planes, Size size, double pixelsPerDegree) {
    constexpr double pi = std::numbers::pi;
    const int radius =
        static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * pixelsPerDegree));
    std::array<Plane, 3> out;
    for (std::size_t c = 0; c < 3; ++c) {
        const Sensitivity& s = sensitivities[c];
        const auto gaussian = [&](double b) {
            return kernel(radius, [&](int i) {
                const double x = i / pixelsPerDegree;
                return std::exp(-pi * pi * x * x / b);
            });
        };
        // Each Gaussian is separable, so that their weighted sum is two filters.
        double total = 0;
        for (const auto& [a, b] : {std::pair{s.a1, s.b1}, std::pair{s.a2, s.b2}}) {
            if (a == 0) continue;
            Kernel k = gaussian(b);
            double sum = 0;
            for (const float v : k) sum += v;
            const double weight = a * std::sqrt(pi / b) * sum * sum;
            normalise(k);
            const Plane part = filtered(planes[c], size, k, k);
            if (out[c].empty()) out[c].resize(part.size());
            for (std::size_t i = 0; i < part.size(); ++i)
                out[c][i] += static_cast<float>(weight) * part[i];
            total += weight;
        }
        for (float& v : out[c]) v = static_cast<float>(v / total);
    }
    return out;
}

/// Strength of edges and of points in lightness.
struct Features {
    Plane edges, points;
};

Features features(Plane lightness, Size size, double pixelsPerDegree) {
    const double deviation = 0.5 * 0.082 * pixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const auto g = [&](int i) { return std::exp(-i * i / (2 * deviation * deviation)); };
    Kernel smooth = kernel(radius, g);
    Kernel first = kernel(radius, [&](int i) { return -i * g(i); });
    Kernel second =
        kernel(radius, [&](int i) { return (i * i / (deviation * deviation) - 1) * g(i); });
    normalise(smooth), normaliseSigns(first), normaliseSigns(second);
    for (float& v : lightness) v = (v + 16) / 116;
    const auto strength = [&](const Kernel& k) {
        Plane x = filtered(lightness, size, k, smooth);
        const Plane y = filtered(lightness, size, smooth, k);
        for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::hypot(x[i], y[i]);
        return x;
    };
    return {strength(first), strength(second)};
}

struct Perceived {
    std::vector<std::array<float, 3>> lab;
    Features features;
};

Perceived perceive(std::span<const float> rgb, Size size, double pixelsPerDegree) {
    const std::size_t pixels = rgb.size() / 3;
    std::array<Plane, 3> planes;
    for (Plane& plane : planes) plane.resize(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto clipped = [&](std::size_t c) {
            return static_cast<double>(std::clamp(rgb[3 * i + c], 0.0f, 1.0f));
        };
        const Triple c = opponentFromRgb({clipped(0), clipped(1), clipped(2)});
        for (std::size_t k = 0; k < 3; ++k) planes[k][i] = c[k];
    }
    const std::array<Plane, 3> blurred = seen(planes, size, pixelsPerDegree);
    Perceived p;
    p.lab.resize(pixels);
    tbb::parallel_for(std::size_t{0}, pixels, [&](std::size_t i) {
        std::array<double, 3> c = rgbFromOpponent({blurred[0][i], blurred[1][i], blurred[2][i]});
        for (double& v : c) v = std::clamp(v, 0.0, 1.0);
        const std::array<double, 3> lab = huntLab(c);
        for (std::size_t k = 0; k < 3; ++k) p.lab[i][k] = static_cast<float>(lab[k]);
    });
    p.features = features(std::move(planes[0]), size, pixelsPerDegree);
    return p;
}

/// The tone mapping of ACES as a fraction of two quadratics (Narkowicz 2016, exposed for white).
struct ToneMapping {
    double a = 0.36 * 2.51, b = 0.6 * 0.03, c = 0.36 * 2.43, d = 0.6 * 0.59, e = 0.14;
    double operator()(double x) const { return (a * x * x + b * x) / (c * x * x + d * x + e); }
    /// The light that it maps to `y`.
    double inverse(double y) const {
        const double p = (b - y * d) / (a - y * c) / 2, q = -y * e / (a - y * c);
        return -p + std::sqrt(p * p - q);
    }
};

/// Stops between which HDR-FLIP exposes; section 3.1 of the paper.
std::array<double, 2> exposureRange(std::span<const float> reference) {
    std::vector<float> luminance(reference.size() / 3);
    for (std::size_t i = 0; i < luminance.size(); ++i)
        luminance[i] = 0.2126f * reference[3 * i] + 0.7152f * reference[3 * i + 1] +
                       0.0722f * reference[3 * i + 2];
    const auto middle = luminance.begin() + static_cast<std::ptrdiff_t>(luminance.size() / 2);
    std::nth_element(luminance.begin(), middle, luminance.end());
    const double least = std::numeric_limits<float>::epsilon();
    const double median = std::max<double>(*middle, least);
    const double most =
        std::max<double>(*std::max_element(luminance.begin(), luminance.end()), least);
    const double shown = ToneMapping{}.inverse(0.85);
    return {std::log2(shown / most), std::log2(shown / median)};
}

std::vector<float> exposed(std::span<const float> rgb, double stops) {
    const ToneMapping map;
    const double gain = std::exp2(stops);
    std::vector<float> out(rgb.size());
    tbb::parallel_for(std::size_t{0}, rgb.size(), [&](std::size_t i) {
        // Light that overflows is white.
        const double x = std::min(gain * std::max(0.0f, rgb[i]), 1e100);
        out[i] = static_cast<float>(map(x));
    });
    return out;
}

}  // namespace

std::vector<float> flipLdr(std::span<const float> reference, std::span<const float> test, int width,
                           int height, double pixelsPerDegree) {
    const Size size{width, height};
    const Perceived a = perceive(reference, size, pixelsPerDegree),
                    b = perceive(test, size, pixelsPerDegree);
    std::vector<float> error(a.lab.size());
    tbb::parallel_for(std::size_t{0}, error.size(), [&](std::size_t i) {
        const auto lab = [i](const Perceived& p) {
            return std::array<double, 3>{p.lab[i][0], p.lab[i][1], p.lab[i][2]};
        };
        const double colour = compressed(hyab(lab(a), lab(b)));
        const double edges = std::abs(a.features.edges[i] - b.features.edges[i]);
        const double points = std::abs(a.features.points[i] - b.features.points[i]);
        const double feature =
            std::sqrt(std::clamp(std::max(edges, points) / std::numbers::sqrt2, 0.0, 1.0));
        error[i] = static_cast<float>(std::pow(colour, 1 - feature));
    });
    return error;
}

std::vector<float> flipHdr(std::span<const float> reference, std::span<const float> test, int width,
                           int height, double pixelsPerDegree) {
    const auto [start, stop] = exposureRange(reference);
    const int count = std::max(2, static_cast<int>(std::ceil(stop - start)));
    std::vector<float> largest(reference.size() / 3, 0);
    for (int i = 0; i < count; ++i) {
        const double stops = start + i * (stop - start) / (count - 1);
        const std::vector<float> error = flipLdr(exposed(reference, stops), exposed(test, stops),
                                                 width, height, pixelsPerDegree);
        for (std::size_t k = 0; k < largest.size(); ++k)
            largest[k] = std::max(largest[k], error[k]);
    }
    return largest;
}

}  // namespace woodcock::compare
