# SPDX-License-Identifier: Apache-2.0
"""What Blender makes of a VDB file: blender -b --python blender_volume.py -- FILE GRID

Prints a line of JSON: the grid's matrix (rows), the corners of the object's box, and the values of
the grid's active voxels on a coarse lattice, by the OpenVDB that comes with Blender.
"""
import json
import sys

import bpy
import pyopenvdb

path, name = sys.argv[sys.argv.index("--") + 1 :][:2]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.object.volume_import(filepath=path)
volume = bpy.context.object
volume.rotation_euler = (0, 0, 0)
assert volume.data.grids.load(), volume.data.grids.error_message
grid = volume.data.grids[name]
grid.load()
bpy.context.view_layer.update()
evaluated = volume.evaluated_get(bpy.context.evaluated_depsgraph_get())
voxels = pyopenvdb.read(path, name)
accessor = voxels.getConstAccessor()
low, high = voxels.evalActiveVoxelBoundingBox()
step = max(1, (high[0] - low[0]) // 12)
values = [
    [x, y, z, accessor.getValue((x, y, z))]
    for x in range(low[0], high[0] + 1, step)
    for y in range(low[1], high[1] + 1, step)
    for z in range(low[2], high[2] + 1, step)
]
print(
    "VOLUME "
    + json.dumps(
        {
            "type": grid.data_type,
            "matrix": [list(row) for row in grid.matrix_object],
            "box": [list(corner) for corner in evaluated.bound_box],
            "active": voxels.activeVoxelCount(),
            "values": values,
        }
    )
)
