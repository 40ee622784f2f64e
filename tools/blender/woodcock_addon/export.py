# SPDX-License-Identifier: Apache-2.0
"""A Blender scene as a Woodcock scene file."""
import os

import bpy
from mathutils import Matrix, Vector

from . import lights, mapping, materials, meshes
from .media import media_of, shader_of
from .sockets import Untranslatable
from .toml_text import Section, colour, matrix, path, quoted, value

IGNORED = {"EMPTY", "CAMERA", "LIGHT", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE"}


class Exporter:
    """Writes the scene as it is at the current frame."""

    def __init__(self, context, file):
        self.depsgraph = context.evaluated_depsgraph_get()
        self.scene = self.depsgraph.scene_eval
        self.directory = os.path.dirname(os.path.abspath(file))
        self.file = os.path.abspath(file)
        self.problems = []
        self.sections = []
        self.materials = set()
        self.meshes = {}  # files by object: instances share one

    def report(self, what, problem):
        line = "%s: %s" % (what, problem)
        if line not in self.problems:
            self.problems.append(line)

    def run(self):
        """Writes the file, and meshes beside it; returns what could not be translated."""
        for instance in self.depsgraph.object_instances:
            if not instance.show_self:
                continue
            shown = instance.object
            if shown.original.hide_render:
                continue
            try:
                self.add_object(shown, instance.matrix_world.copy())
            except Untranslatable as problem:
                self.report(shown.name, "left out: %s" % problem)
        self.add_world()
        camera = self.camera()
        self.check_settings()
        head = ["# Of the Blender scene '%s', frame %d. Lengths are Blender's units."
                % (self.scene.name, self.scene.frame_current)]
        head += ["# Not as in Blender: %s" % p.replace("\n", " ") for p in self.problems]
        text = "\n".join(head) + "\n"
        text += "".join(s.text() for s in self.sections + [camera, self.render()])
        with open(self.file + ".part", "w", encoding="utf-8") as out:
            out.write(text)
        os.replace(self.file + ".part", self.file)
        return self.problems

    # ---- objects

    def add_object(self, shown, placed):
        if shown.type == "VOLUME":
            self.add_volume(shown, placed)
        elif shown.type == "LIGHT":
            report = lambda problem: self.report(shown.name, problem)
            self.sections += lights.light(
                shown.data, placed, "light %d" % len(self.sections), report)
        elif shown.type in ("MESH", "CURVE", "SURFACE", "META", "FONT"):
            self.add_mesh(shown, placed)
        elif shown.type not in IGNORED:
            raise Untranslatable("objects of type %s" % shown.type.lower())

    def add_volume(self, shown, placed):
        volume = shown.data
        if not volume.grids.load():
            raise Untranslatable("its file does not load: %s" % volume.grids.error_message)
        names = [grid.name for grid in volume.grids]
        if not names:
            raise Untranslatable("it has no grids at frame %d" % self.scene.frame_current)
        file = volume.grids.frame_filepath or bpy.path.abspath(volume.filepath)
        if not os.path.isfile(file):
            raise Untranslatable("its grids are not those of a file")
        material = shown.material_slots[0].material if shown.material_slots else None
        shader = shader_of(material, "Volume")
        if not shader:
            raise Untranslatable("it has no volume shader")
        report = lambda problem: self.report(shown.name, problem)
        if volume.render.clipping > 0:
            report("voxels up to %g are there all the same (clipping)" % volume.render.clipping)
        density = mapping.object_density(placed, volume.render.space)
        for medium in media_of(shader, names, report):
            if medium.dims() and not medium.grid:
                raise Untranslatable("a density that is the same everywhere inside")
            drawn = [self.drawn(placed, volume.grids[name]) for name in medium.grids()]
            if any(matrix != drawn[0] for matrix in drawn):
                report("grids of other voxels than those of '%s' lie aside by a part of one"
                       % medium.grids()[0])
            self.add_grid(medium.scaled(density), os.path.abspath(file), drawn[0])

    def drawn(self, placed, grid):
        """The object's matrix as this version of Cycles draws a grid."""
        offset = Vector([-mapping.voxel_offset(bpy.app.version)] * 3)
        return placed @ Matrix.Translation(grid.matrix_object.to_3x3() @ offset)

    def add_grid(self, medium, file, drawn):
        section = Section("[[volume]]").set("file", path(file))
        if medium.albedo_grid:
            section.set("density", quoted(medium.grid))
            total = [s + a for s, a in zip(medium.sigma_s, medium.sigma_a)]
            section.set("scale", colour(total))
            section.set("albedo", colour([s / t if t > 0 else 0
                                          for s, t in zip(medium.sigma_s, total)]))
            section.set("albedo_grid", quoted(medium.albedo_grid))
        else:
            for key, sigma in (("sigma_a", medium.sigma_a), ("sigma_s", medium.sigma_s)):
                if max(sigma) > 0:
                    section.set(key, {"grid": quoted(medium.grid), "scale": colour(sigma)})
            if not medium.dims():
                section.set("sigma_a", 0)
        if medium.emission:
            section.set("emission", {"grid": quoted(medium.emission.grid),
                                     "scale": colour(medium.emission.factor)})
        if medium.blackbody:
            grid, scale, intensity, tint = medium.blackbody
            section.set("blackbody", {"temperature": quoted(grid), "scale": scale,
                                      "intensity": intensity, "colour": colour(tint)})
        section.set(*medium.phase).set("matrix", matrix(drawn))
        self.sections.append(section)

    def add_mesh(self, shown, placed):
        mesh = shown.to_mesh()
        try:
            if mesh is None or not mesh.polygons:
                return
            used = {min(p.material_index, max(len(shown.material_slots) - 1, 0))
                    for p in mesh.polygons}
            if len(used) > 1:
                self.report(shown.name, "has several materials; all of it gets the first")
            index = min(used)
            slots = shown.material_slots
            self.add_surface(shown, placed, mesh, slots[index].material if slots else None)
        finally:
            shown.to_mesh_clear()

    def add_surface(self, shown, placed, mesh, material):
        report = lambda problem: self.report(shown.name, problem)
        volume = shader_of(material, "Volume")
        media = media_of(volume, (), report) if volume else []
        surface = materials.translate(material, report) if material else ("diffuse", {}, False)
        scattering = [m.phase for m in media if max(m.sigma_s) > 0]
        if any(phase != scattering[0] for phase in scattering):
            raise Untranslatable("media of different phase functions in one mesh")
        box = meshes.box_of(mesh)
        if surface is None and not media:
            return
        if surface is None and box:
            section = Section("[[volume]]").set(
                "box", {"min": value(box[0]), "max": value(box[1])})
            for key, v in medium_keys(media).items():
                section.set(key, v)
            self.sections.append(section.set("matrix", matrix(placed)))
            return
        kind, keys, textured = surface or ("interface", {}, False)
        if media and kind not in ("dielectric", "interface"):
            raise Untranslatable("a volume inside a surface that lets no light in")
        if surface is None:
            report("its medium replaces what is around it, instead of adding to it")
        section = Section("[[surface]]")
        section.set("file", path(self.mesh_file(shown, mesh, textured)))
        if material:
            if material.name not in self.materials:
                self.materials.add(material.name)
                self.sections.append(materials.section(material.name, kind, keys))
            section.set("material", quoted(material.name))
        smooth = any(p.use_smooth for p in mesh.polygons)
        section.set("smooth", 180 if smooth else quoted("flat"))
        section.set("matrix", matrix(placed))
        if media:
            section.set("medium", medium_keys(media, keys.get("ior", 1)))
        if not shown.original.visible_camera:
            section.set("camera_visible", False)
        self.sections.append(section)

    def mesh_file(self, shown, mesh, textured):
        key = shown.original.name_full
        if key not in self.meshes:
            file = "%s.%d.ply" % (os.path.splitext(self.file)[0], len(self.meshes))
            meshes.write_ply(mesh, file, textured)
            self.meshes[key] = os.path.basename(file)
        return self.meshes[key]

    # ---- the rest

    def add_world(self):
        report = lambda problem: self.report("world", problem)
        world = self.scene.world
        found = []
        if world:
            try:
                found = lights.world(world, report)
            except Untranslatable as problem:
                report("left out: %s" % problem)
        for section in found:
            if self.scene.render.film_transparent:
                section.set("visible", False)
        if not found:  # without any light Woodcock would choose some
            found = [Section("[[light]]").set("type", quoted("environment")).set("radiance", 0)]
        self.sections += found

    def camera(self):
        section = Section("[camera]")
        placed = self.scene.camera
        if not placed:
            self.report("camera", "there is none; Woodcock chooses one")
            return section
        camera = placed.data
        width, height = self.resolution()
        where = placed.matrix_world.normalized()
        if camera.type == "ORTHO":
            side = mapping.sensor_height(camera.sensor_fit, 1, 1, width, height)
            section.set("type", quoted("orthographic")).set("height", camera.ortho_scale * side)
        elif camera.type == "PERSP":
            sensor = mapping.sensor_height(camera.sensor_fit, camera.sensor_width,
                                           camera.sensor_height, width, height)
            section.set("fov", mapping.vertical_angle(sensor, camera.lens))
        else:
            self.report(placed.name, "a panoramic camera; Woodcock chooses an ordinary one")
            return section
        shift = mapping.shift(camera.sensor_fit, camera.shift_x, camera.shift_y, width, height)
        if shift != [0, 0]:
            section.set("shift", shift)
        if camera.dof.use_dof:
            self.report(placed.name, "depth of field is left out")
        return section.set("matrix", matrix(where))

    def resolution(self):
        render = self.scene.render
        scale = render.resolution_percentage / 100
        return int(render.resolution_x * scale), int(render.resolution_y * scale)

    def render(self):
        cycles = self.scene.cycles
        section = Section("[render]").set("resolution", list(self.resolution()))
        section.set("spp", cycles.samples)
        section.set("max_scatterings",
                    mapping.max_scatterings(cycles.volume_bounces, cycles.max_bounces))
        if self.meshes:
            section.set("max_bounces", mapping.max_scatterings(
                max(self.surface_bounces()), cycles.max_bounces))
        return section

    def surface_bounces(self):
        cycles = self.scene.cycles
        return cycles.diffuse_bounces, cycles.glossy_bounces, cycles.transmission_bounces

    def check_settings(self):
        """What in Cycles' settings changes its picture's mean."""
        cycles, render = self.scene.cycles, self.scene.render
        report = lambda problem: self.report("render settings", problem)
        if cycles.sample_clamp_indirect > 0 or cycles.sample_clamp_direct > 0:
            report("Cycles clamps bright samples, Woodcock none")
        if cycles.light_sampling_threshold > 0:
            report("Cycles leaves out weak light (Light Threshold), Woodcock none")
        bounces = self.surface_bounces()
        if self.meshes and min(bounces) < min(cycles.max_bounces, max(bounces)):
            report("Cycles bounds diffuse, glossy and transmitted bounces each, %d, %d and %d; "
                   "Woodcock takes the most for all" % bounces)
        if cycles.pixel_filter_type != "BOX" or cycles.filter_width != 1:
            report("Cycles filters pixels (%s), Woodcock's are boxes of one"
                   % cycles.pixel_filter_type.lower())
        if render.pixel_aspect_x != render.pixel_aspect_y:
            report("pixels that are no squares become squares")
        if render.use_motion_blur:
            report("motion blur is left out")
        if render.use_border:
            report("the render region is left out: all of the picture is drawn")


def medium_keys(media, ior=1):
    keys = {"sigma_a": colour([sum(m.sigma_a[c] for m in media) for c in range(3)]),
            "sigma_s": colour([sum(m.sigma_s[c] for m in media) for c in range(3)])}
    scattering = [m.phase for m in media if max(m.sigma_s) > 0]
    if scattering:
        keys.update(scattering[:1])
    emission = [sum(m.emission.factor[c] for m in media if m.emission) for c in range(3)]
    if max(emission) > 0:
        keys["emission"] = colour(mapping.emission_within(emission, ior))
    return keys


def export(context, file):
    """Writes the active scene; returns lines about what is not as in Blender."""
    return Exporter(context, file).run()


def export_frames(context, file, frames):
    """A file for each frame, numbered: scene.0012.toml. Returns them, and the lines of all."""
    files, problems = [], []
    stem, extension = os.path.splitext(file)
    before = context.scene.frame_current
    try:
        for frame in frames:
            context.scene.frame_set(frame)
            files.append("%s.%04d%s" % (stem, frame, extension))
            problems += [p for p in export(context, files[-1]) if p not in problems]
    finally:
        context.scene.frame_set(before)
    return files, problems
