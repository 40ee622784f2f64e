// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {

template class tree::Tree<Int32Tree::RootNodeType>;
template class tree::Tree<Int64Tree::RootNodeType>;
template class tree::Tree<BoolTree::RootNodeType>;
template class tree::Tree<MaskTree::RootNodeType>;
template class Grid<Int32Tree>;
template class Grid<Int64Tree>;
template class Grid<BoolTree>;
template class Grid<MaskTree>;

}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb
