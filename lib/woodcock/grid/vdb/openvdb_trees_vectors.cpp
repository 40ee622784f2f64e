// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {

template class tree::Tree<Vec3STree::RootNodeType>;
template class tree::Tree<Vec3DTree::RootNodeType>;
template class tree::Tree<Vec3ITree::RootNodeType>;
template class Grid<Vec3STree>;
template class Grid<Vec3DTree>;
template class Grid<Vec3ITree>;

}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb
