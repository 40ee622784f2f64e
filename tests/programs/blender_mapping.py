# SPDX-License-Identifier: Apache-2.0
"""Tests of tools/blender/woodcock_addon/mapping.py: python3 blender_mapping.py DIRECTORY_OF_MAPPING"""
import math
import sys
import unittest

sys.path.insert(0, sys.argv.pop(1))

import mapping


class Mapping(unittest.TestCase):
    def near(self, found, expected):
        for a, b in zip(found, expected, strict=True):
            self.assertAlmostEqual(a, b, places=12)

    def test_phase_functions(self):
        self.assertEqual(mapping.phase_value("Anisotropy", 1.0, -0.999, 0.999), 0.999)
        for _, sockets in mapping.PHASES.values():
            for socket, (key, lower, upper) in sockets.items():
                inside = (lower + min(upper, 60)) / 2
                self.assertEqual(mapping.phase_value(socket, inside, lower, upper), inside)
        with self.assertRaises(ValueError) as refused:
            mapping.phase_value("Diameter", 0.5, 1.5, 50.0)
        self.assertIn("Diameter 0.5", str(refused.exception))

    def test_principled_volume(self):
        colour = (0.5, 0.7, 0.9)
        for absorption, sigma_a in (((0, 0, 0), (1, 0.6, 0.2)),
                                    ((0.25,) * 3, (0.5, 0.3, 0.1)),
                                    ((1, 4, 1), (0, 0, 0))):
            found = mapping.principled_volume(colour, 2, absorption)
            self.near(found[0], (1, 1.4, 1.8))
            self.near(found[1], sigma_a)
        found = mapping.principled_volume((1.2, 0.7, 0.9), 2)
        self.near(found[0], (2.4, 1.4, 1.8))
        self.near(found[1], (0, 0.6, 0.2))
        found = mapping.principled_volume(colour, -1)
        self.near(found[0] + found[1], [0] * 6)

    def test_scatter_and_absorption(self):
        self.near(mapping.volume_scatter((0.5, 2, 0), 3), (1.5, 6, 0))
        self.near(mapping.volume_absorption((0.5, 2, 0), 3), (1.5, 0, 3))

    def test_emission(self):
        self.near(mapping.volume_emission((0.5, 2, -1), 3), (1.5, 6, 0))
        self.near(mapping.volume_emission((0.5, 2, 1), -3), (0, 0, 0))
        self.near(mapping.emission_within((1, 2, 0), 1.5), (2.25, 4.5, 0))
        # What Cycles radiates of luminance, by its own formula.
        for kelvin, intensity in ((1000, 1), (1500, 0.5), (3000, 0.02)):
            scale, b, colour = mapping.principled_blackbody(kelvin / 0.7, intensity, (1, 0.5, 0))
            cycles = 1.80493578e-14 * (1 - intensity + intensity * kelvin ** 4)
            watts = 1e-6 * 5.670374419e-8 / math.pi * (scale * 0.7) ** 4
            self.assertAlmostEqual(b * colour[1] * watts / (0.5 * cycles), 1, places=6)
        self.near(mapping.principled_blackbody(-5, 1, (1, 1, 1))[2], (1, 1, 1))
        self.assertEqual(mapping.principled_blackbody(-5, 1, (1, 1, 1))[0], 0)

    def test_sky(self):
        self.near(mapping.sun_place((0, 1, 1)), (45, 0))
        self.near(mapping.sun_place((2, 0, 0)), (0, 90))
        self.near(mapping.sun_place((-3, 0, 3)), (45, -90))
        self.near(mapping.sun_place((1, 1, -1)), (0, 45))
        self.assertEqual(mapping.sun_place((0, 0, 1))[0], 90)
        self.assertAlmostEqual(mapping.sky_strength(1), 0.0091994, places=7)

    def test_object_density(self):
        def scaled(x, y, z):
            return [[x, 0, 0, 5], [0, y, 0, 6], [0, 0, z, 7], [0, 0, 0, 1]]
        self.assertEqual(mapping.object_density(scaled(2, 3, 4), "WORLD"), 1)
        self.assertAlmostEqual(mapping.object_density(scaled(1, 1, 1), "OBJECT"), 1)
        self.assertAlmostEqual(mapping.object_density(scaled(4, 4, 4), "OBJECT"), 0.25)
        self.assertAlmostEqual(mapping.object_density(scaled(1, 1, 2), "OBJECT"),
                               1 / math.sqrt(2))
        quarter_turn = [[0, -2, 0, 1], [2, 0, 0, 1], [0, 0, 2, 1], [0, 0, 0, 1]]
        self.assertAlmostEqual(mapping.object_density(quarter_turn, "OBJECT"), 0.5)

    def test_g_is_clamped(self):
        self.assertEqual([mapping.clamped_g(g) for g in (-1, 1, 0.5, 5e-4, -5e-4)],
                         [-0.999, 0.999, 0.5, 0, 0])

    def test_bounces(self):
        self.assertEqual(mapping.max_scatterings(0, 12), 1)
        self.assertEqual(mapping.max_scatterings(7, 12), 8)
        self.assertEqual(mapping.max_scatterings(7, 2), 3)

    def test_voxels(self):
        self.assertEqual(mapping.voxel_offset((3, 4, 1)), -0.5)
        self.assertEqual(mapping.voxel_offset((4, 5, 9)), -0.5)
        self.assertEqual(mapping.voxel_offset((5, 0, 0)), 0)

    def test_lights(self):
        self.near(mapping.point_intensity((1, 0.5, 0), 4 * math.pi), (1, 0.5, 0))
        # The same flux all around: 4 pi r^2 pi L.
        radiance = mapping.sphere_radiance((1, 1, 1), 10, 0.5)[0]
        self.assertAlmostEqual(4 * math.pi * 0.25 * math.pi * radiance, 10)
        # As pixels of a white floor under a sun of pi had it.
        for degrees, share in ((0, 1), (20, 0.99235), (60, 0.92820), (120, 0.66667)):
            angle = math.radians(degrees)
            self.assertAlmostEqual(mapping.sun_share((3, 4, 1), angle), share, places=4)
            self.near(mapping.sun_irradiance((5, 0, 1), (1, 2, 0), 3, angle), (3, 6, 0))
        # An even emitter: the flux is pi x area x radiance.
        self.near(mapping.area_radiance((1, 0, 2), 8 * math.pi, 0.5), (16, 0, 32))

    def test_environment(self):
        self.assertAlmostEqual(mapping.environment_rotation(0), -90)
        self.assertAlmostEqual(mapping.environment_rotation(math.pi / 2), -180)

    def test_camera(self):
        self.assertEqual(mapping.sensor_height("VERTICAL", 36, 24, 200, 100), 24)
        self.assertEqual(mapping.sensor_height("HORIZONTAL", 36, 24, 200, 100), 18)
        self.assertEqual(mapping.sensor_height("AUTO", 36, 24, 200, 100), 18)
        self.assertEqual(mapping.sensor_height("AUTO", 36, 24, 100, 200), 36)
        self.assertAlmostEqual(mapping.vertical_angle(24, 12), 90)
        self.near(mapping.shift("AUTO", 0.1, 0.2, 200, 100), (0.2, 0.4))
        self.near(mapping.shift("AUTO", 0.1, 0.2, 100, 200), (0.1, 0.2))
        self.near(mapping.shift("HORIZONTAL", 0.1, 0.2, 100, 200), (0.05, 0.1))


unittest.main()
