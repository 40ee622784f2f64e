# SPDX-License-Identifier: Apache-2.0
"""Lights and the world."""
import os

import bpy
from mathutils import Matrix, Vector

from . import mapping
from .sockets import Untranslatable, named, product, scalar, source
from .toml_text import Section, colour, matrix, path, quoted, value


def light_colour(light):
    """What multiplies the energy: colour, temperature, exposure and an Emission node."""
    tint = list(light.color)
    if getattr(light, "use_temperature", False):
        tint = [a * b for a, b in zip(tint, light.temperature_color)]
    tint = [c * 2 ** getattr(light, "exposure", 0.0) for c in tint]
    if light.use_nodes and light.node_tree:
        output = next((n for n in light.node_tree.nodes if n.type == "OUTPUT_LIGHT"), None)
        shader = source(output.inputs["Surface"]) if output else None
        if not shader or shader.node.type != "EMISSION":
            raise Untranslatable("its nodes are more than an Emission")
        node = shader.node
        glow = product(node.inputs["Color"]).times(product(node.inputs["Strength"]))
        tint = [a * b for a, b in zip(tint, glow.constant("a light's colour"))]
    return tint


def area(light, placed):
    """A rectangle, a disk or an ellipse that shines along -z of the lamp."""
    width, depth = light.size, light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size
    round_one = light.shape in ("DISK", "ELLIPSE")
    # Woodcock's lights lie in y = 0 and shine towards +y.
    turned = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))
    where = placed @ turned @ Matrix.Diagonal((width, 1, depth, 1))
    x, z = where.col[0].to_3d(), where.col[2].to_3d()
    size = x.cross(z).length * (0.25 * 3.141592653589793 if round_one else 1)
    if abs(x.dot(z)) > 1e-6 * x.length * z.length:
        raise Untranslatable("an area light that is sheared")
    radiance = colour(mapping.area_radiance(light_colour(light), light.energy, size))
    section = Section("[[light]]").set("type", quoted("disk" if round_one else "rectangle"))
    if round_one:
        section.set("radius", 0.5)
    section.set("matrix", matrix(upright(where))).set("radiance", radiance)
    if light.spread < 3.1415:
        section.set("spread", light.spread * 57.29577951308232)
    return [section.set("visible", False)]


def upright(where):
    """The same, with a normal that is perpendicular: a lamp's scale along it says nothing."""
    x, z = where.col[0].to_3d(), where.col[2].to_3d()
    normal = z.cross(x).normalized()
    if normal.dot(where.col[1].to_3d()) < 0:
        normal = -normal
    made = where.copy()
    for row in range(3):
        made[row][1] = normal[row]
    return made


def light(light, placed, name, report):
    """Sections of a scene file; `name` is one that nothing else in it has."""
    if not getattr(light, "normalize", True):
        raise Untranslatable("a light whose power grows with its size")
    if light.type == "AREA":
        return area(light, placed)
    tint = light_colour(light)
    section = Section("[[light]]")
    if light.type == "SUN":
        direction = placed.to_3x3() @ Vector((0, 0, -1))
        section.set("type", quoted("sun")).set("direction", value(direction.normalized()))
        section.set("irradiance", colour(mapping.sun_irradiance(
            bpy.app.version, tint, light.energy, light.angle)))
        if light.angle > 0:
            section.set("angular_diameter", light.angle * 57.29577951308232)
    elif light.type == "POINT":
        radius = light.shadow_soft_size
        position = value(placed.translation)
        if radius > 0:
            section.set("type", quoted("sphere")).set("position", position).set("radius", radius)
            section.set("radiance", colour(mapping.sphere_radiance(tint, light.energy, radius)))
            section.set("visible", False)
            report("Cycles' lights with a radius are spheres only from afar")
        else:
            section.set("type", quoted("point")).set("position", position)
            section.set("intensity", colour(mapping.point_intensity(tint, light.energy)))
    elif light.type == "SPOT":
        direction = placed.to_3x3() @ Vector((0, 0, -1))
        section.set("type", quoted("spot")).set("position", value(placed.translation))
        section.set("direction", value(direction.normalized()))
        section.set("intensity", colour(mapping.point_intensity(tint, light.energy)))
        section.set("cone", light.spot_size * 57.29577951308232).set("blend", light.spot_blend)
        if light.shadow_soft_size > 0:
            report("a spot's radius is left out: its shadows are sharp")
    else:
        raise Untranslatable("lights of type %s" % light.type.lower())
    return [section]


def world(world, report):
    """Sections of lights."""
    if not getattr(world, "use_nodes", True) or not world.node_tree:
        return [environment(list(world.color))]
    output = world.node_tree.get_output_node("CYCLES")
    if output and source(output.inputs["Volume"]):
        report("the volume of the world is left out")
    shader = source(output.inputs["Surface"]) if output else None
    return backgrounds(shader.node, report) if shader else []


def backgrounds(node, report):
    if node.type == "ADD_SHADER":
        found = []
        for socket in node.inputs:
            part = source(socket)
            found += backgrounds(part.node, report) if part else []
        return found
    if node.type != "BACKGROUND":
        raise Untranslatable("the shader '%s'" % node.name)
    strength = scalar(node.inputs["Strength"], "a background's strength")
    fed = source(node.inputs["Color"])
    if fed and fed.node.type == "TEX_ENVIRONMENT":
        return [image(fed.node, strength)]
    if fed and fed.node.type == "TEX_SKY":
        return [sky(fed.node, strength, report)]
    tint = product(node.inputs["Color"]).constant("a background's colour")
    return [environment([c * strength for c in tint])]


def environment(radiance):
    return Section("[[light]]").set("type", quoted("environment")).set("radiance", colour(radiance))


def sky(node, strength, report):
    if node.sky_type != "HOSEK_WILKIE":
        raise Untranslatable("the sky model '%s'" % node.sky_type.lower().replace("_", " "))
    if "Vector" in node.inputs and source(node.inputs["Vector"]):
        raise Untranslatable("a sky that nodes turn")
    elevation, azimuth = mapping.sun_place(node.sun_direction)
    report("Cycles' sky goes on below the horizon; Woodcock has the ground there")
    return (Section("[[light]]").set("type", quoted("sky")).set("elevation", elevation)
            .set("azimuth", azimuth).set("up", quoted("z")).set("turbidity", node.turbidity)
            .set("ground_albedo", node.ground_albedo).set("sun", False)
            .set("strength", mapping.sky_strength(strength)))


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
