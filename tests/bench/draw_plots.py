# SPDX-License-Identifier: Apache-2.0
"""Draws cost.png and agreement.png from the CSV files beside this script. Needs matplotlib.

The numbers are explained in README.md, with what they were measured on.
"""

import csv
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

HERE = pathlib.Path(__file__).parent
WIDTH, HEIGHT = 7.2, 2.9  # inches
COLOUR_OF = {"Cycles 5.0": "#d95f02", "Mitsuba 3.9 (LLVM)": "#1f78b4"}
CHANNELS = {"r": "#c0392b", "g": "#2e8b57", "b": "#2c5fa8"}
SITTING_TO_SITTING = 0.3  # how far a ratio has moved between measurements, as a share of it


def rows_of(name):
    with open(HERE / name, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def save(figure, axes, name):
    axes.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(HERE / name, dpi=140, metadata={"Software": None})
    plt.close(figure)


def draw_cost():
    rows = rows_of("cost.csv")[::-1]
    ratios = [float(row["ratio"]) for row in rows]
    figure, axes = plt.subplots(figsize=(WIDTH, HEIGHT))
    axes.barh(
        [row["scene"] for row in rows],
        ratios,
        xerr=[SITTING_TO_SITTING * ratio for ratio in ratios],
        color=[COLOUR_OF[row["other"]] for row in rows],
        error_kw={"capsize": 3, "ecolor": "#333333", "lw": 1},
        height=0.62,
    )
    axes.axvline(1, color="black", lw=1)
    axes.set_xscale("log")
    axes.set_xlim(0.6, 120)
    axes.set_xticks([1, 3, 10, 30, 100], ["1 (Woodcock)", "3", "10", "30", "100"])
    axes.minorticks_off()
    axes.set_xlabel("time to the same noise, as a multiple of Woodcock's")
    bars = [plt.Rectangle((0, 0), 1, 1, color=colour) for colour in COLOUR_OF.values()]
    axes.legend(bars, COLOUR_OF, frameon=False, fontsize=8, loc="lower right")
    save(figure, axes, "cost.png")


def draw_agreement():
    rows = rows_of("agreement.csv")
    figure, axes = plt.subplots(figsize=(WIDTH, HEIGHT))
    for offset, (channel, colour) in zip((-0.2, 0, 0.2), CHANNELS.items()):
        axes.errorbar(
            [i + offset for i in range(len(rows))],
            [100 * (float(row[channel]) - 1) for row in rows],
            yerr=[200 * float(row["error " + channel]) for row in rows],
            fmt="o", ms=3, lw=1, capsize=2, color=colour,
        )
    axes.axhline(0, color="black", lw=1)
    axes.set_xticks(range(len(rows)), [row["scene"] for row in rows], rotation=35, ha="right")
    axes.set_ylabel("Cycles 5.0 - Woodcock, %\n(bars: 2 standard errors)", fontsize=8)
    axes.set_ylim(-0.48, 0.48)
    save(figure, axes, "agreement.png")


if __name__ == "__main__":
    draw_cost()
    draw_agreement()
