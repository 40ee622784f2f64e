#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Denoises an EXR that Woodcock wrote with --layers albedo,normal, by Open Image Denoise.

    python3 -m venv build/denoise && build/denoise/bin/pip install pyoidn OpenEXR numpy
    build/denoise/bin/python tools/render/denoise.py noisy.exr clean.exr

Colour is denoised; alpha and all layers stay as they are.
"""
import sys

if len(sys.argv) != 3:
    sys.exit(__doc__)

import numpy
import OpenEXR
import pyoidn

with OpenEXR.File(sys.argv[1]) as image:
    layers = image.channels()
    missing = {"albedo", "normal.X", "normal.Y", "normal.Z"} - layers.keys()
    if missing:
        sys.exit("%s has no %s: render it with --layers albedo,normal"
                 % (sys.argv[1], ", ".join(sorted(missing))))
    normal = numpy.stack([layers["normal." + axis].pixels for axis in "XYZ"], axis=-1)
    colour = layers["RGBA"].pixels
    noisy = numpy.maximum(numpy.float32(colour[..., :3]), 0)  # the blue of dim fire may be below
    colour[..., :3] = pyoidn.denoise(noisy, layers["albedo"].pixels, normal, hdr=True)
    image.write(sys.argv[2])
