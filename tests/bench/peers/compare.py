# SPDX-License-Identifier: Apache-2.0
"""Draws scenes by Woodcock and by its peers, in turn, and prints a table of costs in Markdown.

tests/bench/peers.sh prepares all that it needs, and calls it.
"""

import argparse
import pathlib
import sys

import cost
from measure import Failed, circumstances, run

HERE = pathlib.Path(__file__).parent
SEEDS = (1, 2)
# Samples of a pixel: as many as take each renderer some tens of seconds on two cores.
SAMPLES = {
    "thin": {"woodcock": 2048, "mitsuba": 1024, "cycles": 1024},
    "cloud": {"woodcock": 128, "mitsuba": 64, "cycles": 64},
    "chromatic": {"woodcock": 512, "cycles": 256},
    "overlap": {"woodcock": 512, "cycles": 256},
    "fire": {"woodcock": 512, "cycles": 256},
    "tea": {"woodcock": 512, "mitsuba": 1024, "cycles": 512},
    "lamp": {"woodcock": 512, "mitsuba": 512, "cycles": 256},
}


class Renderers:
    def __init__(self, options):
        self.options = options

    def command(self, renderer, scene, spp, seed, out):
        file, threads = self.options.scenes / f"{scene}.toml", self.options.threads
        ours = ["-o", out, "--spp", spp, "--seed", seed, "--threads", threads, "--quiet"]
        if renderer == "woodcock":
            return [self.options.woodcock, "render", file, *ours]
        if renderer == "cycles":
            return [self.options.woodcock, "cycles", file, *ours, "--blender", self.options.cycles]
        driver = HERE / "render_in_mitsuba.py"
        return [self.options.mitsuba, driver, file, spp, seed, out, threads]

    def draw(self, renderer, scene, spp, seed):
        out = self.options.scenes / f"{scene}.{renderer}.{seed}.exr"
        return run(self.command(renderer, scene, spp, seed, out)), out

    def versions(self):
        bpy = "import bpy; print(bpy.app.version_string)"
        mitsuba = "import mitsuba; print(mitsuba.__version__)"
        return {
            "Woodcock": run([self.options.woodcock, "version"]).said.splitlines()[0],
            "Cycles": run([self.options.cycles, "-c", bpy]).said.split()[-1],
            "Mitsuba": run([self.options.mitsuba, "-c", mitsuba]).said.strip() + " (LLVM)",
        }


def draw_all(renderers, scene, samples, clock):
    """By each renderer once unmeasured, as kernels are compiled and files come into memory. Then
    for each seed the renderers in turn, with one sample and with all. Returns the seconds that a
    render takes before it draws, and the sittings."""
    starts, seconds, pictures = ({name: [] for name in samples} for _ in range(3))
    for name in samples:
        renderers.draw(name, scene, 1, 0)
    for seed in SEEDS:
        for name, spp in samples.items():
            start, _ = renderers.draw(name, scene, 1, seed)
            whole, out = renderers.draw(name, scene, spp, seed)
            starts[name].append(getattr(start, clock))
            seconds[name].append((getattr(whole, clock) - starts[name][-1]) * spp / (spp - 1))
            pictures[name].append(cost.read(out))
    starts = {name: sum(times) / len(times) for name, times in starts.items()}
    return starts, {name: cost.Sitting(seconds[name], pictures[name]) for name in samples}


def rows_of(scene, samples, starts, sittings):
    """The rows of the table, and whether all drew the same scene."""
    ours, rows, all_same = sittings["woodcock"], [], True
    blocks = cost.blocks_with_something(ours.pictures[0])
    for name, sitting in sittings.items():
        end, same = cost.beside(sitting, ours, blocks)
        rows.append(
            f"| {scene} | {name} | {samples[name]} | {starts[name]:.1f} | {sitting.time()[0]:.1f} "
            f"| {sitting.cost(blocks)[0]:.3g} {end}"
        )
        all_same &= same
    return rows, all_same


def print_head(options, versions):
    print(f"{circumstances(options.threads)}; seconds: {options.clock}.")
    print(f"Volumes: {options.volumes}.")
    print("; ".join(f"{name}: {version}" for name, version in versions.items()) + ".\n")
    print("| scene | renderer | samples | start, s | seconds | cost | times Woodcock's cost "
          "| mean / Woodcock's |")
    print("|---|---|---|---|---|---|---|---|", flush=True)


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("woodcock", "cycles", "mitsuba", "scenes"):
        parser.add_argument(f"--{name}", type=pathlib.Path, required=True)
    parser.add_argument("--volumes", required=True)
    parser.add_argument("--threads", type=int, required=True)
    parser.add_argument("--clock", choices=("wall", "processor"), default="wall")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("scene", nargs="*", metavar="SCENE")
    options = parser.parse_args()
    options.scene = options.scene or list(SAMPLES)
    unknown = [scene for scene in options.scene if scene not in SAMPLES]
    if unknown:
        parser.error(f"no scene {unknown[0]!r}; there are: {', '.join(SAMPLES)}")
    return options


def main():
    options = parse()
    renderers, all_same = Renderers(options), True
    print_head(options, renderers.versions())
    for scene in options.scene:
        samples = {
            name: spp // 4 if options.quick else spp for name, spp in SAMPLES[scene].items()
        }
        rows, same = rows_of(
            scene, samples, *draw_all(renderers, scene, samples, options.clock)
        )
        print("\n".join(rows), flush=True)
        all_same &= same
    return 0 if all_same else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failed as failed:
        sys.exit(f"this failed: {failed}")
