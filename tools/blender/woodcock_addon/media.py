# SPDX-License-Identifier: Apache-2.0
"""Volume shaders: sigma_a and sigma_s."""
from . import mapping
from .sockets import Product, Untranslatable, named, product, scalar, source


class Medium:
    """sigma = factor x grid; `albedo_grid` multiplies sigma_s, and what it takes is absorbed."""

    def __init__(self, sigma_s, sigma_a, grid=None, albedo_grid=None, g=0.0):
        self.sigma_s, self.sigma_a = sigma_s, sigma_a
        self.grid, self.albedo_grid, self.g = grid, albedo_grid, g

    def scaled(self, factor):
        return Medium([x * factor for x in self.sigma_s], [x * factor for x in self.sigma_a],
                      self.grid, self.albedo_grid, self.g)

    def empty(self):
        return max(self.sigma_s + self.sigma_a) <= 0


def shader_of(material, what):
    """The node that feeds the material's output `what`, Surface or Volume."""
    if not material or not material.node_tree or not getattr(material, "use_nodes", True):
        return None
    output = material.node_tree.get_output_node("CYCLES")
    end = source(output.inputs[what]) if output else None
    return end.node if end else None


def media_of(node, grids, report):
    """The media that a volume shader adds up; `grids` are the names in the volume's file, none for
    a mesh."""
    if node.type == "ADD_SHADER":
        found = []
        for socket in node.inputs:
            part = source(socket)
            found += media_of(part.node, grids, report) if part else []
        return found
    if node.type == "MIX_SHADER":
        weight = scalar(node.inputs[0], "a mix of volumes")
        found = []
        for socket, share in ((node.inputs[1], 1 - weight), (node.inputs[2], weight)):
            part = source(socket)
            found += [m.scaled(share) for m in media_of(part.node, grids, report)] if part else []
        return found
    kinds = {"PRINCIPLED_VOLUME": principled, "VOLUME_SCATTER": scatter,
             "VOLUME_ABSORPTION": absorption, "VOLUME_COEFFICIENTS": coefficients}
    if node.type not in kinds:
        raise Untranslatable("the volume shader '%s'" % node.name)
    medium = kinds[node.type](node, grids, report)
    if medium.grid and medium.grid not in grids:
        raise Untranslatable("the attribute '%s', which is no grid of the volume" % medium.grid)
    return [] if medium.empty() else [medium]


def g_of(node):
    return mapping.clamped_g(scalar(node.inputs["Anisotropy"], "an anisotropy"))


def principled(node, grids, report):
    density = product(node.inputs["Density"])
    name = named(node, "Density Attribute").default_value
    if name in grids:
        density = density.times(Product([1, 1, 1], grid=name))
    elif name and grids:
        report("there is no grid '%s': the density is the same everywhere" % name)
    colour = product(node.inputs["Color"])
    name = named(node, "Color Attribute").default_value
    if name in grids:
        colour = colour.times(Product([1, 1, 1], grid=name))
    absorb = product(node.inputs["Absorption Color"]).constant("an absorption colour")
    if scalar(node.inputs["Emission Strength"], "an emission strength") > 0 and \
            max(product(node.inputs["Emission Color"]).factor) > 0:
        report("emission is left out")
    if scalar(node.inputs["Blackbody Intensity"], "a blackbody intensity") > 0:
        report("black-body emission is left out")
    if colour.grid and (max(absorb) > 0 or max(colour.factor) > 1):
        raise Untranslatable("a colour grid with an absorption colour or a colour above 1")
    sigma_s, sigma_a = mapping.principled_volume(colour.factor, density.factor[0], absorb)
    return Medium(sigma_s, sigma_a, density.grid, colour.grid, g_of(node))


def scatter(node, grids, report):
    if getattr(node, "phase", "HENYEY_GREENSTEIN") != "HENYEY_GREENSTEIN":
        raise Untranslatable("the phase function %s" % node.phase)
    density = product(node.inputs["Density"]).times(product(node.inputs["Color"]))
    return Medium(mapping.volume_scatter(density.factor, 1), [0.0] * 3, density.grid, None,
                  g_of(node))


def absorption(node, grids, report):
    density = product(node.inputs["Density"])
    colour = product(node.inputs["Color"]).constant("an absorption's colour")
    return Medium([0.0] * 3, mapping.volume_absorption(colour, density.factor[0]), density.grid)


def coefficients(node, grids, report):
    sigma_s = product(node.inputs["Scatter Coefficients"])
    sigma_a = product(node.inputs["Absorption Coefficients"])
    emission = product(node.inputs["Emission Coefficients"])
    if max(emission.factor) > 0:
        report("emission is left out")
    if sigma_s.grid != sigma_a.grid and max(sigma_s.factor) > 0 and max(sigma_a.factor) > 0:
        raise Untranslatable("coefficients of different grids in one shader")
    return Medium(sigma_s.factor, sigma_a.factor, sigma_s.grid or sigma_a.grid, None, g_of(node))
