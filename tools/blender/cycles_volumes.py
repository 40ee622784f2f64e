# SPDX-License-Identifier: Apache-2.0
"""Volumes: grids of VDB files, and meshes that are filled evenly."""
import bpy
from mathutils import Matrix, Vector

import cycles_motion
from cycles_nodes import Nodes, Refused
from mapping import voxel_offset


def phase_of(description):
    """Settings and sockets of a node that scatters, for its phase function."""
    phase = description["phase"]
    inputs = {name.replace(" ", "_"): value for name, value in phase["inputs"].items()}
    if not phase["type"]:
        return {}, inputs
    if bpy.app.version < (4, 3, 0):
        raise Refused("Blender %s has no phase function %s; 4.3 is the first that has others than "
                      "Henyey-Greenstein" % (bpy.app.version_string, phase["type"]))
    return {"phase": phase["type"]}, inputs


def coefficients(nodes, description, density=None, albedo=None):
    """Sockets of shaders that scatter and absorb, by Volume Coefficients: sigma_s and sigma_a as
    they are. The sockets `density` (a number, or a colour) and `albedo` multiply them."""
    if not (description["scatters"] or description["absorbs"]):
        return []
    sigma_s = description["sigma_s"]
    sigma_a = description["sigma_a"]
    if albedo is not None:
        # What an albedo's grid takes from scattering is absorbed.
        sigma_a = nodes.multiply_add(albedo, [-s for s in sigma_s],
                                     [s + a for s, a in zip(sigma_s, sigma_a)])
        sigma_s = nodes.multiply_add(albedo, sigma_s, (0, 0, 0))
    if density is not None:
        sigma_s = nodes.multiply_add(density, sigma_s, (0, 0, 0))
        sigma_a = nodes.multiply_add(density, sigma_a, (0, 0, 0))
    settings, inputs = phase_of(description)
    return [nodes.add("ShaderNodeVolumeCoefficients", settings, Scatter_Coefficients=sigma_s,
                      Absorption_Coefficients=sigma_a, **inputs).outputs[0]]


def scatter_absorption(nodes, description, density=None, albedo=None):
    """The same by Volume Scatter and Volume Absorption: sigma_s = density x scatter_colour,
    sigma_a = density x (1 - absorb_colour)."""
    amount = description["density"]
    scatter_colour = description["scatter_colour"]
    absorb_colour = description["absorb_colour"]
    if density is not None and density.type == "VALUE":
        amount = nodes.multiply(density, amount)
    elif density is not None:
        scatter_colour = nodes.multiply_add(density, scatter_colour, (0, 0, 0))
        absorb_colour = nodes.multiply_add(density, [a - 1 for a in absorb_colour], (1, 1, 1))
    if albedo is not None:
        # What an albedo's grid takes from scattering is absorbed.
        scatter_colour = nodes.multiply_add(albedo, description["scatter_colour"], (0, 0, 0))
        absorb_colour = nodes.multiply_add(
            albedo, description["scatter_colour"],
            [a - s for a, s in zip(description["absorb_colour"], description["scatter_colour"])])
    parts = []
    if description["scatters"]:
        settings, inputs = phase_of(description)
        parts.append(nodes.add("ShaderNodeVolumeScatter", settings, Color=scatter_colour,
                               Density=amount, **inputs).outputs[0])
    if description["absorbs"]:
        parts.append(nodes.add("ShaderNodeVolumeAbsorption", Color=absorb_colour,
                               Density=amount).outputs[0])
    return parts


def medium(nodes, description, density=None, albedo=None):
    """By the node that takes coefficients as they are, where there is one: from 4.5 on."""
    known = hasattr(bpy.types, "ShaderNodeVolumeCoefficients")
    make = coefficients if known else scatter_absorption
    return make(nodes, description, density, albedo)


def glow(nodes, description, grids=None):
    """Sockets of shaders that emit."""
    parts = []
    emission = description["emission"]
    if emission:
        colour = emission["colour"]
        if emission["grid"]:
            grid = grids.socket(nodes, emission["grid"], "Color")
            colour = nodes.multiply_add(grid, colour, (0, 0, 0))
        parts.append(nodes.add("ShaderNodeEmission", Color=colour,
                               Strength=emission["strength"]).outputs[0])
    blackbody = description.get("blackbody")
    if blackbody:
        grids.check(blackbody["grid"])
        parts.append(nodes.add("ShaderNodeVolumePrincipled", Density=0.0, Density_Attribute="",
                               Temperature_Attribute=blackbody["grid"],
                               Temperature=blackbody["temperature"],
                               Blackbody_Intensity=blackbody["intensity"],
                               Blackbody_Tint=blackbody["tint"]).outputs[0])
    return parts


def fill(nodes, output, parts):
    if parts:
        nodes.tree.links.new(nodes.sum(parts), output.inputs["Volume"])


class Grids:
    """Those of a volume, each interpolated in this way where Cycles leaves a choice."""

    def __init__(self, volume, interpolation):
        self.volume = volume
        self.interpolation = interpolation

    def check(self, name):
        found = [grid.name for grid in self.volume.grids].count(name)
        if found != 1:
            raise Refused("Blender finds %d grids named '%s' in %s, not one"
                          % (found, name, self.volume.filepath))

    def socket(self, nodes, name, output):
        self.check(name)
        read = nodes.add("ShaderNodeAttribute", {"attribute_name": name}).outputs[output]
        if self.interpolation == "stochastic" or not can_be_stochastic():
            return read
        # Cycles reads one voxel alone only where what follows is linear.
        same = nodes.add("ShaderNodeVectorMath", {"operation": "MAXIMUM"})
        nodes.set(same.inputs[0], read)
        nodes.set(same.inputs[1], (0.0, 0.0, 0.0))
        return same.outputs[0]


def can_be_stochastic():
    return bpy.app.version >= (5, 0, 0)


def chosen_interpolation(word):
    if word == "stochastic" and not can_be_stochastic():
        raise Refused("Blender %s reads all eight voxels around a point; 5.0 is the first that "
                      "reads one at random" % bpy.app.version_string)
    return word or ("stochastic" if can_be_stochastic() else "trilinear")


def check_alike(description):
    """Before 5.0, both grids are moved by half of the density's voxel."""
    both = [description[key] for key in ("object_from_index", "albedo_from_index")]
    voxels = [[row[:3] for row in matrix[:3]] for matrix in both]
    if voxel_offset(bpy.app.version) and voxels[0] != voxels[1]:
        raise Refused("Blender %s draws the grids '%s' and '%s' aside, as their voxels differ; "
                      "5.0 does not" % (bpy.app.version_string, description["grid"],
                                        description["albedo_grid"]))


def move(volume, velocity):
    """Cycles finds velocities by their name, also where it should not."""
    if not velocity:
        volume.velocity_grid = "no such grid"
        volume.velocity_scale = 0.0
        return
    volume.velocity_grid = velocity["grid"]  # or what three are named after
    volume.velocity_unit = "SECOND"
    volume.velocity_scale = velocity["scale"]


def add_grid(scene, name, description, interpolation, times):
    volume = bpy.data.volumes.new(name)
    volume.filepath = description["file"]
    if not volume.grids.load():
        raise Refused("Blender cannot load %s: %s" % (volume.filepath, volume.grids.error_message))
    volume.render.precision = "FULL"
    volume.render.clipping = 0.0
    volume.render.space = "WORLD"  # densities as they are, whatever the object's scale
    move(volume, description["velocity"])
    material = bpy.data.materials.new(name)
    nodes = Nodes(material)
    output = nodes.add("ShaderNodeOutputMaterial")
    grids = Grids(volume, interpolation)
    density = None
    if description["grid"]:
        density = grids.socket(nodes, description["grid"],
                               "Color" if description["colour"] else "Fac")
    albedo = description["albedo_grid"]
    if albedo:
        if description["colour"]:
            raise Refused("the density grid '%s' is of colours, and so is '%s'"
                          % (description["grid"], albedo))
        albedo = grids.socket(nodes, albedo, "Color")
        check_alike(description)
    fill(nodes, output,
         medium(nodes, description, density, albedo) + glow(nodes, description, grids))
    volume.materials.append(material)
    placed = bpy.data.objects.new(name, volume)
    voxel = Matrix(description["object_from_index"]).to_3x3()
    offset = Matrix.Translation(voxel @ Vector((voxel_offset(bpy.app.version),) * 3))
    scene.collection.objects.link(placed)
    cycles_motion.place(placed, Matrix(description["matrix"]) @ offset,
                        [Matrix(m) @ offset for m in description["motion"] or ()], times)


def add_box(scene, name, description, times):
    low, high = description["box"]
    corners = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1])
               for z in (low[2], high[2])]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    material = bpy.data.materials.new(name)
    nodes = Nodes(material)
    output = nodes.add("ShaderNodeOutputMaterial")
    fill(nodes, output, medium(nodes, description) + glow(nodes, description))
    mesh.materials.append(material)
    placed = bpy.data.objects.new(name, mesh)
    scene.collection.objects.link(placed)
    cycles_motion.place(placed, Matrix(description["matrix"]),
                        [Matrix(m) for m in description["motion"] or ()], times)


def add(scene, name, description, interpolation, times):
    if "box" in description:
        add_box(scene, name, description, times)
    else:
        add_grid(scene, name, description, interpolation, times)
