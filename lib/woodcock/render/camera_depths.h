// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>

#include "woodcock/camera/camera_rays.h"
#include "woodcock/render/scene.h"

namespace woodcock::render {

/// The densities of the scene's medium, integrated along rays of the camera: at the nodes of a
/// lattice whose lines are camera rays, a fixed number of pixels apart. Between lines they are
/// interpolated. So they are near the truth and no more: densities for sampling, and a control
/// variate.
///
/// Lines are made when they are first read. What they hold does not depend on who reads them when.
/// Shared by all threads.
class CameraDepths {
public:
    static constexpr std::size_t mostParts = 8;
    /// Null where the camera is inside of the medium's box or moves, where the medium has no end,
    /// moves, or has fields of several channels, and where the lattice would be too coarse to show
    /// what the medium is like. Null where lines lie farther apart than the picture is wide: then
    /// few rays share them, and the same error. Null in thick media, too: where a camera ray
    /// scatters decides little there. The scene must outlive it.
    static std::unique_ptr<const CameraDepths> make(const Scene& scene, int width, int height);
    ~CameraDepths();

    double bytesAtMost() const;  ///< once all lines are made

    double near() const { return near_; }        ///< distance of the first node of each line
    double spacing() const { return spacing_; }  ///< of nodes along a ray, in world units
    int steps() const { return steps_; }

    /// The four lines around a camera ray. Of each node they have as many numbers as the medium has
    /// parts: the integral of the part's density up to there.
    struct Ray {
        const float* lines[4];
        float weights[4];
        std::size_t parts;

        float density(int node, std::size_t part) const {
            const std::size_t i = static_cast<std::size_t>(node) * parts + part;
            return weights[0] * lines[0][i] + weights[1] * lines[1][i] + weights[2] * lines[2][i] +
                   weights[3] * lines[3][i];
        }
        /// By how much the lines differ.
        float spread(int node, std::size_t part) const;
    };
    /// Of a ray through a place of the picture, in pixels. Outside of the lattice, the nearest ray
    /// counts.
    Ray at(double x, double y) const;

private:
    CameraDepths(const Scene& scene, int width, int height);
    bool layOut();
    const float* line(int i, int j) const;
    const float* makeLine(std::size_t index) const;
    void fill(double x, double y, float* nodes) const;

    const Scene& scene_;
    const camera::CameraRays rays_;
    const int width_, height_;
    double x0_ = 0, y0_ = 0, step_ = 1;  ///< of the first line, and to the next one; pixels
    int across_ = 0, down_ = 0;          ///< lines
    double near_ = 0, spacing_ = 1;
    int steps_ = 0;
    std::unique_ptr<std::atomic<float*>[]> lines_;
    mutable std::array<std::mutex, 64> making_;
};

/// Memory that the lines of a render of the scene take at most, in bytes.
double bytesOfCameraDepths(const Scene& scene, int width, int height);

}  // namespace woodcock::render
