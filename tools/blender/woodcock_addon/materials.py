# SPDX-License-Identifier: Apache-2.0
"""Surface shaders as Woodcock's materials."""
import os

import bpy

from .media import shader_of
from .sockets import Untranslatable, named, product, scalar
from .toml_text import Section, colour, path, quoted


def texture(found):
    """A Product as TOML."""
    if found.grid:
        raise Untranslatable("the attribute '%s' on a surface" % found.grid)
    if not found.image:
        return colour(found.factor)
    image = found.image
    if image.packed_file or image.source != "FILE":
        raise Untranslatable("the image '%s', which is no file on its own" % image.name)
    keys = {"image": path(os.path.abspath(bpy.path.abspath(image.filepath))),
            "times": colour(found.factor)}
    space = image.colorspace_settings.name
    if space in ("Non-Color", "Raw"):
        keys["colour_space"] = quoted("data")
    elif space != "sRGB" and not space.startswith("Linear"):
        raise Untranslatable("the colour space '%s' of the image '%s'" % (space, image.name))
    return keys


def translate(material, report):
    """(type, keys of a [[material]], whether it needs texture coordinates); None where there is no
    surface."""
    node = shader_of(material, "Surface")
    if node is None:
        return None
    kinds = {"BSDF_DIFFUSE": diffuse, "BSDF_GLOSSY": glossy, "BSDF_METALLIC": metallic,
             "BSDF_GLASS": glass, "EMISSION": emission, "BSDF_PRINCIPLED": principled}
    if node.type not in kinds:
        raise Untranslatable("the surface shader '%s'" % node.name)
    kind, keys = kinds[node.type](node, report)
    return kind, keys, any(isinstance(v, dict) and "image" in v for v in keys.values())


def diffuse(node, report):
    if scalar(node.inputs["Roughness"], "a roughness") > 0:
        report("a diffuse shader's roughness is left out")
    return "diffuse", {"colour": texture(product(node.inputs["Color"]))}


def glossy(node, report):
    report("a Glossy shader becomes a metal, which is brighter at grazing angles")
    return "conductor", {"colour": texture(product(node.inputs["Color"])),
                         "roughness": scalar(node.inputs["Roughness"], "a roughness")}


def metallic(node, report):
    roughness = scalar(node.inputs["Roughness"], "a roughness")
    if node.fresnel_type == "PHYSICAL_CONDUCTOR":
        return "conductor", {"eta": colour(product(node.inputs["IOR"]).constant("an IOR")),
                             "k": colour(product(node.inputs["Extinction"]).constant("a k")),
                             "roughness": roughness}
    return "conductor", {"colour": texture(product(node.inputs["Base Color"])),
                         "roughness": roughness}


def glass(node, report):
    if product(node.inputs["Color"]).factor != [1.0, 1.0, 1.0]:
        report("a glass's colour is left out; give it a volume absorption")
    sharp = getattr(node, "distribution", "") == "SHARP"
    return "dielectric", {
        "ior": scalar(node.inputs["IOR"], "an IOR"),
        "roughness": 0.0 if sharp else scalar(node.inputs["Roughness"], "a roughness")}


def emission(node, report):
    strength = product(node.inputs["Strength"])
    return "emissive", {"radiance": texture(product(node.inputs["Color"]).times(strength)),
                        "both_sides": True}


def principled(node, report):
    """Its plain cases: metal, glass, or diffuse."""
    metal = scalar(node.inputs["Metallic"], "a metalness")
    through = scalar(named(node, "Transmission Weight", "Transmission"), "a transmission")
    alpha = scalar(node.inputs["Alpha"], "an alpha")
    if alpha < 1 or not (metal in (0, 1) and through in (0, 1)):
        raise Untranslatable("a Principled shader between diffuse, metal, glass and transparent")
    light = product(named(node, "Emission Color", "Emission")).times(
        product(node.inputs["Emission Strength"]))
    roughness = scalar(node.inputs["Roughness"], "a roughness")
    base = product(node.inputs["Base Color"])
    if max(light.factor) > 0:
        if max(base.factor) > 0:
            report("a shader that emits becomes black otherwise")
        return "emissive", {"radiance": texture(light), "both_sides": True}
    if metal:
        return "conductor", {"colour": texture(base), "roughness": roughness}
    if through:
        if base.factor != [1.0, 1.0, 1.0] or base.image:
            report("a glass's colour is left out; give it a volume absorption")
        return "dielectric", {"ior": scalar(node.inputs["IOR"], "an IOR"), "roughness": roughness}
    if scalar(named(node, "Specular IOR Level", "Specular"), "a specular level") > 0:
        report("the coat of reflection on a diffuse Principled shader is left out")
    return "diffuse", {"colour": texture(base)}


def section(name, kind, keys):
    text = Section("[[material]]").set("name", quoted(name)).set("type", quoted(kind))
    for key, v in keys.items():
        text.set(key, v)
    return text
