# SPDX-License-Identifier: Apache-2.0
"""Cycles' parameters in Woodcock's terms. Pure Python: needs no Blender.

Colours are lists of three. Sources: Cycles' kernel (`svm_node_principled_volume`,
`object_volume_density`), measured for each version where noted.
"""


def voxel_offset(version):
    """Voxels, along each index axis, by which a volume must be moved so that Cycles draws the value
    of index (i, j, k) where OpenVDB has it. Before 5.0 Cycles drew it in the middle of the cell from
    (i, j, k) to (i+1, j+1, k+1)."""
    return 0.0 if tuple(version) >= (5, 0, 0) else -0.5
