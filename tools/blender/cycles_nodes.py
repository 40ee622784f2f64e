# SPDX-License-Identifier: Apache-2.0
"""What the building of node trees shares."""
import bpy


class Refused(Exception):
    """Something that this Blender cannot do; the message names it."""


class Nodes:
    """A node tree, emptied, that is filled from Python values and sockets alike."""

    def __init__(self, owner):
        owner.use_nodes = True
        self.tree = owner.node_tree
        self.tree.nodes.clear()

    def add(self, kind, settings=None, **inputs):
        """A node; inputs (by name, spaces as underscores) are sockets, numbers or colours."""
        node = self.tree.nodes.new(kind)
        for name, value in (settings or {}).items():
            setattr(node, name, value)
        for name, value in inputs.items():
            self.set(node.inputs[name.replace("_", " ")], value)
        return node

    def set(self, socket, value):
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        elif socket.type == "RGBA" and len(value) == 3:
            socket.default_value = (*value, 1.0)
        else:
            socket.default_value = value

    def multiply(self, a, b):
        """Of two numbers."""
        node = self.add("ShaderNodeMath", {"operation": "MULTIPLY"})
        self.set(node.inputs[0], a)
        self.set(node.inputs[1], b)
        return node.outputs[0]

    def multiply_add(self, a, b, c):
        """a x b + c of colours."""
        node = self.add("ShaderNodeVectorMath", {"operation": "MULTIPLY_ADD"})
        for socket, value in zip(node.inputs, (a, b, c)):
            self.set(socket, value)
        return node.outputs[0]

    def sum(self, parts):
        """Of shaders."""
        total = parts[0]
        for part in parts[1:]:
            node = self.add("ShaderNodeAddShader")
            self.set(node.inputs[0], total)
            self.set(node.inputs[1], part)
            total = node.outputs[0]
        return total
