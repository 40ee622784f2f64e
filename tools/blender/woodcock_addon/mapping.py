# SPDX-License-Identifier: Apache-2.0
"""Cycles' parameters in Woodcock's terms: all that both programs have by different numbers. Pure
Python that needs no Blender. Colours are lists of three; sigma is per world unit. What Cycles means
was read in its kernel (`svm_node_principled_volume`, `object_volume_density`) and measured with
Blender 3.4 and 5.0.
"""
import math

LARGEST_G = 0.999  # Cycles clamps to it, and takes less than 0.001 for none


def principled_volume(colour, density, absorption=(0, 0, 0)):
    """sigma_s and sigma_a of a Principled Volume where its grids are 1 and the object's density is
    that of the world."""
    density = max(density, 0.0)
    sigma_s = [density * max(c, 0.0) for c in colour]
    sigma_a = [density * max(1 - c, 0.0) * max(1 - math.sqrt(max(a, 0.0)), 0.0)
               for c, a in zip(colour, absorption)]
    return sigma_s, sigma_a


def volume_scatter(colour, density):
    """sigma_s of a Volume Scatter."""
    return [max(density, 0.0) * max(c, 0.0) for c in colour]


def volume_absorption(colour, density):
    """sigma_a of a Volume Absorption."""
    return [max(density, 0.0) * max(1 - c, 0.0) for c in colour]


def volume_emission(colour, strength):
    """Radiance per unit of an Emission shader in a volume, or of a Principled Volume: neither its
    density nor what it absorbs matters."""
    return [max(strength, 0.0) * max(c, 0.0) for c in colour]


def principled_blackbody(temperature, intensity, tint):
    """Scale, intensity and colour of the `blackbody` of a volume. Cycles has b T^4 + 1 - b where
    Woodcock has b T^4: the rest is 1e-14 of radiance."""
    return max(temperature, 0.0), max(intensity, 0.0), [max(c, 0.0) for c in tint]


def emission_within(emission, ior):
    """Of what glows inside glass: Cycles lets it out with the radiance that it has within, of which
    really 1 / n^2 is left."""
    return [e * ior * ior for e in emission]


def object_density(matrix, space):
    """What multiplies the densities of a volume object with this object to world matrix (rows)
    whose volume renders in `space`: with OBJECT, Blender's default, a volume that is made larger
    becomes as much thinner."""
    if space != "OBJECT":
        return 1.0
    diagonal = [sum(row[:3]) / math.sqrt(3) for row in matrix[:3]]
    return 1 / math.sqrt(sum(d * d for d in diagonal))


def clamped_g(g):
    g = min(max(g, -LARGEST_G), LARGEST_G)
    return 0.0 if abs(g) < 1e-3 else g


# Of Blender's names of phase functions: Woodcock's, and a key for each socket, with the values that
# Woodcock takes.
PHASES = {"RAYLEIGH": ("rayleigh", {}),
          "DRAINE": ("draine", {"Anisotropy": ("g", -LARGEST_G, LARGEST_G),
                                "Alpha": ("alpha", 0.0, math.inf)}),
          "MIE": ("mie", {"Diameter": ("diameter", 1.5, 50.0)}),
          "FOURNIER_FORAND": ("fournier_forand", {"IOR": ("ior", 1.001, 1.999),
                                                  "Backscatter": ("backscatter", 1e-4, 0.4999)})}


def phase_value(socket, value, lower, upper):
    """What Cycles makes of a socket's value; ValueError where Woodcock has no such thing."""
    if socket == "Anisotropy":
        return clamped_g(value)
    if not lower <= value <= upper:
        raise ValueError("%s %g, which is not between %g and %g" % (socket, value, lower, upper))
    return value


def max_scatterings(volume_bounces, max_bounces):
    """m bounces allow m + 1 scatterings: light is sampled at the last one too. The same holds for
    surfaces."""
    return min(volume_bounces, max_bounces) + 1


def voxel_offset(version):
    """Voxels, along each index axis, by which a volume must be moved so that Cycles draws the value
    of index (i, j, k) where OpenVDB has it. Before 5.0 Cycles drew it in the middle of the cell from
    (i, j, k) to (i+1, j+1, k+1)."""
    return 0.0 if tuple(version) >= (5, 0, 0) else -0.5


def sun_share(version, angle):
    """What a sun's strength is to be multiplied by for the irradiance on a surface that faces it.
    Blender 3.4 gives less the larger the angular diameter (radians) is, 5.0 does not; from when on
    is not known, and matters from some 10 degrees on."""
    cosine = math.cos(angle / 2)
    return 1.0 if tuple(version) >= (4, 0, 0) else 2 * cosine / (1 + cosine)


def sun_irradiance(version, colour, strength, angle):
    """On a surface that faces it."""
    return [c * strength * sun_share(version, angle) for c in colour]


def point_intensity(colour, power):
    """Of a point light without a radius, and of a spot along its axis: power per solid angle."""
    return [c * power / (4 * math.pi) for c in colour]


def sphere_radiance(colour, power, radius):
    """Of a point light with a radius."""
    return [c * power / (4 * math.pi ** 2 * radius ** 2) for c in colour]


def area_radiance(colour, power, area):
    """Of an area light, to its front. A spread keeps the power."""
    return [c * power / (math.pi * area) for c in colour]


def environment_rotation(mapping_z):
    """Degrees of an environment image (up = "z") that a Mapping node turns by `mapping_z` radians.
    Cycles has the image's centre towards +x, Woodcock towards +y."""
    return -90.0 - math.degrees(mapping_z)


def sun_place(direction):
    """Elevation and azimuth in degrees (up = "z") of a Hosek-Wilkie sky's sun in this direction.
    Cycles takes a sun below the horizon for one on it."""
    x, y, z = direction
    return max(math.degrees(math.atan2(z, math.hypot(x, y))), 0.0), math.degrees(math.atan2(x, y))


def sky_strength(strength):
    """Of a Hosek-Wilkie sky: Cycles multiplies the published numbers by 2 pi / 683."""
    return strength * 2 * math.pi / 683


def sensor_height(fit, sensor_width, sensor_height, width, height):
    """Height, in a camera's millimetres, of what a picture of width x height pixels shows."""
    if fit == "AUTO":
        fit, sensor_height = ("HORIZONTAL" if width >= height else "VERTICAL"), sensor_width
    return sensor_height if fit == "VERTICAL" else sensor_width * height / width


def vertical_angle(sensor, focal_length):
    """Degrees from the picture's bottom to its top."""
    return math.degrees(2 * math.atan(sensor / (2 * focal_length)))


def shift(fit, shift_x, shift_y, width, height):
    """In heights of the picture; Blender counts in the side that the sensor is fitted to."""
    vertical = fit == "VERTICAL" or (fit == "AUTO" and height > width)
    side = height if vertical else width
    return [shift_x * side / height, shift_y * side / height]
