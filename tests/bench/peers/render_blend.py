# SPDX-License-Identifier: Apache-2.0
"""Renders a .blend of woodcock cycles --save by Cycles: python (with bpy) render_blend.py
SCENE.blend WIDTH HEIGHT SPP SEED OUT.exr THREADS"""

import sys

import bpy


def main(blend, width, height, spp, seed, out, threads):
    bpy.ops.wm.open_mainfile(filepath=blend)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
    scene.cycles.samples, scene.cycles.seed = int(spp), int(seed)
    scene.render.threads_mode, scene.render.threads = "FIXED", int(threads)
    scene.render.filepath = out
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
