// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {

template class tree::Tree<FloatTree::RootNodeType>;
template class tree::Tree<DoubleTree::RootNodeType>;
template class tree::Tree<woodcock::grid::HalfTree::RootNodeType>;
template class Grid<FloatTree>;
template class Grid<DoubleTree>;
template class Grid<woodcock::grid::HalfTree>;

}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb
