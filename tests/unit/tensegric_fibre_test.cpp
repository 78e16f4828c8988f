// Bands whose points several nodes carry.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "geometry/status.hpp"
#include "tensegric/band_length.hpp"
#include "tensegric/solver.hpp"
#include "tensegric_bust.hpp"

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Vector3d;

GarmentLine by_points(double ratio) {
  GarmentLine line;
  line.name = "chest";
  line.ratio = ratio;
  line.points = {Vector3d::Zero(), Vector3d::UnitX()};  // where they lie is the laid line's business
  return line;
}

/// Points between the nodes of the chest line, each carried by both neighbours, in two fibres.
geometry::LaidLine between_nodes(const geometry::ControlMesh& control) {
  geometry::LaidLine laid{"chest", {}};
  const std::vector<int>& nodes = control.lines.front().nodes;
  for (const double at : {0.3, 0.6}) {
    geometry::Fibre fibre{at == 0.3 ? 0.75 : 0.25, {}};
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      const int a = std::min(nodes[i - 1], nodes[i]), b = std::max(nodes[i - 1], nodes[i]);
      fibre.points.push_back({(1 - at) * control.outer[a] + at * control.outer[b], {{a, 1 - at}, {b, at}}});
    }
    laid.fibres.push_back(fibre);
  }
  return laid;
}

TEST(Fibres, PointsThatAreNodesAreTheLineThroughThem) {
  const Model model = build_model(bust_mesh(), {});
  geometry::LaidLine laid{"chest", {{1, {}}}};
  for (const int node : model.control.lines.front().nodes)
    laid.fibres.front().points.push_back({model.control.outer[node], {{node, 1.0}}});
  Garment on_body{"body", {"bust"}, {by_points(0.93)}}, through{"nodes", {"bust"}, {by_points(0.93)}};
  through.lines.front().points.clear();
  const Solution a = solve(model, on_body, {}, nullptr, {}, {}, {laid});
  const Solution b = solve(model, through, {});
  ASSERT_EQ(a.status, Status::converged);
  for (std::size_t i = 0; i < a.outer.size(); ++i) EXPECT_EQ(a.outer[i], b.outer[i]);
}

TEST(Fibres, TheGradientIsThatOfTheLength) {
  const Model model = build_model(bust_mesh(), {});
  const Band band =
      lay_bands(model, {"body", {"bust"}, {by_points(0.95)}}, {between_nodes(model.control)}).front();
  Positions x = model.rest_positions();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-0.003, 0.003);
  for (Vector3d& p : x) p += Vector3d(jitter(random), jitter(random), jitter(random));
  std::vector<int> all(x.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(x.size()));
  add_length_gradient(band, x, all, 1, gradient);
  for (const int node : model.control.lines.front().nodes)
    for (int k = 0; k < 3; ++k) {
      const double step = 1e-6;
      Positions plus = x, minus = x;
      plus[node][k] += step;
      minus[node][k] -= step;
      // Central differences: step^2 times a third derivative of about 1 / (10 mm)^2, and rounding 1e-16 /
      // step.
      EXPECT_NEAR(gradient[3 * node + k], (length_of(band, plus) - length_of(band, minus)) / (2 * step),
                  1e-7);
    }
}

TEST(Fibres, TheSecondDerivativeIsThatOfTheLengthWhereNodesAreHeld) {
  const Model model = build_model(bust_mesh(), {});
  // Each point on two nodes of its own and, faintly, on those of its neighbours: segments overlap.
  geometry::LaidLine laid = between_nodes(model.control);
  for (geometry::Fibre& fibre : laid.fibres)
    for (std::size_t i = 1; i < fibre.points.size(); ++i) {
      std::map<int, double> mixed;
      for (const auto& [node, weight] : fibre.points[i].weights) mixed[node] += 0.8 * weight;
      for (const auto& [node, weight] : fibre.points[i - 1].weights) mixed[node] += 0.2 * weight;
      fibre.points[i].weights.assign(mixed.begin(), mixed.end());
    }
  const Band band = lay_bands(model, {"body", {"bust"}, {by_points(0.95)}}, {laid}).front();
  const Positions x = model.rest_positions();
  std::vector<int> free_index(x.size(), -1);
  int free = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (i % 4 != 0) free_index[i] = free++;
  const LengthCurvature curvature(band, free_index);
  NodeMatrix hessian(free, curvature.coupled_nodes());
  curvature.add(x, 2, hessian);

  const unsigned seed = std::random_device{}();
  const testing::ScopedTrace trace{__FILE__, __LINE__, "seed " + std::to_string(seed)};
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const Eigen::VectorXd way = Eigen::VectorXd::NullaryExpr(3 * free, [&] { return normal(random); });
  const auto gradient_at = [&](double step) {
    Positions y = x;
    for (std::size_t i = 0; i < y.size(); ++i)
      if (free_index[i] >= 0) y[i] += step * way.segment<3>(3 * free_index[i]);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(3 * free);
    add_length_gradient(band, y, free_index, 2, gradient);
    return gradient;
  };
  const double step = 1e-7;  // m: against segments of centimetres, and rounding
  const Eigen::VectorXd change = (gradient_at(step) - gradient_at(-step)) / (2 * step);
  const Eigen::VectorXd product = hessian.lower().selfadjointView<Eigen::Lower>() * way;
  EXPECT_GT(change.norm(), 1);
  EXPECT_LE((change - product).norm(), 1e-6 * change.norm());
}

TEST(Fibres, AreExactAndKeepTheVolume) {
  const Model model = build_model(bust_mesh(), {});
  for (const double ratio : {0.97, 0.90}) {
    const Solution fit = solve(model, {"body", {"bust"}, {by_points(ratio)}}, {}, nullptr, {}, {},
                               {between_nodes(model.control)});
    EXPECT_EQ(fit.status, Status::converged);
    EXPECT_NEAR(fit.lines.front().final / fit.lines.front().initial, ratio, 1e-6 * ratio);
    EXPECT_NEAR(fit.regions.front().volume_after / fit.regions.front().volume_before, 1, 1e-9);
    EXPECT_LE(fit.residual, 1e-8);
  }
}

TEST(Fibres, AnEndThatNothingCarriesStaysInSpaceAndTheBandIsExactAllTheSame) {
  const Model model = build_model(bust_mesh(), {});
  geometry::LaidLine laid = between_nodes(model.control);
  for (geometry::Fibre& fibre : laid.fibres) {
    fibre.points.front().weights.clear();
    fibre.points.back().weights.clear();
  }
  const Solution held = solve(model, {"body", {"bust"}, {by_points(0.95)}}, {}, nullptr, {}, {}, {laid});
  ASSERT_EQ(held.status, Status::converged);
  const LineResult& line = held.lines.front();
  EXPECT_EQ(line.course.front(), line.course_at_rest.front());
  EXPECT_EQ(line.course.back(), line.course_at_rest.back());
  EXPECT_NEAR(line.final / line.initial, 0.95, 1e-6);
  const Vector3d ends = line.course.back() - line.course.front();
  EXPECT_GT(line.straight, 0.9 * ends.norm());  // the least length is known: straight from end to end
  const Solution carried = solve(model, {"body", {"bust"}, {by_points(0.95)}}, {}, nullptr, {}, {},
                                 {between_nodes(model.control)});
  EXPECT_GT(held.lines.front().tension, carried.lines.front().tension);  // no shortening is lost to slip
}

TEST(Fibres, ALineThatWasNotLaidIsRefused) {
  const Model model = build_model(bust_mesh(), {});
  try {
    solve(model, {"body", {"bust"}, {by_points(0.95)}}, {});
    FAIL() << "not refused";
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(refusal.code(), std::string("bad_garment"));
  }
}

}  // namespace
}  // namespace tensegric_fit::tensegric
