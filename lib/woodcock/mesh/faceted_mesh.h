// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "woodcock/mesh/surface_mesh.h"

namespace woodcock::mesh {

/// A ring of facets around the y axis, as gem cutters describe them.
struct FacetRing {
    double angle = 0;  ///< of the facets' outward normal from +y, degrees: 0 a table, 180 a culet
    int count = 1;     ///< evenly around the axis
    double distance = 1;  ///< of their planes from the origin; > 0
    double turn = 0;      ///< of the first normal about y from +z towards +x, degrees
    bool operator==(const FacetRing&) const = default;
};

/// The convex body behind all facets: flat faces, closed, facing outwards. Errors: Usage on numbers
/// out of range, and where the facets leave it open.
SurfaceMesh facetedMesh(std::span<const FacetRing> rings);

}  // namespace woodcock::mesh
