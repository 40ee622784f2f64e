# SPDX-License-Identifier: Apache-2.0
"""Exports a .blend file to a Woodcock scene, without a window:

blender -b FILE.blend -P export_scene.py -- SCENE.toml [--frame N | --frames]
python export_scene.py FILE.blend SCENE.toml [...]              (with the module bpy)

--frame takes another frame than the file's own, --frames all of its range. What is not as in
Blender is listed.
"""
import argparse
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy

from woodcock_addon.export import export, export_frames


def main():
    inside = "--" in sys.argv
    parser = argparse.ArgumentParser(prog="export_scene.py", description="Exports to Woodcock.")
    if not inside:
        parser.add_argument("blend")
    parser.add_argument("scene")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--frame", type=int)
    which.add_argument("--frames", action="store_true")
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if inside else None)
    if not inside:
        bpy.ops.wm.open_mainfile(filepath=os.path.abspath(options.blend))
    scene = bpy.context.scene
    if options.frames:
        numbers = range(scene.frame_start, scene.frame_end + 1, scene.frame_step)
        files, problems = export_frames(bpy.context, options.scene, numbers)
    else:
        if options.frame is not None:
            scene.frame_set(options.frame)
        files, problems = [options.scene], export(bpy.context, options.scene)
    for problem in problems:
        print("not as in Blender: " + problem)
    for file in files:
        print("wrote " + file)


try:
    main()
except OSError as error:
    sys.exit("export_scene.py: %s" % error)
