# SPDX-License-Identifier: Apache-2.0
"""Measures Woodcock and Cycles on one cloud of ever more voxels; prints a table in Markdown.

tests/bench/production_sizes.sh prepares all that it needs, and calls it.
"""

import argparse
import json
import pathlib
import sys

import cost
from measure import Failed, circumstances, run

HERE = pathlib.Path(__file__).parent
SIZE, FIRST_SIZE = (160, 160), (640, 360)  # pixels: for the cost; for the first whole picture
SAMPLES = {"woodcock": 128, "cycles": 64}
TRIES = 3  # of the first picture; the quickest by the clock counts


class Woodcock:
    def __init__(self, options, scene, voxels):
        self.options, self.scene = options, scene
        self.volume = options.scratch / f"cumulus.{voxels}.vdb"

    def draw(self, size, spp, seed):
        out, stats = self.options.scratch / "woodcock.exr", self.options.scratch / "stats.json"
        done = run(
            [self.options.woodcock, "render", self.scene, "--set", f"volume[0].file={self.volume}",
             "--res", f"{size[0]}x{size[1]}", "--spp", spp, "--seed", seed, "--quiet",
             "--threads", self.options.threads, "-o", out, "--stats", stats]
        )
        done.load = json.loads(stats.read_text())["load_seconds"]
        return done, out


class Cycles:
    def __init__(self, options, woodcock):
        self.options, self.blend = options, options.scratch / "cumulus.blend"
        run(
            [options.woodcock, "cycles", woodcock.scene, "--set",
             f"volume[0].file={woodcock.volume}", "--save", self.blend, "--quiet",
             "--blender", options.cycles]
        )

    def draw(self, size, spp, seed):
        out = self.options.scratch / "cycles.exr"
        done = run(
            [self.options.cycles, HERE / "render_blend.py", self.blend, *size, spp, seed, out,
             self.options.threads]
        )
        return done, out


def first_picture(renderer, clock):
    runs = [renderer.draw(FIRST_SIZE, 1, 0)[0] for _ in range(TRIES)]
    return min(runs, key=lambda run: getattr(run, clock))


def two_pictures(renderer, spp, clock):
    """The seconds are those that a picture takes beyond one sample."""
    seconds, pictures = [], []
    for seed in (1, 2):
        start, _ = renderer.draw(SIZE, 1, seed)
        whole, out = renderer.draw(SIZE, spp, seed)
        seconds.append((getattr(whole, clock) - getattr(start, clock)) * spp / (spp - 1))
        pictures.append(cost.read(out))
    return cost.Sitting(seconds, pictures)


def print_rows(voxels, options):
    woodcock = Woodcock(options, options.scene, voxels)
    renderers = {"woodcock": woodcock}
    if options.cycles:
        renderers["cycles"] = Cycles(options, woodcock)
    megabytes = woodcock.volume.stat().st_size / 1e6
    ours = None
    for name, renderer in renderers.items():
        first = first_picture(renderer, options.clock)
        load = f"{first.load:.2f}" if name == "woodcock" else ""
        row = (
            f"| {voxels}^3 | {megabytes:.0f} | {name} | {load} | {first.wall:.2f} "
            f"| {first.processor:.2f} | {first.memory / 1e9:.2f} "
        )
        if not options.first:
            spp = SAMPLES[name] // (4 if options.quick else 1)
            sitting = two_pictures(renderer, spp, options.clock)
            ours = ours or sitting
            blocks = cost.blocks_with_something(ours.pictures[0])
            row += f"| {sitting.time()[0] / spp:.3f} | {sitting.cost(blocks)[0]:.3g} "
            row += cost.beside(sitting, ours, blocks)[0].removesuffix("|")
        print(row + "|", flush=True)


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("woodcock", "scene", "scratch"):
        parser.add_argument(f"--{name}", type=pathlib.Path, required=True)
    parser.add_argument("--cycles", type=pathlib.Path)
    parser.add_argument("--threads", type=int, required=True)
    parser.add_argument("--clock", choices=("wall", "processor"), default="wall")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--first", action="store_true")
    parser.add_argument("voxels", nargs="+", type=int)
    return parser.parse_args()


def main():
    options = parse()
    print(f"{circumstances(options.threads)}; seconds of a sample: {options.clock}.\n")
    heads = ["voxels", "file, MB", "renderer", "reading, s", "first picture, s",
             "of the processor, s", "memory, GB"]
    if not options.first:
        heads += ["s a sample", "cost", "times Woodcock's cost", "mean / Woodcock's"]
    print(f"| {' | '.join(heads)} |\n" + "|---" * len(heads) + "|", flush=True)
    for voxels in options.voxels:
        print_rows(voxels, options)


if __name__ == "__main__":
    try:
        main()
    except Failed as failed:
        sys.exit(f"this failed: {failed}")
