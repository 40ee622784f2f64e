// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/matrix.h"

#include <gtest/gtest.h>

#include <random>

namespace woodcock::oracle {

using namespace oracle;

namespace {

Matrix filled(std::size_t size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Matrix m(size);
    for (std::size_t i = 0; i < size; ++i)
        for (std::size_t j = 0; j < size; ++j) m(i, j) = uniform(random);
    return m;
}

TEST(Matrix, MultipliesRowsByColumns) {
    const Matrix a = filled(5, 1), b = filled(5, 2), product = a * b;
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t j = 0; j < 5; ++j) {
            double sum = 0;
            for (std::size_t k = 0; k < 5; ++k) sum += a(i, k) * b(k, j);
            EXPECT_NEAR(product(i, j), sum, 1e-15);
        }
}

TEST(Matrix, SolvesWithPivots) {
    for (const std::size_t size : {1u, 2u, 7u, 65u}) {
        Matrix a = filled(size, 3);
        if (size > 1) a(0, 0) = 0;
        const Matrix b = filled(size, 4), product = a * solve(a, b);
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t j = 0; j < size; ++j) EXPECT_NEAR(product(i, j), b(i, j), 1e-11);
    }
}

TEST(Matrix, ScalesAddsAndSums) {
    const Matrix a = filled(3, 5), scaled = scaleColumns(a, {1, 2, 3}),
                 sum = Matrix::diagonal({4, 5, 6}) + a, rest = oneMinus(a);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(a.rowSums()[i], a(i, 0) + a(i, 1) + a(i, 2));
        for (std::size_t j = 0; j < 3; ++j) {
            EXPECT_EQ(scaled(i, j), a(i, j) * static_cast<double>(j + 1));
            EXPECT_EQ(sum(i, j), a(i, j) + (i == j ? static_cast<double>(i + 4) : 0));
            EXPECT_EQ(rest(i, j), (i == j ? 1 : 0) - a(i, j));
        }
    }
}

}  // namespace
}  // namespace woodcock::oracle
