# SPDX-License-Identifier: Apache-2.0
"""What a noise costs, from two pictures of one scene that differ in their seeds only.

The cost is seconds x relative variance of a pixel. It needs no reference, and more samples do not
change it. A picture is a list of rows of grey pixels.
"""

import dataclasses
import math
from statistics import fmean, median

BLOCK = 8  # pixels; the relative variance of a block is that of its pixels over its mean squared
SEEN = 2e-4  # a pixel shows something if it differs by more than this from the background
# Means that differ by less are of the same scene, however small the noise is.
SAME = 0.005


def read(path):
    """The mean of red, green and blue."""
    import OpenImageIO as oiio

    image = oiio.ImageBuf(str(path))
    pixels = image.get_pixels(oiio.FLOAT)
    if image.has_error or pixels is None:
        raise SystemExit(f"cannot read {path}: {image.geterror()}")
    return pixels[..., :3].astype(float).mean(2).tolist()


def blocks_of(picture):
    """The pixels (x, y) of each whole block."""
    height, width = len(picture), len(picture[0])
    return [
        [(x + i, y + j) for j in range(BLOCK) for i in range(BLOCK)]
        for y in range(0, height - BLOCK + 1, BLOCK)
        for x in range(0, width - BLOCK + 1, BLOCK)
    ]


def blocks_with_something(picture):
    """Blocks most of whose pixels differ from the background, the median of the top four rows."""
    background = median(value for row in picture[:4] for value in row)

    def shows(x, y):
        return abs(picture[y][x] - background) > SEEN * abs(background)

    return [block for block in blocks_of(picture) if sum(shows(*p) for p in block) > BLOCK**2 / 2]


def relative_variance(first, second, blocks):
    """Of a pixel, as the mean over the blocks; and its standard error."""
    values, squared_errors = [], []
    for block in blocks:
        mean = fmean((first[y][x] + second[y][x]) / 2 for x, y in block)
        variances = [(first[y][x] - second[y][x]) ** 2 / 2 for x, y in block]
        variance = fmean(variances)
        spread = sum((v - variance) ** 2 for v in variances) / (len(block) - 1)
        values.append(variance / mean**2)
        squared_errors.append(spread / len(block) / mean**4)
    return fmean(values), math.sqrt(sum(squared_errors)) / len(values)


def mean_of(first, second):
    """Of both pictures, and its standard error, which their difference tells."""
    pixels = [pair for rows in zip(first, second) for pair in zip(*rows)]
    mean = fmean((a + b) / 2 for a, b in pixels)
    return mean, math.sqrt(sum((a - b) ** 2 / 4 for a, b in pixels)) / len(pixels)


def ratio(a, b):
    """Of two values with standard errors, with its standard error."""
    value = a[0] / b[0]
    return value, abs(value) * math.hypot(a[1] / a[0], b[1] / b[0])


@dataclasses.dataclass
class Sitting:
    """What a renderer made of a scene."""

    seconds: list  # for each of two seeds
    pictures: list

    def time(self):
        """Seconds of a picture, and their standard error."""
        a, b = self.seconds
        return (a + b) / 2, abs(a - b) / 2

    def cost(self, blocks):
        time, variance = self.time(), relative_variance(*self.pictures, blocks)
        value = time[0] * variance[0]
        return value, value * math.hypot(time[1] / time[0], variance[1] / variance[0])

    def mean(self):
        return mean_of(*self.pictures)


def beside(theirs, ours, blocks):
    """The ends of a table's row, "| times our cost | their mean / ours |", empty for ourselves; and
    whether both drew the same scene."""
    if theirs is ours:
        return "| | |", True
    times, times_error = ratio(theirs.cost(blocks), ours.cost(blocks))
    mean, mean_error = ratio(theirs.mean(), ours.mean())
    same = abs(mean - 1) <= max(4 * mean_error, SAME)
    row = f"| {times:.2f} +- {times_error:.2f} | {mean:.5f} +- {mean_error:.5f}"
    return row + (" |" if same else " **differs** |"), same
