# SPDX-License-Identifier: Apache-2.0
"""Tests of the media that tools/blender/cycles_volumes.py makes, by a Blender that only computes:
python3 blender_volumes.py DIRECTORY_OF_CYCLES_VOLUMES DIRECTORY_OF_MAPPING"""
import sys
import types
import unittest

sys.path[:0] = [sys.argv.pop(1), sys.argv.pop(1)]

bpy = types.SimpleNamespace(types=types.SimpleNamespace(NodeSocket=object),
                            app=types.SimpleNamespace(version=(5, 0, 0), version_string="5.0.0"))
sys.modules["bpy"] = bpy
sys.modules["mathutils"] = types.SimpleNamespace(Matrix=None, Vector=None)

import cycles_volumes
from cycles_nodes import Refused


class Value:
    """A socket that knows its value."""

    def __init__(self, value):
        self.value = value if isinstance(value, tuple) else (value,) * 3
        self.type = "RGBA" if isinstance(value, tuple) else "VALUE"


def number(value):
    if isinstance(value, Value):
        return value.value
    return tuple(value) if hasattr(value, "__len__") else (value,) * 3


class Computing:
    """Nodes, of which sigma_s and sigma_a are what Cycles makes of them."""

    def __init__(self):
        self.sigma_s = self.sigma_a = (0,) * 3
        self.g = []
        self.phases = []
        self.kinds = []

    def multiply_add(self, a, b, c):
        return Value(tuple(x * y + z for x, y, z in zip(number(a), number(b), number(c))))

    def multiply(self, a, b):
        return Value(number(a)[0] * number(b)[0])

    def add(self, kind, settings=None, **inputs):
        self.kinds.append(kind)
        value = {name: number(amount) for name, amount in inputs.items()}
        none = (0,) * 3
        if kind == "ShaderNodeVolumeCoefficients":
            sigma_s, sigma_a = value["Scatter_Coefficients"], value["Absorption_Coefficients"]
        elif kind == "ShaderNodeVolumeScatter":
            sigma_s = [c * d for c, d in zip(value["Color"], value["Density"])]
            sigma_a = none
        else:
            assert kind == "ShaderNodeVolumeAbsorption", kind
            sigma_s = none
            sigma_a = [(1 - c) * d for c, d in zip(value["Color"], value["Density"])]
        self.sigma_s = [a + b for a, b in zip(self.sigma_s, sigma_s)]
        self.sigma_a = [a + b for a, b in zip(self.sigma_a, sigma_a)]
        if "Anisotropy" in inputs:
            self.g.append(inputs["Anisotropy"])
        if kind != "ShaderNodeVolumeAbsorption":
            self.phases.append((settings, {key: inputs[key] for key in inputs if key in (
                "Anisotropy", "Alpha", "Diameter", "IOR", "Backscatter")}))
        return types.SimpleNamespace(outputs=[kind])


def described(sigma_s, sigma_a):
    """As Woodcock writes it."""
    density = max(s + a for s, a in zip(sigma_s, sigma_a))
    return {"sigma_s": sigma_s, "sigma_a": sigma_a, "density": density,
            "phase": {"type": "", "inputs": {"Anisotropy": 0.4}},
            "scatter_colour": [s / density for s in sigma_s],
            "absorb_colour": [1 - a / density for a in sigma_a],
            "scatters": max(sigma_s) > 0, "absorbs": max(sigma_a) > 0}


class Media(unittest.TestCase):
    # What a Principled Volume of density 2 has, colours above 1 and absorption colours among them.
    MEDIA = [([1, 1.4, 1.8], [1, 0.6, 0.2]), ([1, 1.4, 1.8], [0.5, 0.3, 0.1]),
             ([2.4, 1.4, 1.8], [0, 0.6, 0.2]), ([0, 0, 0], [3, 2, 0]), ([5, 0, 1], [0, 0, 0])]

    def near(self, found, expected):
        for a, b in zip(found, expected, strict=True):
            self.assertAlmostEqual(a, b, places=12)

    def both_versions(self):
        for coefficients in (True, False):
            if coefficients:
                bpy.types.ShaderNodeVolumeCoefficients = object
            elif hasattr(bpy.types, "ShaderNodeVolumeCoefficients"):
                del bpy.types.ShaderNodeVolumeCoefficients
            yield coefficients

    def test_coefficients_are_kept(self):
        for coefficients in self.both_versions():
            for sigma_s, sigma_a in self.MEDIA:
                for density in (None, 0.0, 0.25, 3.0, (0.5, 2.0, 0.125)):
                    nodes = Computing()
                    cycles_volumes.medium(nodes, described(sigma_s, sigma_a),
                                          None if density is None else Value(density))
                    amount = number(1 if density is None else density)
                    self.near(nodes.sigma_s, [d * s for d, s in zip(amount, sigma_s)])
                    self.near(nodes.sigma_a, [d * a for d, a in zip(amount, sigma_a)])
                    self.assertEqual("ShaderNodeVolumeCoefficients" in nodes.kinds, coefficients)
                    if max(sigma_s) > 0:
                        self.assertEqual(nodes.g, [0.4])

    def test_what_a_grid_of_albedos_takes_from_scattering_is_absorbed(self):
        albedo = (0.5, 0.25, 1.0)
        for _ in self.both_versions():
            nodes = Computing()
            description = described([1, 1.4, 1.8], [1, 0.6, 0.2])
            cycles_volumes.medium(nodes, description, Value(3.0), Value(albedo))
            self.near(nodes.sigma_s, (1.5, 1.05, 5.4))
            self.near(nodes.sigma_a, (4.5, 4.95, 0.6))

    def test_other_phase_functions_come_with_4_3(self):
        mie = dict(described([1, 1, 1], [0.5, 0, 0]),
                   phase={"type": "MIE", "inputs": {"Diameter": 20.0}})
        for _ in self.both_versions():
            bpy.app.version = (4, 3, 0)
            nodes = Computing()
            cycles_volumes.medium(nodes, mie)
            self.assertEqual(nodes.phases, [({"phase": "MIE"}, {"Diameter": 20.0})])
            bpy.app.version = (4, 2, 9)
            with self.assertRaises(Refused) as refused:
                cycles_volumes.medium(Computing(), mie)
            self.assertIn("MIE", str(refused.exception))
            cycles_volumes.medium(Computing(), described([1, 1, 1], [0, 0, 0]))
            bpy.app.version = (5, 0, 0)

    def test_nothing_is_no_shader(self):
        for _ in self.both_versions():
            nothing = dict(described([1] * 3, [0] * 3), sigma_s=[0] * 3, scatters=False)
            self.assertEqual(cycles_volumes.medium(Computing(), nothing), [])


class Interpolation(unittest.TestCase):
    def test_is_chosen_where_there_is_a_choice(self):
        for version, default in (((4, 5, 0), "trilinear"), ((5, 0, 0), "stochastic")):
            bpy.app.version = version
            self.assertEqual(cycles_volumes.chosen_interpolation(""), default)
            self.assertEqual(cycles_volumes.chosen_interpolation("trilinear"), "trilinear")
        self.assertEqual(cycles_volumes.chosen_interpolation("stochastic"), "stochastic")
        bpy.app.version = (4, 5, 0)
        with self.assertRaises(Refused):
            cycles_volumes.chosen_interpolation("stochastic")


unittest.main()
