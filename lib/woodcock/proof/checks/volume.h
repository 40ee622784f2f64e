// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "woodcock/base/random.h"
#include "woodcock/proof/oracles/vdb_voxels.h"
#include "woodcock/proof/proof.h"
#include "woodcock/render/scene.h"

namespace woodcock::proof {

/// A volume for the checks of properties: in the renderer's own form, and in OpenVDB's.
struct Volume {
    std::string name;
    std::shared_ptr<const grid::Field> field;
    Affine3d worldFromIndex;
    oracle::VdbVoxels voxels;
    std::vector<Vec3d> matter;  ///< world positions drawn in proportion to the density
    double sigma = 0;  ///< where the field is 1: lines through the matter are 5 deep in the mean

    bool endless() const { return voxels.background > 0; }
    Vec3d centre() const;
    double radius() const;  ///< of a sphere around the support
    /// With these coefficients in units of sigma.
    medium::MediumPart part(Rgb absorption, Rgb scattering, double g) const;
    /// Optical depth for sigma, by brute force through OpenVDB's own lookups.
    double opticalDepth(Vec3d origin, Vec3d direction, double t0, double t1) const;
};

enum class Endless { Too, Not };

/// The density grids of the lab's own volumes, and hostile ones.
std::vector<Volume> volumes(const Lab& lab, Endless endless);

/// Uniform on the sphere.
Vec3d anyDirection(RandomStream& random);

}  // namespace woodcock::proof
