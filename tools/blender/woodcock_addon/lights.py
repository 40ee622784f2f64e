# SPDX-License-Identifier: Apache-2.0
"""Lamps and the world."""
import os

import bpy
from mathutils import Matrix, Vector

from . import mapping
from .sockets import Untranslatable, named, product, scalar, source
from .toml_text import Section, colour, matrix, path, quoted, value


def lamp_colour(lamp):
    """What multiplies the energy: colour, temperature, exposure and an Emission node."""
    tint = list(lamp.color)
    if getattr(lamp, "use_temperature", False):
        tint = [a * b for a, b in zip(tint, lamp.temperature_color)]
    tint = [c * 2 ** getattr(lamp, "exposure", 0.0) for c in tint]
    if lamp.use_nodes and lamp.node_tree:
        output = next((n for n in lamp.node_tree.nodes if n.type == "OUTPUT_LIGHT"), None)
        shader = source(output.inputs["Surface"]) if output else None
        if not shader or shader.node.type != "EMISSION":
            raise Untranslatable("its nodes are more than an Emission")
        node = shader.node
        glow = product(node.inputs["Color"]).times(product(node.inputs["Strength"]))
        tint = [a * b for a, b in zip(tint, glow.constant("a lamp's colour"))]
    return tint


def area(lamp, placed, name, report):
    """Sections of a surface that emits, and its material of this name."""
    width, depth = lamp.size, lamp.size_y if lamp.shape in ("RECTANGLE", "ELLIPSE") else lamp.size
    if lamp.spread < 3.1415:
        report("an area lamp's spread is left out")
    report("an area lamp becomes a surface, which stands in the way of light")
    round_one = lamp.shape in ("DISK", "ELLIPSE")
    # Woodcock's shapes lie in y = 0 and face +y, lamps shine along -z.
    turned = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))
    where = placed @ turned @ Matrix.Diagonal((width, 1, depth, 1))
    x, z = where.col[0].to_3d(), where.col[2].to_3d()
    size = x.cross(z).length * (0.25 * 3.141592653589793 if round_one else 1)
    radiance = colour(mapping.area_radiance(lamp_colour(lamp), lamp.energy, size))
    material = Section("[[material]]").set("name", quoted(name))
    material.set("type", quoted("emissive")).set("radiance", radiance)
    surface = Section("[[surface]]").set("material", quoted(name))
    if round_one:
        surface.set("disk", {"radius": 0.5})
    else:
        surface.set("plane", {"size": [1, 1]})
    return [material, surface.set("matrix", matrix(where)).set("camera_visible", False)]


def lamp(lamp, placed, name, report):
    """Sections of a scene file; `name` is one that nothing else in it has."""
    if not getattr(lamp, "normalize", True):
        raise Untranslatable("a lamp whose power grows with its size")
    if lamp.type == "AREA":
        return area(lamp, placed, name, report)
    tint = lamp_colour(lamp)
    section = Section("[[light]]")
    if lamp.type == "SUN":
        direction = placed.to_3x3() @ Vector((0, 0, -1))
        section.set("type", quoted("sun")).set("direction", value(direction.normalized()))
        section.set("irradiance", colour(mapping.sun_irradiance(
            bpy.app.version, tint, lamp.energy, lamp.angle)))
        if lamp.angle > 0:
            section.set("angular_diameter", lamp.angle * 57.29577951308232)
    elif lamp.type == "POINT":
        radius = lamp.shadow_soft_size
        position = value(placed.translation)
        if radius > 0:
            section.set("type", quoted("sphere")).set("position", position).set("radius", radius)
            section.set("radiance", colour(mapping.sphere_radiance(tint, lamp.energy, radius)))
            section.set("visible", False)
            report("Cycles' lamps with a radius are spheres only from afar")
        else:
            section.set("type", quoted("point")).set("position", position)
            section.set("intensity", colour(mapping.point_intensity(tint, lamp.energy)))
    else:
        raise Untranslatable("lamps of type %s" % lamp.type.lower())
    return [section]


def world(world, report):
    """Sections of lights."""
    if not getattr(world, "use_nodes", True) or not world.node_tree:
        return [environment(list(world.color))]
    output = world.node_tree.get_output_node("CYCLES")
    if output and source(output.inputs["Volume"]):
        report("the volume of the world is left out")
    shader = source(output.inputs["Surface"]) if output else None
    return backgrounds(shader.node) if shader else []


def backgrounds(node):
    if node.type == "ADD_SHADER":
        found = []
        for socket in node.inputs:
            part = source(socket)
            found += backgrounds(part.node) if part else []
        return found
    if node.type != "BACKGROUND":
        raise Untranslatable("the shader '%s'" % node.name)
    strength = scalar(node.inputs["Strength"], "a background's strength")
    fed = source(node.inputs["Color"])
    if fed and fed.node.type == "TEX_ENVIRONMENT":
        return [image(fed.node, strength)]
    tint = product(node.inputs["Color"]).constant("a background's colour")
    return [environment([c * strength for c in tint])]


def environment(radiance):
    return Section("[[light]]").set("type", quoted("environment")).set("radiance", colour(radiance))


def image(node, strength):
    picture = node.image
    if node.projection != "EQUIRECTANGULAR":
        raise Untranslatable("a mirror ball as the world's image")
    if not picture or picture.packed_file or picture.source != "FILE":
        raise Untranslatable("an image of the world that is no file on its own")
    space = picture.colorspace_settings.name
    if space not in ("Non-Color", "Raw") and not space.startswith("Linear"):
        raise Untranslatable("the colour space '%s' of the world's image" % space)
    section = environment([strength] * 3)
    section.set("image", path(os.path.abspath(bpy.path.abspath(picture.filepath))))
    section.set("up", quoted("z"))
    return section.set("rotation", mapping.environment_rotation(turn(node)))


def turn(node):
    """Radians about z by a Mapping node."""
    fed = source(node.inputs["Vector"])
    if not fed or (fed.node.type == "TEX_COORD" and fed.name == "Generated"):
        return 0.0
    where = fed.node
    if where.type != "MAPPING" or where.vector_type not in ("POINT", "VECTOR"):
        raise Untranslatable("the node '%s' at the world's image" % where.name)
    origin = source(where.inputs["Vector"])
    rotation = product(where.inputs["Rotation"]).constant("a rotation")
    location = named(where, "Location")
    moved = where.vector_type == "POINT" and location and max(map(abs, location.default_value)) > 0
    scaled = list(where.inputs["Scale"].default_value) != [1.0, 1.0, 1.0]
    if not origin or origin.name != "Generated" or rotation[:2] != [0.0, 0.0] or moved or scaled:
        raise Untranslatable("a mapping of the world's image that is no turn about z")
    return rotation[2]
