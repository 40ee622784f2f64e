# SPDX-License-Identifier: Apache-2.0
"""Surfaces: meshes, their materials and what they hold."""
import os

import bpy
import numpy
from mathutils import Matrix

import cycles_motion
import cycles_volumes
from cycles_nodes import Nodes, Refused


def read_mesh(name, file):
    data = numpy.fromfile(file, dtype=numpy.uint8)
    points, triangles, normals, uvs = (int(n) for n in data[:16].view(numpy.uint32))
    at = 16

    def take(count, kind):
        nonlocal at
        taken = data[at:at + 4 * count].view(kind)
        at += 4 * count
        return taken

    coordinates = take(3 * points, numpy.float32)
    corners = take(3 * triangles, numpy.uint32)
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(coordinates.reshape(-1, 3).tolist(), [], corners.reshape(-1, 3).tolist())
    smooth = take(9 * normals, numpy.float32).reshape(-1, 3)
    places = take(6 * uvs, numpy.float32)
    if uvs:
        mesh.uv_layers.new().data.foreach_set("uv", places)
    mesh.polygons.foreach_set("use_smooth", [bool(normals)] * triangles)
    if normals:
        if hasattr(mesh, "use_auto_smooth"):  # before 4.1
            mesh.use_auto_smooth = True
        mesh.normals_split_custom_set(smooth.tolist())
    mesh.update()
    return mesh


def texture(nodes, description):
    """A colour, or the socket of one."""
    if not description["image"]:
        return description["colour"]
    image = bpy.data.images.load(description["image"])
    if description["data"]:
        image.colorspace_settings.name = "Non-Color"
    node = nodes.add("ShaderNodeTexImage", {"image": image})
    return nodes.multiply_add(node.outputs["Color"], description["colour"], (0, 0, 0))


def diffuse(nodes, m):
    return nodes.add("ShaderNodeBsdfDiffuse", Color=texture(nodes, m["colour"])).outputs[0]


def mirror(nodes, colour):
    """Schlick's reflectance, c + (1 - c) (1 - cos)^5, of a surface without roughness."""
    def math(operation, a, b):
        node = nodes.add("ShaderNodeMath", {"operation": operation})
        nodes.set(node.inputs[0], a)
        nodes.set(node.inputs[1], b)
        return node.outputs[0]

    geometry = nodes.add("ShaderNodeNewGeometry")
    dot = nodes.add("ShaderNodeVectorMath", {"operation": "DOT_PRODUCT"})
    nodes.set(dot.inputs[0], geometry.outputs["Normal"])
    nodes.set(dot.inputs[1], geometry.outputs["Incoming"])
    power = math("POWER", math("SUBTRACT", 1.0, dot.outputs["Value"]), 5.0)
    rest = math("SUBTRACT", 1.0, power)
    grown = nodes.add("ShaderNodeVectorMath", {"operation": "SCALE"})
    nodes.set(grown.inputs[0], colour)
    nodes.set(grown.inputs["Scale"], rest)
    total = nodes.add("ShaderNodeVectorMath", {"operation": "ADD"})
    nodes.set(total.inputs[0], grown.outputs[0])
    nodes.set(total.inputs[1], power)
    return nodes.add("ShaderNodeBsdfGlossy", {"distribution": "GGX"}, Color=total.outputs[0],
                     Roughness=0.0).outputs[0]


def facets(m):
    """Those that lose no light between them, as Woodcock's."""
    return "MULTI_GGX" if m["roughness"] > 0 else "GGX"


def conductor(nodes, m):
    if not m["eta"] and m["roughness"] == 0:
        return mirror(nodes, texture(nodes, m["colour"]))
    if not hasattr(bpy.types, "ShaderNodeBsdfMetallic"):
        raise Refused("Blender %s has no metal of %s; 4.3 is the first that has"
                      % (bpy.app.version_string,
                         "eta and k" if m["eta"] else "Schlick's reflectance with roughness"))
    if m["eta"]:
        settings = {"distribution": facets(m), "fresnel_type": "PHYSICAL_CONDUCTOR"}
        return nodes.add("ShaderNodeBsdfMetallic", settings, IOR=m["eta"], Extinction=m["k"],
                         Roughness=m["roughness"]).outputs[0]
    settings = {"distribution": facets(m), "fresnel_type": "F82"}
    return nodes.add("ShaderNodeBsdfMetallic", settings, Base_Color=texture(nodes, m["colour"]),
                     Edge_Tint=(1, 1, 1), Roughness=m["roughness"]).outputs[0]


def dielectric(nodes, m):
    return nodes.add("ShaderNodeBsdfGlass", {"distribution": facets(m)}, Color=(1, 1, 1),
                     Roughness=m["roughness"], IOR=m["ior"]).outputs[0]


def interface(nodes, m):
    return nodes.add("ShaderNodeBsdfTransparent", Color=(1, 1, 1)).outputs[0]


def emissive(nodes, m):
    strength = 1.0
    if not m["both_sides"]:
        node = nodes.add("ShaderNodeMath", {"operation": "SUBTRACT"})
        node.inputs[0].default_value = 1.0
        nodes.set(node.inputs[1], nodes.add("ShaderNodeNewGeometry").outputs["Backfacing"])
        strength = node.outputs[0]
    return nodes.add("ShaderNodeEmission", Color=texture(nodes, m["radiance"]),
                     Strength=strength).outputs[0]


def mix(nodes, m):
    weight = texture(nodes, m["weight"])
    node = nodes.add("ShaderNodeMixShader")
    nodes.set(node.inputs[0], weight if isinstance(weight, bpy.types.NodeSocket)
              else sum(weight) / 3)
    nodes.set(node.inputs[1], shader(nodes, m["first"]))
    nodes.set(node.inputs[2], shader(nodes, m["second"]))
    return node.outputs[0]


SHADERS = {"diffuse": diffuse, "conductor": conductor, "dielectric": dielectric,
           "interface": interface, "emissive": emissive, "mix": mix}


def shader(nodes, description):
    return SHADERS[description["type"]](nodes, description)


def add(scene, name, description, directory, times):
    mesh = read_mesh(name, os.path.join(directory, name + ".mesh"))
    material = bpy.data.materials.new(name)
    nodes = Nodes(material)
    output = nodes.add("ShaderNodeOutputMaterial")
    if description["material"]["type"] != "interface":
        nodes.tree.links.new(shader(nodes, description["material"]), output.inputs["Surface"])
    if description["medium"]:
        held = description["medium"]
        cycles_volumes.fill(nodes, output, cycles_volumes.medium(nodes, held)
                            + cycles_volumes.glow(nodes, held))
    mesh.materials.append(material)
    for matrix, motion in zip(description["instances"], description["motion"]):
        placed = bpy.data.objects.new(name, mesh)
        placed.visible_camera = description["camera_visible"]
        scene.collection.objects.link(placed)
        cycles_motion.place(placed, Matrix(matrix), [Matrix(m) for m in motion or ()], times)
