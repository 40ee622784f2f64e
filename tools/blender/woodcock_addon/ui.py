# SPDX-License-Identifier: Apache-2.0
"""Operators, panel and preferences."""
import os
import shutil
import tempfile

import bpy
from bpy_extras.io_utils import ExportHelper

from .export import export, export_frames
from .render_process import RenderProcess


class WoodcockPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: bpy.props.StringProperty(
        name="Program", subtype="FILE_PATH", default="",
        description="The woodcock program; empty: found on the PATH")

    def draw(self, context):
        self.layout.prop(self, "program")


def program(context):
    addon = context.preferences.addons.get(__package__)
    chosen = bpy.path.abspath(addon.preferences.program) if addon else ""
    return chosen or os.environ.get("WOODCOCK", "") or shutil.which("woodcock")


def tell(operator, problems):
    for problem in problems:
        operator.report({"WARNING"}, problem)


class EXPORT_SCENE_OT_woodcock(bpy.types.Operator, ExportHelper):
    """Write the scene for Woodcock, and its meshes beside it"""

    bl_idname = "export_scene.woodcock"
    bl_label = "Export Woodcock Scene"
    filename_ext = ".toml"
    filter_glob: bpy.props.StringProperty(default="*.toml", options={"HIDDEN"})
    frames: bpy.props.BoolProperty(
        name="Frame range", default=False,
        description="A file for each frame of the scene's range, numbered")

    def execute(self, context):
        try:
            if self.frames:
                scene = context.scene
                numbers = range(scene.frame_start, scene.frame_end + 1, scene.frame_step)
                problems = export_frames(context, self.filepath, numbers)[1]
            else:
                problems = export(context, self.filepath)
        except OSError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        tell(self, problems)
        return {"FINISHED"}


class RENDER_OT_woodcock(bpy.types.Operator):
    """Export the scene and render it with Woodcock; Escape cancels"""

    bl_idname = "render.woodcock"
    bl_label = "Render with Woodcock"

    def execute(self, context):
        """Waits for the end, as scripts do."""
        if not self.start(context):
            return {"CANCELLED"}
        self.render.process.wait()
        return self.finish(context)

    def invoke(self, context, event):
        if not self.start(context):
            return {"CANCELLED"}
        self.timer = context.window_manager.event_timer_add(0.2, window=context.window)
        context.window_manager.progress_begin(0, 100)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self.render.cancel()
            self.report({"WARNING"}, "cancelled; what was rendered so far is shown")
        elif event.type != "TIMER":
            return {"PASS_THROUGH"}
        if self.render.poll() is None:
            context.window_manager.progress_update(100 * self.render.fraction)
            context.workspace.status_text_set(
                "Woodcock: %.0f %%   Esc: cancel" % (100 * self.render.fraction))
            return {"RUNNING_MODAL"}
        context.window_manager.event_timer_remove(self.timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        return self.finish(context)

    def start(self, context):
        woodcock = program(context)
        if not woodcock:
            self.report({"ERROR"}, "there is no woodcock on the PATH; name it in the add-on's "
                        "preferences")
            return False
        self.directory = tempfile.mkdtemp(prefix="woodcock-")
        scene = os.path.join(self.directory, "scene.toml")
        self.image = os.path.join(self.directory, "woodcock.exr")
        try:
            tell(self, export(context, scene))
            self.render = RenderProcess(woodcock, scene, self.image)
        except OSError as error:
            shutil.rmtree(self.directory, ignore_errors=True)
            self.report({"ERROR"}, str(error))
            return False
        return True

    def finish(self, context):
        code = self.render.poll()
        for message in self.render.messages:
            self.report({"WARNING"}, message)
        shown = os.path.exists(self.image)
        if shown:
            self.show()
        shutil.rmtree(self.directory, ignore_errors=True)
        if code not in (0, 130) or not shown:
            self.report({"ERROR"}, "woodcock ended with code %s" % code)
            return {"CANCELLED"}
        return {"FINISHED"}

    def show(self):
        """As the image "Woodcock", packed, as its file goes away."""
        former = bpy.data.images.get("Woodcock")
        if former:
            bpy.data.images.remove(former)
        image = bpy.data.images.load(self.image)
        image.name = "Woodcock"
        image.pack()


class RENDER_PT_woodcock(bpy.types.Panel):
    bl_label = "Woodcock"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self.layout.operator("render.woodcock", icon="RENDER_STILL")
        self.layout.operator("export_scene.woodcock", icon="EXPORT")
        if "Woodcock" in bpy.data.images:
            self.layout.label(text="The picture is the image 'Woodcock'.")


def menu_export(self, context):
    self.layout.operator("export_scene.woodcock", text="Woodcock (.toml)")


CLASSES = (WoodcockPreferences, EXPORT_SCENE_OT_woodcock, RENDER_OT_woodcock, RENDER_PT_woodcock)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.TOPBAR_MT_file_export.append(menu_export)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(menu_export)
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
