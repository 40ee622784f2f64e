# SPDX-License-Identifier: Apache-2.0
"""Volume shaders: sigma_a, sigma_s and what they emit."""
from . import mapping
from .sockets import Product, Untranslatable, named, product, scalar, source
from .toml_text import quoted


class Medium:
    """sigma = factor x grid; `albedo_grid` multiplies sigma_s, and what it takes is absorbed.
    `emission` is a Product, `blackbody` (grid, scale, intensity, colour), or None. `phase` is a key
    of a scene file with its value: g, or phase."""

    def __init__(self, sigma_s, sigma_a, grid=None, albedo_grid=None, phase=("g", 0.0),
                 emission=None, blackbody=None):
        self.sigma_s, self.sigma_a = sigma_s, sigma_a
        self.grid, self.albedo_grid = (grid, albedo_grid) if self.dims() else (None, None)
        self.phase, self.emission, self.blackbody = phase, emission, blackbody

    def scaled(self, factor):
        emission, blackbody = self.emission, self.blackbody
        if emission:
            emission = emission.times(Product([factor] * 3))
        if blackbody:
            blackbody = (*blackbody[:3], [c * factor for c in blackbody[3]])
        return Medium([x * factor for x in self.sigma_s], [x * factor for x in self.sigma_a],
                      self.grid, self.albedo_grid, self.phase, emission, blackbody)

    def dims(self):
        """Whether it scatters or absorbs."""
        return max(self.sigma_s + self.sigma_a) > 0

    def empty(self):
        return not (self.dims() or self.emission or self.blackbody)

    def grids(self):
        """Names of those that it needs."""
        return [name for name in (self.grid, self.albedo_grid,
                                  self.emission and self.emission.grid,
                                  self.blackbody and self.blackbody[0]) if name]


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
    kinds = {"PRINCIPLED_VOLUME": principled, "VOLUME_SCATTER": scatter, "EMISSION": emission,
             "VOLUME_ABSORPTION": absorption, "VOLUME_COEFFICIENTS": coefficients}
    if node.type not in kinds:
        raise Untranslatable("the volume shader '%s'" % node.name)
    medium = kinds[node.type](node, grids, report)
    if medium.grid and medium.grid not in grids:
        raise Untranslatable("the attribute '%s', which is no grid of the volume" % medium.grid)
    return [] if medium.empty() else [medium]


def phase_of(node):
    """The key that says the phase function, g or phase, with its value."""
    kind = getattr(node, "phase", "HENYEY_GREENSTEIN")
    if kind == "HENYEY_GREENSTEIN":
        return "g", mapping.clamped_g(scalar(node.inputs["Anisotropy"], "an anisotropy"))
    if kind not in mapping.PHASES:
        raise Untranslatable("the phase function %s" % kind)
    name, sockets = mapping.PHASES[kind]
    keys = {"type": quoted(name)}
    for socket, (key, lower, upper) in sockets.items():
        value = scalar(node.inputs[socket], "the %s of a phase function" % socket)
        try:
            keys[key] = mapping.phase_value(socket, value, lower, upper)
        except ValueError as problem:
            raise Untranslatable("the phase function %s with %s" % (kind, problem))
    return "phase", keys


def glow(colour, strength, grids, report):
    """A Product, or None; both are sockets, `strength` may be missing."""
    try:
        amount = product(strength) if strength is not None else Product([1, 1, 1])
        if max(amount.factor) <= 0:
            return None
        amount = product(colour).times(amount)
        amount.factor = mapping.volume_emission(amount.factor, 1)
        if max(amount.factor) <= 0:
            return None
        if amount.grid and amount.grid not in grids:
            raise Untranslatable("the attribute '%s', which is no grid of the volume" % amount.grid)
        if amount.image:
            raise Untranslatable("an image in a volume")
        if grids and not amount.grid:
            raise Untranslatable("it is the same everywhere inside")
        return amount
    except Untranslatable as problem:
        report("emission is left out: %s" % problem)
        return None


def blackbody(node, grids, report):
    """Grid, scale, intensity and colour, or None."""
    try:
        intensity = scalar(node.inputs["Blackbody Intensity"], "a blackbody intensity")
        tint = product(node.inputs["Blackbody Tint"]).constant("a blackbody tint")
        if intensity <= 0 or max(tint) <= 0:
            return None
        temperature = product(node.inputs["Temperature"])
        name = named(node, "Temperature Attribute").default_value
        if name in grids:
            temperature = temperature.times(Product([1, 1, 1], grid=name))
        if temperature.grid not in grids:
            raise Untranslatable("its temperature is the same everywhere inside")
        return (temperature.grid,
                *mapping.principled_blackbody(temperature.factor[0], intensity, tint))
    except Untranslatable as problem:
        report("black-body emission is left out: %s" % problem)
        return None


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
    if colour.grid and (max(absorb) > 0 or max(colour.factor) > 1):
        raise Untranslatable("a colour grid with an absorption colour or a colour above 1")
    sigma_s, sigma_a = mapping.principled_volume(colour.factor, density.factor[0], absorb)
    return Medium(sigma_s, sigma_a, density.grid, colour.grid, phase_of(node),
                  glow(node.inputs["Emission Color"], node.inputs["Emission Strength"], grids,
                       report), blackbody(node, grids, report))


def emission(node, grids, report):
    return Medium([0.0] * 3, [0.0] * 3,
                  emission=glow(node.inputs["Color"], node.inputs["Strength"], grids, report))


def scatter(node, grids, report):
    density = product(node.inputs["Density"]).times(product(node.inputs["Color"]))
    return Medium(mapping.volume_scatter(density.factor, 1), [0.0] * 3, density.grid, None,
                  phase_of(node))


def absorption(node, grids, report):
    density = product(node.inputs["Density"])
    colour = product(node.inputs["Color"]).constant("an absorption's colour")
    return Medium([0.0] * 3, mapping.volume_absorption(colour, density.factor[0]), density.grid)


def coefficients(node, grids, report):
    sigma_s = product(node.inputs["Scatter Coefficients"])
    sigma_a = product(node.inputs["Absorption Coefficients"])
    if sigma_s.grid != sigma_a.grid and max(sigma_s.factor) > 0 and max(sigma_a.factor) > 0:
        raise Untranslatable("coefficients of different grids in one shader")
    return Medium(sigma_s.factor, sigma_a.factor, sigma_s.grid or sigma_a.grid, None, phase_of(node),
                  glow(node.inputs["Emission Coefficients"], None, grids, report))
