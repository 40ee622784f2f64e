# SPDX-License-Identifier: Apache-2.0
"""Lights: suns, points, spots and areas as Blender's own, spheres as meshes, environments as the
world."""
import os

import bpy
from mathutils import Matrix, Vector

import cycles_motion
from cycles_nodes import Nodes
from mapping import sun_share


def place(scene, name, data, matrix, motion=None, times=()):
    placed = bpy.data.objects.new(name, data)
    scene.collection.objects.link(placed)
    cycles_motion.place(placed, matrix, motion, times)
    return placed


def add_sun(scene, name, light):
    sun = bpy.data.lights.new(name, "SUN")
    sun.energy = light["strength"] / sun_share(bpy.app.version, light["angle"])
    sun.color = light["colour"]
    sun.angle = light["angle"]
    direction = Vector(light["direction"])
    place(scene, name, sun, direction.to_track_quat("-Z", "Y").to_matrix().to_4x4())


def add_point(scene, name, light):
    point = bpy.data.lights.new(name, "POINT")
    point.energy = light["power"]
    point.color = light["colour"]
    point.shadow_soft_size = 0.0
    if light["ies"]:
        nodes = Nodes(point)
        profile = nodes.add("ShaderNodeTexIES", {"mode": "EXTERNAL", "filepath": light["ies"]})
        emission = nodes.add("ShaderNodeEmission", Color=(1, 1, 1),
                             Strength=profile.outputs["Fac"])
        output = nodes.add("ShaderNodeOutputLight")
        nodes.tree.links.new(emission.outputs[0], output.inputs["Surface"])
    place(scene, name, point, Matrix(light["matrix"]))


def add_spot(scene, name, light):
    spot = bpy.data.lights.new(name, "SPOT")
    spot.energy = light["power"]
    spot.color = light["colour"]
    spot.shadow_soft_size = 0.0
    spot.spot_size = light["cone"]
    spot.spot_blend = light["blend"]
    direction = Vector(light["direction"])
    matrix = direction.to_track_quat("-Z", "Y").to_matrix().to_4x4()
    place(scene, name, spot, Matrix.Translation(light["position"]) @ matrix)


def add_area(scene, name, light):
    area = bpy.data.lights.new(name, "AREA")
    area.energy = light["power"]
    area.color = light["colour"]
    area.shape = light["shape"]
    area.size, area.size_y = light["size"]
    area.spread = light["spread"]
    place(scene, name, area, Matrix(light["matrix"])).visible_camera = light["visible"]


def add_sphere(scene, name, light, times):
    """Radiates outwards and lets other light pass, which Blender's lights with a radius do not in
    every version: before 4.0 they are discs that face whoever looks."""
    import bmesh

    mesh = bpy.data.meshes.new(name)
    shape = bmesh.new()
    bmesh.ops.create_icosphere(shape, subdivisions=4, radius=light["radius"])
    # The triangles' corners lie on the sphere: out to where their area is the sphere's.
    area = sum(face.calc_area() for face in shape.faces)
    grow = (4 * 3.141592653589793 * light["radius"] ** 2 / area) ** 0.5
    bmesh.ops.scale(shape, vec=(grow,) * 3, verts=shape.verts)
    shape.to_mesh(mesh)
    shape.free()
    material = bpy.data.materials.new(name)
    nodes = Nodes(material)
    outside = nodes.add("ShaderNodeMath", {"operation": "SUBTRACT"})
    outside.inputs[0].default_value = 1.0
    geometry = nodes.add("ShaderNodeNewGeometry")
    nodes.set(outside.inputs[1], geometry.outputs["Backfacing"])
    emission = nodes.add("ShaderNodeEmission", Color=light["colour"],
                         Strength=nodes.multiply(outside.outputs[0], light["strength"]))
    through = nodes.add("ShaderNodeBsdfTransparent", Color=(1, 1, 1))
    output = nodes.add("ShaderNodeOutputMaterial")
    nodes.tree.links.new(nodes.sum([emission.outputs[0], through.outputs[0]]),
                         output.inputs["Surface"])
    mesh.materials.append(material)
    placed = place(scene, name, mesh, Matrix.Translation(light["position"]),
                   [Matrix(m) for m in light["motion"] or ()], times)
    placed.visible_camera = light["visible"]
    placed.visible_shadow = False


def add_world(scene, environments, directory):
    """All environments in one world. Images without a full path lie in the directory."""
    world = bpy.data.worlds.new("world")
    scene.world = world
    nodes = Nodes(world)
    backgrounds = []
    for light in environments:
        colour = light["radiance"]
        strength = 1.0
        if light["image"]:
            image = bpy.data.images.load(os.path.join(directory, light["image"]))
            if not os.path.isabs(light["image"]):
                image.pack()  # the directory does not stay
            image.colorspace_settings.name = "Non-Color"  # numbers as they are
            direction = nodes.add("ShaderNodeTexCoord").outputs["Generated"]
            turned = nodes.add("ShaderNodeMapping", {"vector_type": "POINT"}, Vector=direction,
                               Rotation=Matrix(light["image_from_world"]).to_euler("XYZ"))
            texture = nodes.add("ShaderNodeTexEnvironment", {"image": image},
                                Vector=turned.outputs[0])
            colour = nodes.multiply_add(texture.outputs["Color"], colour, (0, 0, 0))
        if not light["visible"]:
            seen = nodes.add("ShaderNodeLightPath").outputs["Is Camera Ray"]
            hidden = nodes.add("ShaderNodeMath", {"operation": "SUBTRACT"})
            hidden.inputs[0].default_value = 1.0
            nodes.set(hidden.inputs[1], seen)
            strength = hidden.outputs[0]
        backgrounds.append(nodes.add("ShaderNodeBackground", Color=colour,
                                     Strength=strength).outputs[0])
    output = nodes.add("ShaderNodeOutputWorld")
    if backgrounds:
        nodes.tree.links.new(nodes.sum(backgrounds), output.inputs["Surface"])


def add(scene, lights, directory, times):
    kinds = {"sun": add_sun, "point": add_point, "spot": add_spot, "area": add_area}
    for i, light in enumerate(lights):
        if light["type"] == "sphere":
            add_sphere(scene, "light%d" % i, light, times)
        elif light["type"] in kinds:
            kinds[light["type"]](scene, "light%d" % i, light)
    add_world(scene, [light for light in lights if light["type"] == "environment"],
              directory)
