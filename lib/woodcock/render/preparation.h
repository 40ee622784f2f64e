// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "woodcock/render/approximate_media.h"
#include "woodcock/render/approximations.h"
#include "woodcock/render/camera_depths.h"
#include "woodcock/render/light_depths.h"
#include "woodcock/render/radiance_lattice.h"
#include "woodcock/render/scene.h"
#include "woodcock/render/session.h"

namespace woodcock::render {

/// What a render makes for itself beside its samples: the media of approximations, a
/// lattice of the radiance inside, and grids of optical depths, which are filled where paths first
/// ask. Renders of one scene that differ in seed, samples or crop may share it. What it holds does
/// not depend on who fills it. The scene must outlive it.
class Preparation {
public:
    Preparation(const Scene& scene, int width, int height, const Approximations& approximations);

    /// Whether it is what such a render would make.
    bool fits(const Scene& scene, int width, int height,
              const Approximations& approximations) const;

    /// Fills all grids now, so that no render has to. Ends early where `goOn` returns false.
    void fill(int threads, const std::function<bool()>& goOn) const;

    const ApproximateMedia& approximateMedia() const { return approximateMedia_; }
    const LightDepths& lightDepths() const { return lightDepths_; }
    /// Null: camera rays are walked.
    const CameraDepths* cameraDepths() const { return cameraDepths_.get(); }
    /// Null: nothing is known of it.
    const RadianceLattice* radianceLattice() const { return radianceLattice_.get(); }

private:
    void fillLightDepths(const std::function<bool()>& goOn) const;
    void fillCameraDepths(const std::function<bool()>& goOn) const;

    const Scene& scene_;
    const int width_, height_;
    const Approximations approximations_;
    const ApproximateMedia approximateMedia_;
    const LightDepths lightDepths_;
    const std::unique_ptr<const CameraDepths> cameraDepths_;
    const std::unique_ptr<const RadianceLattice> radianceLattice_;
};

/// As render(), but spared what `prepared` holds. That has no effect where it is null or does not
/// fit.
RenderResult renderPrepared(const Scene& scene, const RenderSettings& settings,
                            std::shared_ptr<const Preparation> prepared,
                            const std::function<bool(const RenderProgress&)>& onProgress = {},
                            Checkpoints checkpoints = {});

}  // namespace woodcock::render
