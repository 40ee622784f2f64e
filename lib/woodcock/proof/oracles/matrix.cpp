// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/matrix.h"

#include <algorithm>
#include <cmath>

namespace woodcock::oracle {

namespace {

/// to[i] -= factor * from[i]
void subtract(double* to, const double* from, double factor, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) to[i] -= factor * from[i];
}

}  // namespace

Matrix Matrix::diagonal(const std::vector<double>& values) {
    Matrix m(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) m(i, i) = values[i];
    return m;
}

std::vector<double> Matrix::rowSums() const {
    std::vector<double> sums(size_);
    for (std::size_t i = 0; i < size_; ++i)
        for (std::size_t j = 0; j < size_; ++j) sums[i] += (*this)(i, j);
    return sums;
}

Matrix operator*(const Matrix& a, const Matrix& b) {
    const std::size_t n = a.size();
    Matrix product(n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < n; ++k) subtract(product.row(i), b.row(k), -a(i, k), n);
    return product;
}

Matrix operator+(Matrix a, const Matrix& b) {
    for (std::size_t i = 0; i < a.size(); ++i) subtract(a.row(i), b.row(i), -1, a.size());
    return a;
}

Matrix oneMinus(Matrix a) {
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < a.size(); ++j) a(i, j) = (i == j ? 1 : 0) - a(i, j);
    return a;
}

Matrix scaleColumns(Matrix a, const std::vector<double>& factors) {
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < a.size(); ++j) a(i, j) *= factors[j];
    return a;
}

Matrix solve(Matrix a, Matrix b) {
    const std::size_t n = a.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < n; ++i)
            if (std::abs(a(i, k)) > std::abs(a(pivot, k))) pivot = i;
        if (pivot != k) {
            std::swap_ranges(a.row(k), a.row(k) + n, a.row(pivot));
            std::swap_ranges(b.row(k), b.row(k) + n, b.row(pivot));
        }
        for (std::size_t i = k + 1; i < n; ++i) {
            const double factor = a(i, k) / a(k, k);
            subtract(a.row(i) + k, a.row(k) + k, factor, n - k);
            subtract(b.row(i), b.row(k), factor, n);
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = 0; j < n; ++j) b(k, j) /= a(k, k);
        for (std::size_t i = 0; i < k; ++i) subtract(b.row(i), b.row(k), a(i, k), n);
    }
    return b;
}

}  // namespace woodcock::oracle
