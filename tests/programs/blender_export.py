# SPDX-License-Identifier: Apache-2.0
"""Makes a scene in Blender, exports it and renders it with Cycles:

blender -b -P blender_export.py -- ADD_ON'S_PARENT DIRECTORY, which holds ball.vdb. Writes scene.toml
and cycles.exr there, and prints what could not be translated.
"""
import os
import sys

parent, directory = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else sys.argv[1:]
sys.path.insert(0, parent)

import bpy  # before bmesh, where it is a Python's module

import bmesh
import woodcock_addon
from woodcock_addon.render_process import RenderProcess

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.engine = "CYCLES"


def place(name, data, **where):
    placed = bpy.data.objects.new(name, data)
    scene.collection.objects.link(placed)
    for key, value in where.items():
        setattr(placed, key, value)
    return placed


def material(name, kind, output, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    made.node_tree.nodes.clear()
    shader = made.node_tree.nodes.new(kind)
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    end = made.node_tree.nodes.new("ShaderNodeOutputMaterial")
    made.node_tree.links.new(shader.outputs[0], end.inputs[output])
    return made, shader


def mesh(name, make, made, **where):
    data = bpy.data.meshes.new(name)
    shape = bmesh.new()
    make(shape)
    shape.to_mesh(data)
    shape.free()
    data.materials.append(made)
    place(name, data, **where)


smoke = bpy.data.volumes.new("smoke")
smoke.filepath = os.path.join(directory, "ball.vdb")
smoke.render.clipping = 0
made, shader = material("smoke", "ShaderNodeVolumePrincipled", "Volume",
                        Color=(0.8, 0.8, 0.8, 1), Anisotropy=0.2, Density_Attribute="")
grid = made.node_tree.nodes.new("ShaderNodeAttribute")
grid.attribute_name = "density"
times = made.node_tree.nodes.new("ShaderNodeMath")
times.operation = "MULTIPLY"
times.inputs[1].default_value = 6
made.node_tree.links.new(grid.outputs["Fac"], times.inputs[0])
made.node_tree.links.new(times.outputs[0], shader.inputs["Density"])
flame = made.node_tree.nodes.new("ShaderNodeAttribute")
flame.attribute_name = "flame"
made.node_tree.links.new(flame.outputs["Fac"], shader.inputs["Emission Strength"])
shader.inputs["Emission Color"].default_value = (0.1, 0.2, 0.4, 1)
shader.inputs["Blackbody Intensity"].default_value = 0.3
shader.inputs["Temperature"].default_value = 1500
smoke.materials.append(made)
place("smoke", smoke, scale=(0.5, 0.4, 0.3), rotation_euler=(0.3, 0.2, 0.5), location=(0.1, 0, 0.2))

if hasattr(bpy.types, "ShaderNodeVolumeCoefficients"):  # from 4.5 on
    mist = bpy.data.volumes.new("mist")
    mist.filepath = smoke.filepath
    mist.render.clipping = 0
    made, shader = material("mist", "ShaderNodeVolumeCoefficients", "Volume", Anisotropy=-0.3)
    shader.phase = "DRAINE"
    shader.inputs["Alpha"].default_value = 3  # a socket that is there from now on
    print("MIST")
    grid = made.node_tree.nodes.new("ShaderNodeAttribute")
    grid.attribute_name = "density"
    for name, amount in (("Scatter", (4, 2, 1)), ("Absorption", (0.5, 1, 2)),
                         ("Emission", (0.2, 0.4, 0.1))):
        times = made.node_tree.nodes.new("ShaderNodeVectorMath")
        times.operation = "MULTIPLY"
        times.inputs[1].default_value = amount
        made.node_tree.links.new(grid.outputs["Fac"], times.inputs[0])
        made.node_tree.links.new(times.outputs[0], shader.inputs[name + " Coefficients"])
    mist.materials.append(made)
    place("mist", mist, scale=(0.4, 0.5, 0.2), rotation_euler=(0.2, 0.4, 0), location=(-0.8, 0.5, 0))

floor = material("floor", "ShaderNodeBsdfDiffuse", "Surface", Color=(0.7, 0.4, 0.3, 1))[0]
mesh("floor", lambda shape: bmesh.ops.create_grid(shape, x_segments=2, y_segments=2, size=4), floor,
     location=(0, 0, -0.8))
lantern = material("lantern", "ShaderNodeEmission", "Volume", Color=(0.3, 0.2, 0.1, 1),
                   Strength=2)[0]
mesh("lantern", lambda shape: bmesh.ops.create_cube(shape, size=0.4), lantern,
     location=(0.8, -0.6, -0.3), rotation_euler=(0.2, 0.3, 0.4))
gas = material("gas", "ShaderNodeVolumePrincipled", "Volume", Density=0.0,
               Blackbody_Intensity=1.0)[0]
mesh("gas", lambda shape: bmesh.ops.create_cube(shape, size=0.4), gas, location=(0, 50, 0))
toon = material("toon", "ShaderNodeBsdfToon", "Surface")[0]
mesh("odd", lambda shape: bmesh.ops.create_cube(shape, size=1), toon, location=(0, 50, 0))

sun = bpy.data.lights.new("sun", "SUN")
sun.energy, sun.color, sun.angle = 3, (1, 0.9, 0.7), 0.1
place("sun", sun, rotation_euler=(0.7, 0.2, 0.4))
light = bpy.data.lights.new("light", "POINT")
light.energy, light.shadow_soft_size = 200, 0
place("light", light, location=(2, -1, 2.5))
spot = bpy.data.lights.new("spot", "SPOT")
spot.energy, spot.shadow_soft_size, spot.spot_size, spot.spot_blend = 300, 0, 0.6, 0.4
place("spot", spot, location=(-2, -1, 2.5), rotation_euler=(0.3, -0.6, 0))
area = bpy.data.lights.new("area", "AREA")
area.energy, area.shape, area.size, area.size_y, area.spread = 60, "ELLIPSE", 1.2, 0.5, 2
place("area", area, location=(0, 2, 1.5), rotation_euler=(-0.8, 0, 0.3))
world = bpy.data.worlds.new("world")
world.use_nodes = True
world.node_tree.nodes["Background"].inputs[0].default_value = (0.2, 0.3, 0.5, 1)
scene.world = world

camera = bpy.data.cameras.new("camera")
camera.lens, camera.shift_x, camera.shift_y = 55, 0.1, -0.05
scene.camera = place("camera", camera, location=(5, -6, 4), rotation_euler=(1.1, 0, 0.69))
render, cycles = scene.render, scene.cycles
render.resolution_x, render.resolution_y, render.resolution_percentage = 96, 64, 50
cycles.samples = 256
cycles.use_adaptive_sampling = cycles.use_denoising = False
cycles.max_bounces = cycles.volume_bounces = cycles.diffuse_bounces = 64
cycles.sample_clamp_indirect = cycles.light_sampling_threshold = 0
cycles.pixel_filter_type, cycles.filter_width = "BOX", 1
cycles.volume_step_rate, cycles.volume_max_steps = 0.5, 4096

target = os.path.join(directory, "scene.toml")
woodcock_addon.register()
bpy.ops.export_scene.woodcock(filepath=target)
woodcock_addon.unregister()
render.image_settings.file_format = "OPEN_EXR"
render.image_settings.color_depth = "32"
render.image_settings.color_mode = "RGB"
render.filepath = os.path.join(directory, "cycles.exr")
bpy.ops.render.render(write_still=True)

# A render that is cancelled writes what it has.
if "WOODCOCK" in os.environ:
    image = os.path.join(directory, "cancelled.exr")
    process = RenderProcess(os.environ["WOODCOCK"], target, image)
    while process.poll() is None and process.fraction == 0:
        pass
    process.cancel()
    print("CANCELLED", process.poll(), process.fraction < 1, os.path.exists(image))
