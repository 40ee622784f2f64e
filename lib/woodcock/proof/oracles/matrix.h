// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace woodcock::oracle {

/// A square matrix, row by row.
class Matrix {
public:
    explicit Matrix(std::size_t size) : size_(size), values_(size * size) {}
    static Matrix diagonal(const std::vector<double>& values);

    std::size_t size() const { return size_; }
    double& operator()(std::size_t row, std::size_t column) {
        return values_[row * size_ + column];
    }
    double operator()(std::size_t row, std::size_t column) const {
        return values_[row * size_ + column];
    }
    double* row(std::size_t i) { return values_.data() + i * size_; }
    const double* row(std::size_t i) const { return values_.data() + i * size_; }

    std::vector<double> rowSums() const;

private:
    std::size_t size_;
    std::vector<double> values_;
};

Matrix operator*(const Matrix& a, const Matrix& b);
Matrix operator+(Matrix a, const Matrix& b);
/// 1 - a
Matrix oneMinus(Matrix a);
/// Each column times its factor.
Matrix scaleColumns(Matrix a, const std::vector<double>& factors);
/// The X of a X = b, by Gaussian elimination with partial pivoting.
Matrix solve(Matrix a, Matrix b);

}  // namespace woodcock::oracle
