// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/precision.h"

#include <fmt/format.h>

#include <cmath>

#include "woodcock/render/scene.h"

namespace woodcock::render {

namespace {

constexpr double doubleEpsilon = std::numeric_limits<double>::epsilon();
constexpr double largestFloat = std::numeric_limits<float>::max();
constexpr double smallestFloat = std::numeric_limits<float>::min();
/// A length must be this many roundings of positions, to be resolved well.
constexpr double resolved = 100;
/// Optical depths that tests cover.
constexpr double deepest = 1e18;

double largestCoordinate(Vec3d p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}
double largestCoordinate(const Box3d& b) {
    return std::max(largestCoordinate(b.lower), largestCoordinate(b.upper));
}
double smallestVoxel(const Affine3d& worldFromIndex) {
    const auto& c = worldFromIndex.column;
    return std::min({length(c[0]), length(c[1]), length(c[2])});
}
std::string text(Vec3d p) { return fmt::format("[{:g}, {:g}, {:g}]", p.x, p.y, p.z); }

class Findings {
public:
    explicit Findings(const Scene& scene) : bounds_(scene.medium.worldBounds()) {
        for (std::size_t i = 0; i < scene.medium.parts.size(); ++i)
            checkPart(scene.medium.parts[i], i, scene.medium.parts.size());
        checkCamera(scene.camera.worldFromCamera.translation);
        for (const light::Light& light : scene.lights.lights()) checkLight(light);
    }
    std::vector<std::string> take() { return std::move(found_); }

private:
    template <class... Args>
    void add(fmt::format_string<Args...> format, Args&&... args) {
        found_.push_back(fmt::format(format, std::forward<Args>(args)...));
    }

    void checkPart(const medium::MediumPart& part, std::size_t index, std::size_t count) {
        const std::string name =
            count == 1 ? "the volume"
                       : fmt::format("part {} of {} of the volumes", index + 1, count);
        const double value = part.field() ? double{part.field()->range().max} : 1;
        const double sigma = value * part.largestExtinction();
        if (!(sigma <= largestFloat)) {
            add("{}: sigma_t reaches {:g} x {:g}, beyond the largest float, {:g}: its scattered "
                "light is not finite; lower its scale",
                name, value, part.largestExtinction(), largestFloat);
            return;
        }
        if (part.extent().empty() || !(sigma > 0)) return;
        const Box3d box = part.worldBounds();
        const double far = largestCoordinate(box), rounding = far * doubleEpsilon;
        const std::string where = fmt::format("{}, at coordinates up to {:g}", name, far);
        const double voxel = smallestVoxel(part.description().worldFromIndex);
        if (!std::isfinite(far)) {
            add("{}: its bounds are not finite; check its transform", name);
        } else if (part.field() && voxel < resolved * rounding) {
            add("{}: positions there are rounded to {:.2g}, and its voxels are {:.2g} wide: they "
                "are blurred; move the scene towards the origin",
                where, rounding, voxel);
        } else if (const double depth = sigma * length(box.size()); depth > deepest) {
            add("{}: its optical depth is up to {:.2g}; woodcock is not tested beyond {:g}; lower "
                "its scale",
                name, depth, deepest);
        } else if (sigma * rounding * resolved > 1) {
            add("{}: positions there are rounded to {:.2g}, and its mean free path is down to "
                "{:.2g}, so its surface is inexact; lower its scale, or move the scene towards the "
                "origin",
                where, rounding, 1 / sigma);
        }
    }

    void checkCamera(Vec3d eye) {
        if (bounds_.empty()) return;
        const double rounding = largestCoordinate(eye) * doubleEpsilon,
                     size = length(bounds_.size());
        if (!(size >= resolved * rounding))
            add("the camera is at {}, where positions are rounded to {:.2g}, and all volumes "
                "together are {:.2g} wide: it cannot resolve them; move it nearer to {}",
                text(eye), rounding, size, text(bounds_.centre()));
    }

    void checkLight(const light::Light& light) {
        const light::LightTraits traits = light.traits();
        if (traits.position) checkLocalLight(traits.name, *traits.position, traits.intensity);
        if (std::string flaw = light.flaw(); !flaw.empty()) found_.push_back(std::move(flaw));
    }

    /// Rays end at local lights, so that only their light can be lost. `power` is per steradian.
    void checkLocalLight(const char* name, Vec3d p, double power) {
        if (bounds_.empty() || !(power > 0)) return;
        const double distance = length(p - max(bounds_.lower, min(bounds_.upper, p)));
        const double arrives = power / distance / distance;
        if (!isFinite(p) || arrives < smallestFloat)
            add("{} at {} is {:g} away from the volumes: only {:g} of its light arrives, below the "
                "smallest float, {:g}; move it nearer, make it brighter, or use a sun",
                name, text(p), distance, arrives, smallestFloat);
    }

    Box3d bounds_;
    std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> precisionWarnings(const Scene& scene) { return Findings(scene).take(); }

}  // namespace woodcock::render
