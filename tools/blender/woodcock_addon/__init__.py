# SPDX-License-Identifier: Apache-2.0
"""Woodcock from within Blender: exports the active scene, and renders it from a panel of the render
properties."""
bl_info = {
    "name": "Woodcock",
    "description": "Export to and render with the Woodcock volume renderer",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Render properties, File > Export",
    "category": "Render",
}

from . import ui


def register():
    ui.register()


def unregister():
    ui.unregister()
