#include "tensegric/front_factor.hpp"

#include <Eigen/Dense>
#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "tensegric/rank_update.hpp"

namespace tensegric_fit::tensegric {
namespace {

constexpr int kPanel = 48;           // pivots at a time
constexpr double kMostZeros = 0.25;  // share of zeros that fronts may take in to become larger
constexpr int kSmallWidth = 4;       // nodes; below it they may take in more
constexpr double kMostZerosOfSmall = 0.5;

using Lists = std::vector<std::vector<int>>;

std::vector<int> least_degree(const NodeMatrix& pattern) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int c = 0; c < pattern.nodes(); ++c) {
    entries.emplace_back(c, c, 1);
    for (int r : pattern.below(c)) {
      entries.emplace_back(r, c, 1);
      entries.emplace_back(c, r, 1);
    }
  }
  Eigen::SparseMatrix<double> graph(pattern.nodes(), pattern.nodes());
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(graph, order);
  return {order.indices().data(), order.indices().data() + order.size()};
}

std::vector<int> inverse(const std::vector<int>& order) {
  std::vector<int> rank(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<int>(i);
  return rank;
}

// Of each node in its order, the later ones that it is joined to.
Lists later_neighbours(const NodeMatrix& pattern, const std::vector<int>& rank) {
  Lists later(rank.size());
  for (int c = 0; c < pattern.nodes(); ++c)
    for (int r : pattern.below(c)) later[std::min(rank[c], rank[r])].push_back(std::max(rank[c], rank[r]));
  return later;
}

// Columns of L by what each takes over from those that it is the first to follow; the tree of these.
std::vector<int> fill_in(Lists& columns) {
  const int count = static_cast<int>(columns.size());
  std::vector<int> parent(count, -1);
  Lists children(count);
  for (int j = 0; j < count; ++j) {
    std::vector<int>& rows = columns[j];
    for (int child : children[j]) rows.insert(rows.end(), columns[child].begin() + 1, columns[child].end());
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    if (rows.empty()) continue;
    parent[j] = rows.front();
    children[parent[j]].push_back(j);
  }
  return parent;
}

// Children right before their parents, so that nodes which belong together follow each other.
std::vector<int> postorder(const std::vector<int>& parent) {
  const int count = static_cast<int>(parent.size());
  Lists children(count + 1);
  for (int j = 0; j < count; ++j) children[parent[j] < 0 ? count : parent[j]].push_back(j);
  std::vector<int> order, stack{count};
  while (!stack.empty()) {  // parents first, then turned round
    const int j = stack.back();
    stack.pop_back();
    if (j < count) order.push_back(j);
    stack.insert(stack.end(), children[j].begin(), children[j].end());
  }
  std::reverse(order.begin(), order.end());
  return order;
}

double entries(double width, double rows) {
  return width * (width + 1) / 2 + width * rows;
}

}  // namespace

FrontFactor::FrontFactor(const NodeMatrix& pattern) : order_(least_degree(pattern)) {
  Lists columns = later_neighbours(pattern, inverse(order_));
  const std::vector<int> turn = postorder(fill_in(columns));
  std::vector<int> order;
  for (int j : turn) order.push_back(order_[j]);
  order_ = order;
  rank_ = inverse(order_);
  columns = later_neighbours(pattern, rank_);
  const std::vector<int> parent = fill_in(columns);
  find_fronts(columns, parent);
  place_sources(pattern);
  pivots_.resize(3 * pattern.nodes());
}

// A node joins the front before it where that is all that follows, or where few zeros are taken in.
void FrontFactor::find_fronts(const Lists& columns, const std::vector<int>& parent) {
  const int count = static_cast<int>(columns.size());
  std::vector<double> filled;  // of each front, entries that are not taken in
  for (int j = 0; j < count; ++j) {
    Front front{j, j, columns[j], {}, {}, {}};
    double own = entries(1, static_cast<double>(columns[j].size()));
    while (!fronts_.empty() && parent[fronts_.back().last] >= front.first &&
           parent[fronts_.back().last] <= front.last) {
      const double width = fronts_.back().width() + front.width();
      const double joined = entries(width, static_cast<double>(front.rows.size()));
      const double zeros = 1 - (own + filled.back()) / joined;
      if (zeros > (width <= kSmallWidth ? kMostZerosOfSmall : kMostZeros)) break;
      own += filled.back();
      front.first = fronts_.back().first;
      fronts_.pop_back();
      filled.pop_back();
    }
    fronts_.push_back(std::move(front));
    filled.push_back(own);
  }
  std::vector<int> front_of(count);
  for (std::size_t f = 0; f < fronts_.size(); ++f)
    for (int j = fronts_[f].first; j <= fronts_[f].last; ++j) front_of[j] = static_cast<int>(f);
  for (std::size_t f = 0; f < fronts_.size(); ++f)
    if (!fronts_[f].rows.empty())
      fronts_[front_of[fronts_[f].rows.front()]].children.push_back(static_cast<int>(f));
  local_.assign(count, 0);
}

void FrontFactor::place_sources(const NodeMatrix& pattern) {
  std::vector<std::vector<Source>> by_column(rank_.size());
  for (int c = 0; c < pattern.nodes(); ++c) {
    by_column[rank_[c]].push_back({c, -1, rank_[c], rank_[c], false});
    int rank = 0;
    for (int r : pattern.below(c)) {
      const bool turned = rank_[r] < rank_[c];
      const int to_column = std::min(rank_[r], rank_[c]), to_row = std::max(rank_[r], rank_[c]);
      by_column[to_column].push_back({c, rank++, to_row, to_column, turned});
    }
  }
  for (Front& front : fronts_) {
    for (std::size_t i = 0; i < front.rows.size(); ++i)
      local_[front.rows[i]] = front.width() + static_cast<int>(i);
    for (int j = front.first; j <= front.last; ++j) local_[j] = j - front.first;
    for (int j = front.first; j <= front.last; ++j)
      for (Source source : by_column[j]) {
        source.to_row = local_[source.to_row];
        source.to_column = local_[source.to_column];
        front.sources.push_back(source);
      }
  }
}

bool FrontFactor::factorise(const NodeMatrix& matrix) {
  std::vector<std::vector<double>> updates(fronts_.size());
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    Square dense = assemble(fronts_[f], matrix, updates);
    if (!eliminate(fronts_[f], dense)) return false;
    const Eigen::Index rest = 3 * static_cast<Eigen::Index>(fronts_[f].rows.size());
    updates[f] = spare(rest * rest);
    Square(updates[f].data(), rest, rest) = dense.bottomRightCorner(rest, rest);
  }
  return true;
}

std::vector<double> FrontFactor::spare(Eigen::Index count) {
  const auto needed = static_cast<std::size_t>(count);
  std::vector<double> taken;
  if (!spare_.empty()) {
    // the smallest that is large enough, or else the largest
    const auto better = [needed](const std::vector<double>& a, const std::vector<double>& b) {
      const bool a_will_do = a.capacity() >= needed, b_will_do = b.capacity() >= needed;
      return a_will_do != b_will_do ? a_will_do : (a.capacity() < b.capacity()) == a_will_do;
    };
    const auto best = std::min_element(spare_.begin(), spare_.end(), better);
    taken = std::move(*best);
    *best = std::move(spare_.back());
    spare_.pop_back();
  }
  taken.resize(needed);
  return taken;
}

FrontFactor::Square FrontFactor::assemble(const Front& front, const NodeMatrix& matrix,
                                          std::vector<std::vector<double>>& updates) {
  const Eigen::Index size = 3 * (front.width() + static_cast<Eigen::Index>(front.rows.size()));
  dense_.resize(std::max(dense_.size(), static_cast<std::size_t>(size * size)));
  Square dense(dense_.data(), size, size);
  dense.setZero();
  for (const Source& s : front.sources) {
    const auto block = matrix.block(s.column, s.rank);
    auto to = dense.block<3, 3>(3 * s.to_row, 3 * s.to_column);
    if (s.transposed)
      to = block.transpose();
    else
      to = block;
  }
  for (int j = front.first; j <= front.last; ++j) local_[j] = j - front.first;
  for (std::size_t i = 0; i < front.rows.size(); ++i)
    local_[front.rows[i]] = front.width() + static_cast<int>(i);
  for (int child : front.children) {
    const std::vector<int>& rows = fronts_[child].rows;
    const auto count = 3 * static_cast<Eigen::Index>(rows.size());
    const Square update(updates[child].data(), count, count);
    for (std::size_t b = 0; b < rows.size(); ++b)
      for (std::size_t a = b; a < rows.size(); ++a)
        dense.block<3, 3>(3 * local_[rows[a]], 3 * local_[rows[b]]) += update.block<3, 3>(3 * a, 3 * b);
    spare_.push_back(std::move(updates[child]));
  }
  return dense;
}

bool FrontFactor::eliminate(Front& front, Square& dense) {
  const Eigen::Index width = 3 * front.width(), size = dense.rows();
  for (Eigen::Index p = 0; p < width; p += kPanel) {
    const Eigen::Index end = std::min(p + kPanel, width), rest = size - end;
    for (Eigen::Index j = p; j < end; ++j) {
      const double pivot = dense(j, j);
      if (pivot == 0 || !std::isfinite(pivot)) return false;
      pivots_[3 * front.first + j] = pivot;
      for (Eigen::Index k = j + 1; k < end; ++k)
        dense.col(k).segment(k, end - k) -= dense(k, j) / pivot * dense.col(j).segment(k, end - k);
      dense.col(j).segment(j + 1, end - j - 1) /= pivot;
    }
    if (rest == 0) continue;
    const auto corner = dense.block(p, p, end - p, end - p);
    const Eigen::Index padded = (rest + kTileRows - 1) / kTileRows * kTileRows;
    scaled_.setZero(padded, end - p);  // L D
    scaled_.topRows(rest) = dense.block(end, p, rest, end - p);
    corner.triangularView<Eigen::UnitLower>().transpose().solveInPlace<Eigen::OnTheRight>(scaled_);
    below_ = scaled_ * pivots_.segment(3 * front.first + p, end - p).cwiseInverse().asDiagonal();
    dense.block(end, p, rest, end - p) = below_.topRows(rest);
    subtract_product(below_, scaled_, dense.bottomRightCorner(rest, rest));
  }
  front.factor = dense.leftCols(width);
  return true;
}

Eigen::MatrixXd FrontFactor::solve(const Eigen::MatrixXd& right) const {
  Eigen::MatrixXd x(right.rows(), right.cols());
  for (std::size_t i = 0; i < order_.size(); ++i)
    x.middleRows<3>(3 * static_cast<Eigen::Index>(i)) = right.middleRows<3>(3 * order_[i]);
  Eigen::MatrixXd touched;
  for (const Front& front : fronts_) {
    const Eigen::Index width = 3 * front.width();
    auto own = x.middleRows(3 * front.first, width);
    front.factor.topRows(width).triangularView<Eigen::UnitLower>().solveInPlace(own);
    touched.noalias() = front.factor.bottomRows(front.factor.rows() - width) * own;
    for (std::size_t i = 0; i < front.rows.size(); ++i)
      x.middleRows<3>(3 * front.rows[i]) -= touched.middleRows<3>(3 * static_cast<Eigen::Index>(i));
  }
  x.array().colwise() /= pivots_.array();
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    const Eigen::Index width = 3 * front->width();
    touched.resize(3 * static_cast<Eigen::Index>(front->rows.size()), right.cols());
    for (std::size_t i = 0; i < front->rows.size(); ++i)
      touched.middleRows<3>(3 * static_cast<Eigen::Index>(i)) = x.middleRows<3>(3 * front->rows[i]);
    auto own = x.middleRows(3 * front->first, width);
    own.noalias() -= front->factor.bottomRows(touched.rows()).transpose() * touched;
    front->factor.topRows(width).triangularView<Eigen::UnitLower>().transpose().solveInPlace(own);
  }
  Eigen::MatrixXd result(right.rows(), right.cols());
  for (std::size_t i = 0; i < order_.size(); ++i)
    result.middleRows<3>(3 * order_[i]) = x.middleRows<3>(3 * static_cast<Eigen::Index>(i));
  return result;
}

}  // namespace tensegric_fit::tensegric
