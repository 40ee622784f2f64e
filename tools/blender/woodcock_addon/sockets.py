# SPDX-License-Identifier: Apache-2.0
"""What a node's input amounts to: a constant, or a constant times a grid or an image."""


class Untranslatable(Exception):
    """The message says what Woodcock has nothing for."""


class Product:
    """A factor (list of three) x a volume's grid, or x an image."""

    def __init__(self, factor, grid=None, image=None):
        self.factor = [float(x) for x in factor]
        self.grid = grid
        self.image = image

    def times(self, other):
        for kind in ("grid", "image"):
            if getattr(self, kind) and getattr(other, kind):
                raise Untranslatable("a product of two %ss" % kind)
        return Product([a * b for a, b in zip(self.factor, other.factor)],
                       self.grid or other.grid, self.image or other.image)

    def constant(self, what):
        if self.grid or self.image:
            raise Untranslatable("%s that is not the same everywhere" % what)
        return self.factor


def spread(v):
    """Any socket's value as three numbers."""
    try:
        return [float(x) for x in v][:3]
    except TypeError:
        return [float(v)] * 3


def named(node, *names):
    """The first input of one of these names, which differ among Blender's versions."""
    for name in names:
        if name in node.inputs:
            return node.inputs[name]
    return None


def source(socket):
    """The output that feeds an input, past reroutes; None where nothing does."""
    while socket.is_linked:
        link = socket.links[0]
        if link.is_muted if hasattr(link, "is_muted") else False:
            return None
        if link.from_node.type != "REROUTE":
            return link.from_socket
        socket = link.from_node.inputs[0]
    return None


def product(socket):
    output = source(socket)
    if output is None:
        return Product(spread(socket.default_value))
    node = output.node
    if node.type in ("VALUE", "RGB"):
        return Product(spread(output.default_value))
    if node.type == "ATTRIBUTE":
        return Product([1, 1, 1], grid=node.attribute_name)
    if node.type == "VOLUME_INFO":
        grid = {"Density": "density", "Flame": "flame", "Temperature": "temperature",
                "Color": "color"}
        return Product([1, 1, 1], grid=grid[output.name])
    if node.type == "TEX_IMAGE" and output.name == "Color":
        if source(node.inputs["Vector"]) and source(node.inputs["Vector"]).name != "UV":
            raise Untranslatable("an image that is not placed by plain UVs")
        return Product([1, 1, 1], image=node.image)
    if node.type in ("MATH", "VECT_MATH") and not getattr(node, "use_clamp", False):
        return arithmetic(node)
    raise Untranslatable("the node '%s'" % (node.label or node.name))


def arithmetic(node):
    if node.operation == "MULTIPLY":
        return product(node.inputs[0]).times(product(node.inputs[1]))
    if node.operation == "SCALE":
        return product(node.inputs[0]).times(product(node.inputs["Scale"]))
    if node.operation == "DIVIDE":
        by = product(node.inputs[1]).constant("a divisor")
        if 0 not in by:
            return product(node.inputs[0]).times(Product([1 / x for x in by]))
    raise Untranslatable("the node '%s' (%s)" % (node.label or node.name, node.operation.lower()))


def scalar(socket, what):
    """Of an input that must be constant."""
    return product(socket).constant(what)[0]
