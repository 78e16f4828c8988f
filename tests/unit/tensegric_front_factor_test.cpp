// The block factorisation against dense algebra, on matrices that need no pivoting.
#include "tensegric/front_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "tensegric/node_matrix.hpp"
#include "tensegric/rank_update.hpp"

namespace tensegric_fit::tensegric {
namespace {

class Lot {
 public:
  explicit Lot(unsigned seed) : random_(seed) {}
  double number() { return 2 * (static_cast<double>(random_()) / 4294967296.0) - 1; }
  int below(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }

 private:
  std::mt19937 random_;
};

using Pairs = std::vector<std::pair<int, int>>;

// A chain, so that it hangs together, and as many pairs again drawn at random.
Pairs joined_by_lot(int nodes, Lot& lot) {
  Pairs pairs;
  for (int i = 1; i < nodes; ++i) pairs.emplace_back(i - 1, i);
  for (int i = 0; i < nodes; ++i) {
    const int a = lot.below(nodes), b = lot.below(nodes);
    if (a != b) pairs.emplace_back(a, b);
  }
  return pairs;
}

// Diagonally dominant with diagonal entries of either sign: indefinite, and no pivot comes near zero.
void fill(NodeMatrix& matrix, const Pairs& pairs, double share_negative, Lot& lot) {
  matrix.clear();
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(3 * matrix.nodes());
  for (const auto& [a, b] : pairs) {
    Eigen::Matrix3d block;
    for (int k = 0; k < 9; ++k) block(k / 3, k % 3) = lot.number();
    matrix.add(a, b, block);
    rows.segment<3>(3 * a) += block.cwiseAbs().rowwise().sum();
    rows.segment<3>(3 * b) += block.cwiseAbs().colwise().sum().transpose();
  }
  for (int i = 0; i < matrix.nodes(); ++i) {
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    for (int k = 0; k < 3; ++k)
      block(k, k) = (lot.number() < 2 * share_negative - 1 ? -1 : 1) * (1 + rows[3 * i + k]);
    matrix.add(i, i, block);
  }
}

Eigen::MatrixXd dense(const NodeMatrix& matrix) {
  return Eigen::MatrixXd(matrix.lower()).selfadjointView<Eigen::Lower>();
}

// Whatever version the processor gets: to the bit what one term after the other gives.
TEST(RankUpdate, IsTheSumInOrder) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 1);
  const auto any = [&](Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd(Eigen::MatrixXd::NullaryExpr(
        rows, columns, [&](Eigen::Index, Eigen::Index) { return normal(random); }));
  };
  for (Eigen::Index rows = 1; rows <= 27; ++rows)
    for (const Eigen::Index terms : {1, 5, 48}) {
      const Eigen::Index padded = (rows + kTileRows - 1) / kTileRows * kTileRows;
      const Eigen::MatrixXd a = any(padded, terms), b = any(padded, terms), all = any(rows + 3, rows + 2);
      Eigen::MatrixXd updated = all;
      subtract_product(a, b, updated.bottomRightCorner(rows, rows));
      EXPECT_EQ(updated.topRows(3), all.topRows(3)) << "beside it";
      EXPECT_EQ(updated.leftCols(2), all.leftCols(2)) << "beside it";
      for (Eigen::Index j = 0; j < rows; ++j)
        for (Eigen::Index i = j; i < rows; ++i) {
          double sum = 0;
          for (Eigen::Index k = 0; k < terms; ++k) sum += a(i, k) * b(j, k);
          EXPECT_EQ(updated(3 + i, 2 + j), all(3 + i, 2 + j) - sum) << rows << " " << terms;
        }
    }
}

TEST(NodeMatrix, AddsAnOuterProductBlockByBlock) {
  const std::vector<std::pair<int, int>> pairs = {{0, 1}, {0, 3}, {1, 3}, {1, 2}, {3, 4}};
  NodeMatrix whole(5, pairs), by_block(5, pairs);
  const std::vector<int> nodes = {0, 1, 3};
  const std::vector<Eigen::Vector3d> at_nodes = {{1, -2, 3}, {0.5, 4, -1}, {-3, 0.25, 2}};
  whole.add_outer(nodes, at_nodes, 0.7);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      by_block.add(nodes[i], nodes[j], 0.7 * at_nodes[i] * at_nodes[j].transpose());
  EXPECT_LE((Eigen::MatrixXd(whole.lower()) - Eigen::MatrixXd(by_block.lower())).norm(), 1e-14);
  EXPECT_GT(Eigen::MatrixXd(whole.lower()).norm(), 1);
}

TEST(FrontFactor, SolvesAsDenseAlgebraDoes) {
  Lot lot(1);
  for (int nodes : {1, 2, 3, 7, 20, 60, 150}) {
    for (double share_negative : {0.0, 0.1, 0.5, 1.0}) {
      const Pairs pairs = joined_by_lot(nodes, lot);
      NodeMatrix matrix(nodes, pairs);
      FrontFactor factor(matrix);
      for (int again = 0; again < 2; ++again) {  // other values, same pattern
        fill(matrix, pairs, share_negative, lot);
        ASSERT_TRUE(factor.factorise(matrix));
        const Eigen::MatrixXd whole = dense(matrix);
        const Eigen::MatrixXd right =
            Eigen::MatrixXd::NullaryExpr(3 * nodes, 4, [&lot] { return lot.number(); });
        const Eigen::MatrixXd solution = factor.solve(right);
        // Condition below 1e3, 450 unknowns: some 1e-13 of rounding.
        EXPECT_LE((whole * solution - right).cwiseAbs().maxCoeff(), 1e-12) << nodes;
        EXPECT_LE((solution - whole.fullPivLu().solve(right)).cwiseAbs().maxCoeff(), 1e-12) << nodes;
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(whole, Eigen::EigenvaluesOnly);
        EXPECT_EQ(factor.negative_pivots(), (eigen.eigenvalues().array() < 0).count()) << nodes;
      }
    }
  }
}

// Fronts wider than a panel, children with several levels: a grid of 30 x 30 nodes with diagonals.
TEST(FrontFactor, SolvesOnAGrid) {
  Lot lot(2);
  const int side = 30;
  Pairs pairs;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      if (i > 0) pairs.emplace_back(j * side + i, j * side + i - 1);
      if (j > 0) pairs.emplace_back(j * side + i, (j - 1) * side + i);
      if (i > 0 && j > 0) pairs.emplace_back(j * side + i, (j - 1) * side + i - 1);
    }
  }
  NodeMatrix matrix(side * side, pairs);
  fill(matrix, pairs, 0.3, lot);
  FrontFactor factor(matrix);
  ASSERT_TRUE(factor.factorise(matrix));
  const Eigen::MatrixXd right = Eigen::MatrixXd::Ones(3 * side * side, 2), solution = factor.solve(right);
  const Eigen::SparseMatrix<double> whole = matrix.lower().selfadjointView<Eigen::Lower>();
  EXPECT_LE((whole * solution - right).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(FrontFactor, SaysWhereThereIsNoSolution) {
  NodeMatrix matrix(2, {{0, 1}});
  FrontFactor factor(matrix);
  EXPECT_FALSE(factor.factorise(matrix));  // all zero
  matrix.add_to_diagonal(1);
  EXPECT_TRUE(factor.factorise(matrix));
  matrix.add(1, 0, Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(factor.factorise(matrix));
}

}  // namespace
}  // namespace tensegric_fit::tensegric
