# SPDX-License-Identifier: Apache-2.0
"""Tests of tests/bench/peers/cost.py: python3 peers_cost.py DIRECTORY_OF_COST"""
import math
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv.pop(1))

import cost

SIZE = 32


def picture(value):
    """A background of 1 in the upper half; below, what value(x, y) says."""
    return [[value(x, y) if y >= SIZE // 2 else 1.0 for x in range(SIZE)] for y in range(SIZE)]


class Cost(unittest.TestCase):
    def pair(self, mean, deviation):
        """Two pictures that lie as far above and below the mean as deviation(x, y) says."""
        return [picture(lambda x, y: mean + sign * deviation(x, y)) for sign in (1, -1)]

    def test_only_blocks_that_show_something_count(self):
        blocks = cost.blocks_with_something(picture(lambda x, y: 3.0 if x < 16 else 1.0001))
        corners = {block[0] for block in blocks}
        self.assertEqual(corners, {(x, y) for x in (0, 8) for y in (16, 24)})
        # Half of a block's pixels are not most of them.
        self.assertEqual(cost.blocks_with_something(picture(lambda x, y: 1 + 2 * (x % 2))), [])

    def test_variance_of_equal_deviations(self):
        first, second = self.pair(4.0, lambda x, y: 0.5)
        blocks = cost.blocks_with_something(first)
        value, error = cost.relative_variance(first, second, blocks)
        # (a - b)^2 / 2 = 2 x 0.5^2, over 4^2; every pixel says the same.
        self.assertAlmostEqual(value, 2 * 0.25 / 16, places=12)
        self.assertAlmostEqual(error, 0, places=12)

    def test_error_of_the_variance(self):
        first, second = self.pair(2.0, lambda x, y: 0.1 if x % 2 else 0.3)
        blocks = cost.blocks_with_something(first)
        self.assertEqual(len(blocks), 8)
        value, error = cost.relative_variance(first, second, blocks)
        # Half of the pixels have a variance of 0.02 and half of 0.18, so they deviate by 0.08.
        self.assertAlmostEqual(value, 0.1 / 4, places=12)
        of_block = math.sqrt(0.08**2 * 64 / 63 / 64) / 4
        self.assertAlmostEqual(error, of_block / math.sqrt(8), places=12)

    def test_each_block_is_relative_to_its_own_mean(self):
        pictures = [
            picture(lambda x, y: (2.0 if x < 16 else 8.0) * (1 + sign * 0.25)) for sign in (1, -1)
        ]
        value, _ = cost.relative_variance(*pictures, cost.blocks_of(pictures[0])[8:])
        self.assertAlmostEqual(value, 2 * 0.25**2, places=12)

    def test_ratio_of_means(self):
        ours, theirs = self.pair(3.0, lambda x, y: 0.3), self.pair(7.0, lambda x, y: 0.0)
        mean, error = cost.mean_of(*ours)
        self.assertAlmostEqual(mean, (1 + 3) / 2, places=12)
        # The mean of two pixels has the variance (a - b)^2 / 4 = 0.3^2; half of them deviate.
        self.assertAlmostEqual(error, 0.3 * math.sqrt(0.5) / SIZE, places=12)
        value, its_error = cost.ratio(cost.mean_of(*theirs), (mean, error))
        self.assertAlmostEqual(value, 2, places=12)
        self.assertAlmostEqual(its_error, 2 * error / mean, places=12)

    def test_cost_beside_ours(self):
        ours = cost.Sitting([10.0, 10.0], self.pair(3.0, lambda x, y: 0.3))
        theirs = cost.Sitting([19.0, 21.0], self.pair(3.0, lambda x, y: 0.6))
        blocks = cost.blocks_with_something(ours.pictures[0])
        self.assertAlmostEqual(ours.cost(blocks)[0], 10 * 2 * 0.1**2, places=12)
        # Twice the time and four times the variance; the time is known to 1 in 20.
        row, same = cost.beside(theirs, ours, blocks)
        self.assertTrue(row.startswith("| 8.00 +- 0.40 | 1.00000 +- "), row)
        self.assertTrue(same)
        self.assertEqual(cost.beside(ours, ours, blocks), ("| | |", True))

    def test_other_scenes_are_told_apart(self):
        ours = cost.Sitting([1.0, 1.0], self.pair(3.0, lambda x, y: 0.001))
        blocks = cost.blocks_with_something(ours.pictures[0])
        brighter = cost.Sitting([1.0, 1.0], self.pair(3.05, lambda x, y: 0.001))
        row, same = cost.beside(brighter, ours, blocks)  # 2.025 / 2
        self.assertIn("| 1.01250 +- 0.00002 **differs** |", row)
        self.assertFalse(same)
        # By no more than four standard errors: 3.05 may be 3.
        noisy = cost.Sitting([1.0, 1.0], self.pair(3.05, lambda x, y: 0.5))
        self.assertTrue(cost.beside(noisy, ours, blocks)[1])


if __name__ == "__main__":
    unittest.main()
