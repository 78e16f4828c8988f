#include "assembler/registration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "assembler/column_pairs.hpp"
#include "geometry/enum_words.hpp"
#include "geometry/parallel_for.hpp"
#include "geometry/percentile.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/rigid_motion.hpp"

namespace tensegric_fit::assembler {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::PointCloud;
using geometry::PointTree;
using geometry::SmallMotion;

constexpr int kSteps = 20;
constexpr double kStill = 1e-5;        // m, of the largest motion in a step
constexpr int kFewestOfPair = 100;     // matches; a pair with fewer does not overlap
constexpr double kReach = 0.010;       // m, between the two points of a match
constexpr double kSameSide = 0.8;      // cosine between their normals
constexpr double kCut = 4.7;           // deviations, where Tukey's weight ends
constexpr double kLeastSpread = 1e-4;  // m, of residuals
constexpr double kExpected = 0.002;    // m, of a correction before anything was seen; fixes what all share
constexpr double kTrimmed = 0.8;       // share of the smallest residuals that are compared
constexpr double kNoticeable = 0.99;   // a fall of the residual that is more than luck

// Why not PCL's ICP: with normals, symmetric, trimmed, each column against all others in two rounds, it
// leaves 0.14 to 0.6 mm of 0.8 to 3.2 mm among four columns and 0.2 to 1.1 mm among eight, in 1 to 2 s for
// 200,000 points, since what a column is moved to is off itself. All columns in one system: 0.09 to 0.12 mm
// in every case, in 0.4 s.

/// Two points of two columns that seem to be one, after the motions so far.
struct Match {
  int a, b;
  Vector3d p, q;
  Vector3d normal;  // unit, of both
  double residual;  // normal . (p - q)
};

/// The points of column a that are looked for in column b.
struct Pair {
  int a, b;
  std::vector<int> points;
};

class Columns {
 public:
  Columns(const std::vector<PointCloud>& columns, std::vector<bool> signless)
      : columns_(columns),
        signless_(std::move(signless)),
        motion_(columns.size(), Isometry3d::Identity()),
        centre_(Vector3d::Zero()) {
    signless_.resize(columns.size());
    std::size_t count = 0;
    for (const PointCloud& column : columns) {
      trees_.push_back(column.points.empty() ? nullptr : std::make_unique<PointTree>(column.points));
      for (const Vector3d& p : column.points) centre_ += p;
      count += column.points.size();
    }
    centre_ /= static_cast<double>(std::max<std::size_t>(count, 1));
    find_pairs();
  }

  bool overlap() const { return !pairs_.empty(); }

  /// Largest shift that the step made anywhere within a metre of the centre.
  double step() {
    const std::vector<Match> found = matches(0);
    if (found.empty()) return 0;
    const Eigen::Index size = 6 * static_cast<Eigen::Index>(columns_.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(size, size) / (kExpected * kExpected);
    Eigen::VectorXd right(size);
    for (std::size_t c = 0; c < columns_.size(); ++c)
      right.segment<6>(6 * c) = -twist(motion_[c]) / (kExpected * kExpected);
    const double spread = spread_of(found);
    for (const Match& match : found) {
      const double relative = match.residual / (kCut * spread);
      if (std::abs(relative) >= 1) continue;
      const double weight = std::pow(1 - relative * relative, 2) / (spread * spread);
      // one radian about the centre counts as one metre
      const SmallMotion of_a = geometry::along_normal(match.p, centre_, match.normal),
                        of_b = -geometry::along_normal(match.q, centre_, match.normal);
      const Eigen::Index a = 6 * match.a, b = 6 * match.b;
      matrix.block<6, 6>(a, a) += weight * of_a * of_a.transpose();
      matrix.block<6, 6>(b, b) += weight * of_b * of_b.transpose();
      matrix.block<6, 6>(a, b) += weight * of_a * of_b.transpose();
      matrix.block<6, 6>(b, a) += weight * of_b * of_a.transpose();
      right.segment<6>(a) -= weight * match.residual * of_a;
      right.segment<6>(b) -= weight * match.residual * of_b;
    }
    const Eigen::VectorXd motion = matrix.ldlt().solve(right);
    for (std::size_t c = 0; c < columns_.size(); ++c) move(c, motion.segment<6>(6 * c));
    return motion.cwiseAbs().maxCoeff();
  }

  /// Trimmed mean of the matches that no step uses; 0 where there are none.
  double residual() const {
    std::vector<double> sizes;
    for (const Match& match : matches(1)) sizes.push_back(std::abs(match.residual));
    std::sort(sizes.begin(), sizes.end());
    sizes.resize(static_cast<std::size_t>(kTrimmed * static_cast<double>(sizes.size())));
    double sum = 0;
    for (const double size : sizes) sum += size;
    return sizes.empty() ? 0 : sum / static_cast<double>(sizes.size());
  }

  const std::vector<Isometry3d>& motions() const { return motion_; }
  SmallMotion motion_of(std::size_t column) const { return twist(motion_[column]); }

 private:
  void find_pairs() {
    const ColumnPairs near = column_pairs(columns_, kReach);
    for (const auto& [a, b] : near.pairs) pairs_.push_back({a, b, {}});
    geometry::parallel_for(pairs_.size(), [&](std::size_t begin, std::size_t end, int) {
      for (std::size_t p = begin; p < end; ++p) choose_points(pairs_[p], near.searches);
    });
    pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(),
                                [](const Pair& pair) { return pair.points.size() < kFewestOfPair; }),
                 pairs_.end());
  }

  /// Of the points that have a match, twice as many as a step is to look for: the others are for the check.
  void choose_points(Pair& pair, std::size_t most) const {
    const std::size_t points = columns_[pair.a].points.size(), stride = 1 + points / (4 * most);
    std::vector<int> matched;
    Match match;
    for (std::size_t i = 0; i < points; i += stride)
      if (find(pair, static_cast<int>(i), match)) matched.push_back(static_cast<int>(i));
    const std::size_t every = 1 + matched.size() / (2 * most);
    for (std::size_t i = 0; i < matched.size(); i += every) pair.points.push_back(matched[i]);
  }

  /// Every other point, the first or the second of two.
  std::vector<Match> matches(std::size_t first) const {
    std::vector<Match> found[2];
    geometry::parallel_for(pairs_.size(), [&](std::size_t begin, std::size_t end, int half) {
      Match match;
      for (std::size_t p = begin; p < end; ++p)
        for (std::size_t i = first; i < pairs_[p].points.size(); i += 2)
          if (find(pairs_[p], pairs_[p].points[i], match)) found[half].push_back(match);
    });
    found[0].insert(found[0].end(), found[1].begin(), found[1].end());
    return std::move(found[0]);
  }

  bool find(const Pair& pair, int i, Match& match) const {
    const PointCloud &from = columns_[pair.a], &to = columns_[pair.b];
    const Isometry3d &by = motion_[pair.a], &back = motion_[pair.b];
    const Vector3d p = by * from.points[i], normal_p = by.linear() * from.normals[i];
    const int nearest = trees_[pair.b]->nearest(back.inverse() * p);
    const Vector3d q = back * to.points[nearest];
    Vector3d normal_q = back.linear() * to.normals[nearest];
    if ((signless_[pair.a] || signless_[pair.b]) && normal_p.dot(normal_q) < 0) normal_q = -normal_q;
    if (!((p - q).squaredNorm() <= kReach * kReach && normal_p.dot(normal_q) >= kSameSide)) return false;
    match = {pair.a, pair.b, p, q, (normal_p + normal_q).normalized(), 0};
    match.residual = match.normal.dot(p - q);
    return true;
  }

  static double spread_of(const std::vector<Match>& found) {
    std::vector<double> sizes;
    for (const Match& match : found) sizes.push_back(std::abs(match.residual));
    return std::max(kLeastSpread, geometry::robust_deviation(sizes));
  }

  SmallMotion twist(const Isometry3d& motion) const {
    const Eigen::AngleAxisd turn(motion.linear());
    SmallMotion result;
    result << turn.angle() * turn.axis(), motion * centre_ - centre_;
    return result;
  }

  void move(std::size_t column, const SmallMotion& motion) {
    motion_[column] = geometry::motion_about(centre_, motion) * motion_[column];
  }

  const std::vector<PointCloud>& columns_;
  std::vector<bool> signless_;
  std::vector<std::unique_ptr<PointTree>> trees_;
  std::vector<Isometry3d> motion_;
  Vector3d centre_;
  std::vector<Pair> pairs_;
};

}  // namespace

std::string to_string(RegistrationStatus status) {
  static constexpr geometry::EnumWords<RegistrationStatus, 4> kWords{
      {"refined", "no_overlap", "not_better", "too_far"}};
  return kWords.of(status);
}

Registration register_columns(const std::vector<PointCloud>& columns, const RegistrationOptions& options,
                              const std::vector<bool>& signless) {
  geometry::check_option("max_shift", options.max_shift, kMaxShift);
  geometry::check_option("max_turn", options.max_turn, kMaxTurn);
  Registration result;
  result.corrections.assign(columns.size(), Isometry3d::Identity());
  Columns moving(columns, signless);
  if (!moving.overlap()) return result;
  result.residual_before = result.residual_after = moving.residual();
  for (int step = 0; step < kSteps; ++step)
    if (moving.step() < kStill) break;
  const double residual = moving.residual();
  bool near = true;
  double worst = 0;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const SmallMotion motion = moving.motion_of(c);
    const double turn = motion.head<3>().norm(), shift = motion.tail<3>().norm();
    if (turn <= options.max_turn && shift <= options.max_shift) continue;
    near = false;
    // As a share of what is allowed; where that is nothing, as a share of itself.
    const double excess =
        std::max(turn / std::max(options.max_turn, 1e-6), shift / std::max(options.max_shift, 1e-6));
    if (excess <= worst) continue;
    worst = excess;
    result.farthest = static_cast<int>(c);
    result.farthest_turn = turn;
    result.farthest_shift = shift;
  }
  if (!near) {
    result.status = RegistrationStatus::too_far;
  } else if (!(residual < kNoticeable * result.residual_before)) {
    result.status = RegistrationStatus::not_better;
  } else {
    result.status = RegistrationStatus::refined;
    result.residual_after = residual;
    result.corrections = moving.motions();
  }
  return result;
}

}  // namespace tensegric_fit::assembler
