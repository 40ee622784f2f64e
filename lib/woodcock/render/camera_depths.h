// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>

#include "woodcock/camera/camera_rays.h"
#include "woodcock/render/scene.h"

namespace woodcock::render {

/// The densities of the scene's medium, integrated along rays of the camera: at the nodes of a
/// lattice whose lines are camera rays, a fixed number of pixels apart, and one more in the middle
/// of each four. Between lines they are interpolated. So they are near the truth and no more:
/// densities for sampling, and a control variate.
///
/// Lines are made when they are first read. What they hold does not depend on who reads them when.
/// Shared by all threads.
class CameraDepths {
public:
    static constexpr std::size_t mostParts = 8;
    /// Null where the camera is inside of the medium's box or moves, where the medium has no end,
    /// moves, or has fields of several channels, and where the lattice would be too coarse to show
    /// what the medium is like. Null where lines lie farther apart than the picture is wide: then
    /// few rays share them, and the same error. Null in deep media, too: where a camera ray
    /// scatters decides little there. The scene must outlive it.
    static std::unique_ptr<const CameraDepths> make(const Scene& scene, int width, int height);
    ~CameraDepths();

    double bytesAtMost() const;  ///< once all lines are made

    double near() const { return near_; }        ///< distance of the first node of each line
    double spacing() const { return spacing_; }  ///< of nodes along a ray, in world units
    int steps() const { return steps_; }
    /// How often corrections of what the lines say must be made at least, as voxels may lie between
    /// lines unseen: more often where lines are farther apart.
    float rarestCorrection() const { return rarestCorrection_; }

    /// The lines around a camera ray: four, of which it lies nearest to the side between the first
    /// two, and the one in their middle. Of each node they have as many numbers as the medium has
    /// parts: the integral of the part's density up to there. A ray interpolates the first two and
    /// the middle.
    struct Ray {
        const float* lines[4];
        const float* middle;
        float weights[3];
        std::size_t parts;

        float density(int node, std::size_t part) const {
            const std::size_t i = static_cast<std::size_t>(node) * parts + part;
            return weights[0] * lines[0][i] + weights[1] * lines[1][i] + weights[2] * middle[i];
        }
        /// How wrong density() may be: by how much the mean of the four misses the one in their
        /// middle; and a little of how they differ, for what the middle does not see.
        float error(int node, std::size_t part) const {
            const std::size_t i = static_cast<std::size_t>(node) * parts + part;
            const float a = lines[0][i], b = lines[1][i], c = lines[2][i], d = lines[3][i];
            const auto [least, most] = std::minmax({a, b, c, d, middle[i]});
            return std::abs((a + b + c + d) / 4 - middle[i]) + (most - least) / 20;
        }
    };
    /// Of a ray through a place of the picture, in pixels. Outside of the lattice, the nearest ray
    /// counts.
    Ray at(double x, double y) const;

private:
    CameraDepths(const Scene& scene, int width, int height);
    bool layOut();
    std::size_t lineCount() const;
    const float* line(std::size_t index) const;
    const float* makeLine(std::size_t index) const;
    void fill(double x, double y, float* nodes) const;

    const Scene& scene_;
    const camera::CameraRays rays_;
    const int width_, height_;
    double x0_ = 0, y0_ = 0, step_ = 1;  ///< of the first line, and to the next one; pixels
    int across_ = 0, down_ = 0;          ///< lines, but for those in the middle of four
    double near_ = 0, spacing_ = 1;
    int steps_ = 0;
    float rarestCorrection_ = 1;
    std::unique_ptr<std::atomic<float*>[]> lines_;
    mutable std::array<std::mutex, 64> making_;
};

/// Memory that the lines of a render of the scene take at most, in bytes.
double bytesOfCameraDepths(const Scene& scene, int width, int height);

}  // namespace woodcock::render
