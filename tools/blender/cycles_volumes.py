# SPDX-License-Identifier: Apache-2.0
"""Volumes: grids of VDB files, and meshes that are filled evenly."""
import bpy
from mathutils import Matrix, Vector

from cycles_nodes import Nodes, Refused
from mapping import voxel_offset


def medium(nodes, description, density=None, albedo=None):
    """Sockets of shaders that scatter and absorb: sigma_s = density x scatter_colour,
    sigma_a = density x (1 - absorb_colour). The sockets `density` and `albedo` multiply the
    description's own numbers."""
    amount = description["density"]
    if density is not None:
        amount = nodes.multiply(density, amount)
    scatter_colour = description["scatter_colour"]
    absorb_colour = description["absorb_colour"]
    if albedo is not None:
        # What an albedo's grid takes from scattering is absorbed.
        scatter_colour = nodes.multiply_add(albedo, description["scatter_colour"], (0, 0, 0))
        absorb_colour = nodes.multiply_add(
            albedo, description["scatter_colour"],
            [a - s for a, s in zip(description["absorb_colour"], description["scatter_colour"])])
    parts = []
    if description["scatters"]:
        parts.append(nodes.add("ShaderNodeVolumeScatter", Color=scatter_colour, Density=amount,
                               Anisotropy=description["g"]).outputs[0])
    if description["absorbs"]:
        parts.append(nodes.add("ShaderNodeVolumeAbsorption", Color=absorb_colour,
                               Density=amount).outputs[0])
    return parts


def fill(nodes, output, parts):
    if parts:
        nodes.tree.links.new(nodes.sum(parts), output.inputs["Volume"])


def grid_socket(nodes, volume, name, output):
    found = [grid.name for grid in volume.grids].count(name)
    if found != 1:
        raise Refused("Blender finds %d grids named '%s' in %s, not one"
                      % (found, name, volume.filepath))
    return nodes.add("ShaderNodeAttribute", {"attribute_name": name}).outputs[output]


def add_grid(scene, name, description):
    volume = bpy.data.volumes.new(name)
    volume.filepath = description["file"]
    if not volume.grids.load():
        raise Refused("Blender cannot load %s: %s" % (volume.filepath, volume.grids.error_message))
    volume.render.precision = "FULL"
    volume.render.clipping = 0.0
    volume.render.space = "WORLD"  # densities as they are, whatever the object's scale
    material = bpy.data.materials.new(name)
    nodes = Nodes(material)
    output = nodes.add("ShaderNodeOutputMaterial")
    density = grid_socket(nodes, volume, description["grid"], "Fac")
    albedo = description["albedo_grid"]
    if albedo:
        albedo = grid_socket(nodes, volume, albedo, "Color")
    fill(nodes, output, medium(nodes, description, density, albedo))
    volume.materials.append(material)
    placed = bpy.data.objects.new(name, volume)
    voxel = Matrix(description["object_from_index"]).to_3x3()
    offset = voxel @ Vector((voxel_offset(bpy.app.version),) * 3)
    placed.matrix_world = Matrix(description["matrix"]) @ Matrix.Translation(offset)
    scene.collection.objects.link(placed)


def add_box(scene, name, description):
    low, high = description["box"]
    corners = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1])
               for z in (low[2], high[2])]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    material = bpy.data.materials.new(name)
    nodes = Nodes(material)
    output = nodes.add("ShaderNodeOutputMaterial")
    fill(nodes, output, medium(nodes, description))
    mesh.materials.append(material)
    placed = bpy.data.objects.new(name, mesh)
    placed.matrix_world = Matrix(description["matrix"])
    scene.collection.objects.link(placed)


def add(scene, name, description):
    (add_box if "box" in description else add_grid)(scene, name, description)
