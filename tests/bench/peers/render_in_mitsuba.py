# SPDX-License-Identifier: Apache-2.0
"""Renders a scene file of Woodcock with Mitsuba 3, on the processor.

python render_in_mitsuba.py SCENE.toml SPP SEED OUT.exr THREADS

It knows what the scenes of the comparison hold, and refuses everything else. Volumes are read from
NAME.vol, which woodcock convert makes of NAME.vdb.
"""

import pathlib
import sys
import tomllib

import numpy as np

import mitsuba as mi

mi.set_variant("llvm_ad_rgb")
import drjit as dr  # noqa: E402
from mitsuba import ScalarTransform4f as Transform  # noqa: E402

SAMPLES_AT_ONCE = 64  # of each pixel: what Mitsuba holds of its paths takes memory
BOUNCES = 100000


def colour(value):
    """A number stands for a grey, as in Woodcock's scene files."""
    return np.broadcast_to(np.asarray(value, float), 3)


def rgb(value):
    return {"type": "rgb", "value": [float(c) for c in colour(value)]}


def take(table, *keys):
    """The values of the keys; all others are refused."""
    unknown = set(table) - set(keys)
    if unknown:
        raise SystemExit(f"not translated for Mitsuba: {', '.join(sorted(unknown))}")
    return [table.get(key) for key in keys]


def placed(transform):
    scale, rotate, translate = take(transform or {}, "scale", "rotate", "translate")
    turned = Transform().translate(translate or [0, 0, 0])
    for axis, degrees in reversed(list(zip(np.eye(3).tolist(), rotate or [0, 0, 0]))):
        turned = turned @ Transform().rotate(axis, degrees)
    return turned @ Transform().scale(scale or 1)


def box_between(lower, upper):
    """What places Mitsuba's cube, which reaches from -1 to 1."""
    lower, upper = np.asarray(lower, float), np.asarray(upper, float)
    return Transform().translate(((lower + upper) / 2).tolist()) @ Transform().scale(
        ((upper - lower) / 2).tolist()
    )


def read_volume(path):
    """Values [z, y, x] with a border of zeros, and the box that they fill."""
    size = np.fromfile(path, "<i4", 3, offset=8)
    lower, upper = np.fromfile(path, "<f4", 6, offset=24).astype(float).reshape(2, 3)
    values = np.fromfile(path, "<f4", offset=48).reshape(size[::-1])
    voxel = (upper - lower) / size
    return np.pad(values, 1), lower - voxel, upper + voxel


def coefficients(volume):
    """sigma_a and sigma_s, per unit of density where they name a grid."""
    return [
        colour(c["scale"] if isinstance(c, dict) else c)
        for c in (volume.get("sigma_a", 0), volume.get("sigma_s", 0))
    ]


def phase(g):
    return {"type": "hg", "g": float(g)} if g else {"type": "isotropic"}


def even_medium(table):
    sigma_a, sigma_s = coefficients(table)
    sigma_t = sigma_a + sigma_s
    scale = float(sigma_t.max())
    return {
        "type": "homogeneous",
        "scale": scale,  # Mitsuba's colours end at 1
        "sigma_t": rgb(sigma_t / scale),
        "albedo": rgb(sigma_s / sigma_t),
        "phase": phase(table.get("g")),
    }


def grid_medium(sigma_a, sigma_s, g, values, lower, upper):
    sigma_t = sigma_a + sigma_s
    scale = float(sigma_t.max())
    # One channel where the medium is grey, for Mitsuba's faster integrator.
    shares = [1.0] if np.ptp(sigma_t) == 0 else (sigma_t / scale).tolist()
    grid = np.ascontiguousarray(values[..., None] * np.array(shares), dtype=np.float32)
    return {
        "type": "heterogeneous",
        "scale": scale,
        "albedo": rgb(sigma_s / sigma_t),
        "phase": phase(g),
        "sigma_t": {
            "type": "gridvolume",
            "grid": mi.VolumeGrid(grid),
            "to_world": box_between(lower, upper) @ Transform().translate(-1).scale(2),
            "filter_type": "trilinear",
            "wrap_mode": "clamp",
            "raw": True,
        },
    }


def volume(table, folder):
    file, box, _, _, g = take(table, "file", "box", "sigma_a", "sigma_s", "g")
    if file:
        values, lower, upper = read_volume((folder / file).with_suffix(".vol"))
        medium = grid_medium(*coefficients(table), g, values, lower, upper)
    else:
        lower, upper = take(box, "min", "max")
        medium = even_medium(table)
    return {
        "type": "cube",
        "to_world": box_between(lower, upper),
        "bsdf": {"type": "null"},
        "interior": medium,
    }


def material(table):
    _, kind, colour_, ior, radiance = take(table, "name", "type", "colour", "ior", "radiance")
    if kind == "diffuse":
        # Woodcock's surfaces have two sides.
        bsdf = {"type": "diffuse", "reflectance": rgb(colour_)}
        return {"bsdf": {"type": "twosided", "inner": bsdf}}
    if kind == "dielectric":
        return {"bsdf": {"type": "dielectric", "int_ior": float(ior), "ext_ior": 1.0}}
    if kind == "emissive":
        black = {"type": "diffuse", "reflectance": rgb(0)}
        return {"bsdf": black, "emitter": {"type": "area", "radiance": rgb(radiance)}}
    raise SystemExit(f"not translated for Mitsuba: material of type {kind}")


def surface(table, materials):
    plane, sphere, name, medium, transform = take(
        table, "plane", "sphere", "material", "medium", "transform"
    )
    shape = dict(materials[name])
    if sphere:
        centre, radius = take(sphere, "centre", "radius")
        shape |= {"type": "sphere", "center": centre or [0, 0, 0], "radius": radius}
        shape["to_world"] = placed(transform)
    else:
        (size,) = take(plane, "size")
        # Mitsuba's rectangle faces +z, and Woodcock's plane +y.
        flat = Transform().scale([size[0] / 2, 1, size[1] / 2]) @ Transform().rotate([1, 0, 0], -90)
        shape |= {"type": "rectangle", "to_world": placed(transform) @ flat}
    return shape | ({"interior": even_medium(medium)} if medium else {})


def light(table, fog):
    kind = table["type"]
    if kind == "sun":
        _, direction, irradiance, angle = take(
            table, "type", "direction", "irradiance", "angular_diameter"
        )
        if angle != 0:
            raise SystemExit("not translated for Mitsuba: a sun with a disc")
        return {"type": "directional", "direction": direction, "irradiance": rgb(irradiance)}
    if kind == "environment":
        _, radiance = take(table, "type", "radiance")
        return {"type": "constant", "radiance": rgb(radiance)}
    if kind == "sphere":
        _, position, radius, radiance = take(table, "type", "position", "radius", "radiance")
        lamp = {"type": "sphere", "center": position, "radius": radius, "bsdf": {"type": "null"}}
        inside = {"interior": fog, "exterior": fog} if fog else {}
        return lamp | inside | {"emitter": {"type": "area", "radiance": rgb(radiance)}}
    raise SystemExit(f"not translated for Mitsuba: light of type {kind}")


def sensor(camera, render):
    eye, look_at, up, fov = take(camera, "eye", "look_at", "up", "fov")
    (resolution,) = take(render, "resolution")
    return {
        "type": "perspective",
        "fov": fov,
        "fov_axis": "y",
        "to_world": Transform().look_at(origin=eye, target=look_at, up=up or [0, 1, 0]),
        "film": {
            "type": "hdrfilm",
            "width": resolution[0],
            "height": resolution[1],
            "rfilter": {"type": "box"},
            "component_format": "float32",
            "pixel_format": "rgb",
        },
        "sampler": {"type": "independent"},
    }


def integrator(volumes):
    grids = [sum(coefficients(v)) for v in volumes if "file" in v]
    grey = all(np.ptp(sigma_t) == 0 for sigma_t in grids)
    kind = "volpath" if grey else "volpathmis"
    return {"type": kind, "max_depth": BOUNCES, "rr_depth": 64}


def translate(description, folder):
    volumes, lights, surfaces, materials, camera, render = take(
        description, "volume", "light", "surface", "material", "camera", "render"
    )
    volumes = volumes or []
    if len(volumes) > 1:
        raise SystemExit("not translated for Mitsuba: volumes that overlap")
    scene = {"type": "scene", "integrator": integrator(volumes), "sensor": sensor(camera, render)}
    fog = None
    for table in volumes:
        shape = volume(table, folder)
        fog = mi.load_dict(shape["interior"])  # one medium, which a lamp in it knows too
        scene["volume"] = shape | {"interior": fog}
    by_name = {m["name"]: material(m) for m in materials or []}
    for i, table in enumerate(surfaces or []):
        scene[f"surface{i}"] = surface(table, by_name)
    for i, table in enumerate(lights):
        scene[f"light{i}"] = light(table, fog)
    return mi.load_dict(scene)


def draw(scene, spp, seed):
    """The mean of renders of as many samples as fit into memory."""
    total = 0
    for begin in range(0, spp, SAMPLES_AT_ONCE):
        count = min(SAMPLES_AT_ONCE, spp - begin)
        part = mi.render(scene, spp=count, seed=seed * 100003 + begin).numpy()
        total = total + count * part.astype(np.float64)
    return (total / spp).astype(np.float32)


def main(scene_file, spp, seed, out, threads):
    dr.set_thread_count(int(threads))
    path = pathlib.Path(scene_file)
    scene = translate(tomllib.loads(path.read_text()), path.parent)
    mi.Bitmap(draw(scene, int(spp), int(seed))).write(out)


if __name__ == "__main__":
    main(*sys.argv[1:])
