// SPDX-License-Identifier: Apache-2.0
// OpenVDB AX as a node: code that runs over the voxels of other nodes' grids.

#include <cmath>

#include "woodcock/bake/ax_expression.h"
#include "woodcock/bake/grid_node.h"
#include "woodcock/bake/node_reader.h"
#include "woodcock/bake/openvdb_field.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_transform.h"
#include "woodcock/grid/vdb/openvdb_trees.h"
#include "woodcock/grid/voxel_scan.h"

namespace woodcock::bake {

namespace {

bool isFinite(float v) { return std::isfinite(v); }
bool isFinite(const openvdb::Vec3s& v) { return openvdb::math::isFinite(v); }

/// Throws when the code gave values that no grid should hold.
template <class Grid>
void checkFinite(const Grid& grid, const std::string& place) {
    grid::VoxelCount faulty;
    for (auto v = grid.cbeginValueOn(); v; ++v) {
        if (isFinite(*v)) continue;
        const openvdb::Coord at = v.getCoord();
        faulty.add({at.x(), at.y(), at.z()}, v.getVoxelCount());
    }
    if (faulty.count == 0) return;
    throw inputError("{}: the code makes '{}' not finite at {} voxels, first at [{}, {}, {}]",
                     place, grid.getName(), faulty.count, faulty.first.x, faulty.first.y,
                     faulty.first.z);
}

class AxStage : public GridStage {
public:
    AxStage(const std::string& code, const std::string& place, std::vector<std::string> names,
            std::size_t result)
        : expression_(code, place), place_(place), names_(std::move(names)), result_(result) {}

    std::vector<std::string> gridNames() const override { return names_; }
    std::shared_ptr<const Node> run(grid::VdbGrids& inputs,
                                    const std::function<bool()>& goesOn) const override {
        if (!expression_.run(inputs, goesOn)) return nullptr;
        const openvdb::GridBase& grid = *inputs.grids[result_];
        if (const auto* scalars = dynamic_cast<const openvdb::FloatGrid*>(&grid))
            checkFinite(*scalars, place_);
        else
            checkFinite(dynamic_cast<const openvdb::Vec3SGrid&>(grid), place_);
        return gridNode(fieldOf(grid), grid::affineOf(*grid.transform().baseMap()));
    }

private:
    AxExpression expression_;
    std::string place_;
    std::vector<std::string> names_;
    std::size_t result_;
};

/// The code changes `input`, which is @density or has another `name`, where it is not zero. It may
/// read and change the nodes of `with` there, by their keys.
Graph::Entry ax(NodeReader& r) {
    std::vector<std::string> names{r.has("name") ? r.text("name", "name = \"density\"")
                                                 : "density"};
    std::vector<int> channels{r.input("input", 0)};
    for (const auto& [name, inputChannels] : r.namedInputs("with")) {
        if (name == names.front()) throw r.table().error("has two inputs named '{}'", name);
        names.push_back(name);
        channels.push_back(inputChannels);
    }
    const std::size_t result = r.choice("result", names, 0);
    const std::string code = r.text("code", "code = \"@density *= 2;\"");
    Graph::Entry entry;
    entry.stage = std::make_shared<AxStage>(code, r.placeOf("code"), names, result);
    entry.channels = channels[result];
    return entry;
}

constexpr NodeType axTypes[]{{"ax", ax}};

}  // namespace

std::span<const NodeType> axNodes() { return axTypes; }

}  // namespace woodcock::bake
