// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

/// OpenVDB with its trees declared as compiled elsewhere. Include this, never <openvdb/openvdb.h>:
/// a source file that instantiates the trees of all value types for itself takes a minute and a
/// half to compile, and twenty seconds with this.

namespace woodcock::grid {

/// The trees of OpenVDB 13's grids of half values, which older versions can hold as well, although
/// they know no such grids.
using HalfTree = openvdb::tree::Tree4<openvdb::math::half, 5, 4, 3>::Type;

}  // namespace woodcock::grid

namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {

// All in openvdb_trees_*.cpp. OpenVDB's own library holds what it did not inline, and no more.
extern template class tree::Tree<FloatTree::RootNodeType>;
extern template class tree::Tree<DoubleTree::RootNodeType>;
extern template class tree::Tree<Int32Tree::RootNodeType>;
extern template class tree::Tree<Int64Tree::RootNodeType>;
extern template class tree::Tree<BoolTree::RootNodeType>;
extern template class tree::Tree<MaskTree::RootNodeType>;
extern template class tree::Tree<Vec3STree::RootNodeType>;
extern template class tree::Tree<Vec3DTree::RootNodeType>;
extern template class tree::Tree<Vec3ITree::RootNodeType>;
extern template class Grid<FloatTree>;
extern template class Grid<DoubleTree>;
extern template class Grid<Int32Tree>;
extern template class Grid<Int64Tree>;
extern template class Grid<BoolTree>;
extern template class Grid<MaskTree>;
extern template class Grid<Vec3STree>;
extern template class Grid<Vec3DTree>;
extern template class Grid<Vec3ITree>;

// OpenVDB 13's.
extern template class tree::Tree<woodcock::grid::HalfTree::RootNodeType>;
extern template class Grid<woodcock::grid::HalfTree>;

}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb
