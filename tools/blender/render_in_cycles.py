# SPDX-License-Identifier: Apache-2.0
"""Builds a scene that Woodcock has resolved and renders it with Cycles.

blender -b --factory-startup -P render_in_cycles.py -- DIRECTORY, or python with bpy. DIRECTORY
holds scene.json; image.exr (and scene.blend where it is asked for) are written there, and
result.json: {"version": ..., "seconds": ...} or {"refused": "what Cycles cannot do"}.
"""
import json
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy
from mathutils import Matrix

import cycles_lights
import cycles_motion
import cycles_surfaces
import cycles_volumes
from cycles_nodes import Refused


def set_up_sampling(scene, settings):
    """Returns the mode, null or biased."""
    cycles = scene.cycles
    # Nothing clamped, filtered, guided, denoised or left out; every pixel gets the same samples.
    exact = {
        "device": "CPU",
        "samples": settings["spp"],
        "seed": settings["seed"],
        "use_animated_seed": False,
        "use_adaptive_sampling": False,
        "use_denoising": False,
        "use_guiding": False,
        "time_limit": 0.0,
        "light_sampling_threshold": 0.0,
        "sample_clamp_direct": 0.0,
        "sample_clamp_indirect": 0.0,
        "blur_glossy": 0.0,
        "caustics_reflective": True,
        "caustics_refractive": True,
        "use_fast_gi": False,
        "film_exposure": 1.0,
        "pixel_filter_type": "BOX",
        "filter_width": 1.0,
        "max_bounces": settings["bounces"]["all"],
        "diffuse_bounces": settings["bounces"]["surface"],
        "glossy_bounces": settings["bounces"]["surface"],
        "transmission_bounces": settings["bounces"]["surface"],
        "volume_bounces": settings["bounces"]["volume"],
        "transparent_max_bounces": 1024,
        "volume_step_rate": settings["step_rate"],
        "volume_max_steps": 65536,
    }
    for name, value in exact.items():
        if hasattr(cycles, name):  # versions know different ones
            setattr(cycles, name, value)
    if hasattr(cycles, "volume_biased"):
        cycles.volume_biased = settings["mode"] == "biased"
        return settings["mode"] or "null"
    if settings["mode"] == "null":
        raise Refused("Blender %s only marches through volumes, which is biased: use --mode biased, "
                      "or Blender 5.0 or newer" % bpy.app.version_string)
    return "biased"


def set_up_image(scene, settings, out):
    render = scene.render
    render.resolution_x, render.resolution_y = settings["resolution"]
    render.resolution_percentage = 100
    render.pixel_aspect_x = render.pixel_aspect_y = 1.0
    render.film_transparent = False
    render.use_border = False
    render.use_compositing = render.use_sequencer = False
    render.dither_intensity = 0.0
    if settings["threads"]:
        render.threads_mode = "FIXED"
        render.threads = settings["threads"]
    image = render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "IMAGE"
    image.file_format = "OPEN_EXR"
    image.color_depth = "32"
    image.color_mode = "RGB"
    image.exr_codec = "ZIP"
    render.use_file_extension = False
    render.filepath = out


def set_up_shutter(scene, description):
    render = scene.render
    scene.frame_set(cycles_motion.FRAME)
    render.use_motion_blur = description["shutter"] > 0
    if not render.use_motion_blur:
        return
    render.motion_blur_shutter = description["shutter"]
    position = render if hasattr(render, "motion_blur_position") else scene.cycles
    position.motion_blur_position = description["shutter_position"]
    render.fps = max(1, round(description["fps"]))
    render.fps_base = render.fps / description["fps"]


def add_camera(scene, description):
    set_up_shutter(scene, description)
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.shift_x, camera.shift_y = description["shift"]
    camera.clip_start = description["clip_start"]
    camera.clip_end = description["clip_end"]
    if description["type"] == "orthographic":
        camera.type = "ORTHO"
        camera.ortho_scale = description["height"]
    else:
        camera.angle = description["angle"]
        if abs(camera.angle / description["angle"] - 1) > 1e-5:
            raise Refused("Blender's cameras see no angle of %g degrees"
                          % (description["angle"] * 57.29577951308232))
    placed = bpy.data.objects.new("camera", camera)
    scene.collection.objects.link(placed)
    scene.camera = placed
    cycles_motion.place(placed, Matrix(description["matrix"]),
                        [Matrix(m) for m in description["motion"] or ()], description["times"])
    if description["angles"]:
        cycles_motion.zoom(camera, description["angles"], description["times"])


def build(description, directory):
    """Returns how: the mode, and the interpolation of grids."""
    if bpy.app.version < (3, 4, 0):
        raise Refused("Blender %s is too old; 3.4 is the oldest that will do"
                      % bpy.app.version_string)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    if not hasattr(bpy.types, "CyclesRenderSettings"):
        bpy.ops.preferences.addon_enable(module="cycles")
    scene.render.engine = "CYCLES"
    mode = set_up_sampling(scene, description["render"])
    set_up_image(scene, description["render"], os.path.join(directory, "image.exr"))
    add_camera(scene, description["camera"])
    times = description["camera"]["times"]
    interpolation = cycles_volumes.chosen_interpolation(description["render"]["interpolation"])
    for i, volume in enumerate(description["volumes"]):
        cycles_volumes.add(scene, "volume%d" % i, volume, interpolation, times)
    cycles_lights.add(scene, description["lights"], directory, times)
    for i, surface in enumerate(description["surfaces"]):
        cycles_surfaces.add(scene, "surface%d" % i, surface, directory, times)
    scene.frame_set(cycles_motion.FRAME)
    return {"mode": mode, "interpolation": interpolation}


def run(directory):
    with open(os.path.join(directory, "scene.json")) as file:
        description = json.load(file)
    result = {"version": bpy.app.version_string}
    try:
        result.update(build(description, directory))
        if description["save"]:
            bpy.ops.wm.save_as_mainfile(filepath=os.path.join(directory, "scene.blend"),
                                        relative_remap=False)
        if description["render"]["draw"]:
            start = time.perf_counter()
            bpy.ops.render.render(write_still=True)
            result["seconds"] = time.perf_counter() - start
    except Refused as refused:
        result["refused"] = str(refused)
    with open(os.path.join(directory, "result.json"), "w") as file:
        json.dump(result, file)


if __name__ == "__main__":
    run((sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else sys.argv[1:])[0])
