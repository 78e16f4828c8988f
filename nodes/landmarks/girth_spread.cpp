#include "landmarks/girth_spread.hpp"

#include <cmath>

#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kApart = 0.00125;  // m, between tapes
constexpr int kReach = 2;           // tapes each way
constexpr double kFillingOff = 0.005;
constexpr double kReachOfFlag = 0.006;  // m; a mesh of 62,000 triangles has an edge of that length

Vector3d middle_of(const Tape& tape) {
  Vector3d low = tape.front(), high = low;
  for (const Vector3d& p : tape) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (low + high) / 2;
}

// Share of the tape's length that lies on unseen skin.
double unseen_share(const BodyShape& body, const Tape& tape) {
  if (body.filled.empty()) return 0;
  double unseen = 0, all = 0;
  for (std::size_t i = 0; i < tape.size(); ++i) {
    const Vector3d &a = tape[i], &b = tape[(i + 1) % tape.size()];
    all += (b - a).norm();
    if (body.unseen((a + b) / 2, kReachOfFlag)) unseen += (b - a).norm();
  }
  return all > 0 ? unseen / all : 0;
}

}  // namespace

Tape parallel_tape(const BodyShape& body, const Tape& tape, double offset) {
  const Vector3d middle = middle_of(tape);
  Vector3d normal = Vector3d::Zero(), reach = Vector3d::Constant(0.02);
  for (std::size_t i = 0; i < tape.size(); ++i) {
    normal += (tape[i] - middle).cross(tape[(i + 1) % tape.size()] - middle);
    reach = reach.cwiseMax((tape[i] - middle).cwiseAbs() + Vector3d::Constant(0.02));
  }
  normal.normalize();
  Tape best;
  double nearest = reach.norm() / 2;
  for (const geometry::SectionLoop& loop :
       cut(body, triangles_in_box(body, middle - reach, middle + reach), middle + offset * normal, normal)) {
    if (!loop.closed || loop.points.size() < 10) continue;
    const double off = (middle_of(loop.points) - middle).norm();
    if (off >= nearest) continue;
    nearest = off;
    best = geometry::tape(loop.points, normal);
  }
  return best;
}

double half_width_of(const BodyShape& body, const std::function<Tape(double)>& tape_at) {
  double sum = 0, squares = 0;
  int count = 0;
  Tape here;
  for (int i = -kReach; i <= kReach; ++i) {
    Tape tape = tape_at(i * kApart);
    if (tape.size() < 3) continue;
    const double length = geometry::length_of(tape, true);
    sum += length;
    squares += length * length;
    ++count;
    if (i == 0) here = std::move(tape);
  }
  if (count < 2 || here.empty()) return 0;
  const double variance = std::max(squares / count - std::pow(sum / count, 2), 0.0) * count / (count - 1);
  const double holes = 2 * kPi * kFillingOff * unseen_share(body, here);
  return std::hypot(2 * std::sqrt(variance), holes);
}

}  // namespace tensegric_fit::landmarks
