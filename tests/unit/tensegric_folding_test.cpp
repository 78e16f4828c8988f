// Requests that fold the skin or are out of reach: nothing turns inside out, and each ends in a balance.
#include <gtest/gtest.h>

#include <random>

#include "tensegric/fold_barrier.hpp"
#include "tensegric/shape_check.hpp"
#include "tensegric/solver.hpp"
#include "tensegric_bust.hpp"

namespace tensegric_fit::tensegric {
namespace {

GarmentLine line(const std::string& name, double ratio, std::vector<std::string> through = {}) {
  GarmentLine result;
  result.name = name;
  result.ratio = ratio;
  result.through = std::move(through);
  return result;
}

Positions positions(const Solution& s) {
  Positions x = s.outer;
  x.insert(x.end(), s.inner.begin(), s.inner.end());
  return x;
}

// A balance at kept volumes, whatever the lines came to.
void expect_balance(const Solution& s) {
  EXPECT_LE(s.residual, 1e-8);
  for (const RegionResult& r : s.regions) EXPECT_NEAR(r.volume_after / r.volume_before, 1, 1e-9);
}

class Folding : public testing::Test {
 protected:
  const geometry::ControlMesh control = bust_mesh();
  const Model model = build_model(control, {});
  const std::vector<UnitVolume> units = unit_volumes(model, model.free_index());
};

TEST_F(Folding, BarrierIsNothingAboveItsBeginAndWithoutBoundAtZero) {
  ASSERT_EQ(units.size(), 2 * control.triangles.size());
  Positions x = model.rest_positions();
  EXPECT_EQ(fold_energy(units, x), 0);
  const UnitVolume& unit = units[units.size() / 2];
  EXPECT_NEAR(volume_share(unit, x), 1, 1e-14);
  const Positions rest = x;
  const auto flattened = [&](double share) {  // the apex goes straight to the triangle
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d apex = (rest[unit.nodes[3]] + rest[unit.nodes[4]] + rest[unit.nodes[5]]) / 3;
      const Eigen::Vector3d middle = (rest[unit.nodes[0]] + rest[unit.nodes[1]] + rest[unit.nodes[2]]) / 3;
      x[unit.nodes[3 + k]] = rest[unit.nodes[3 + k]] + (1 - share) * (middle - apex);
    }
    EXPECT_NEAR(volume_share(unit, x), share, 1e-12);
    return fold_energy({unit}, x);
  };
  EXPECT_EQ(flattened(0.71), 0);
  double last = 0;
  for (double share : {0.6, 0.4, 0.2, 0.05, 1e-3, 1e-9}) {
    const double energy = flattened(share);
    EXPECT_GT(energy, last);
    const double s = volume_share(unit, x);  // as it is rounded
    EXPECT_NEAR(energy, -unit.stiffness * (s - 0.7) * (s - 0.7) * std::log(s / 0.7), 1e-12 * energy);
    last = energy;
  }
  EXPECT_TRUE(std::isinf(flattened(-0.1)));
}

TEST_F(Folding, DerivativesOfTheBarrier) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const std::vector<int> free_index = model.free_index();
  std::vector<std::pair<int, int>> pairs;
  for (const UnitVolume& unit : units)
    for (int a : unit.nodes)
      for (int b : unit.nodes)
        if (a != b && free_index[a] >= 0 && free_index[b] >= 0)
          pairs.emplace_back(free_index[a], free_index[b]);
  Positions x = model.rest_positions();
  for (std::size_t i = 0; i < control.outer.size(); ++i) x[i] += 0.5 * (control.inner[i] - control.outer[i]);
  for (Eigen::Vector3d& p : x)
    for (int k = 0; k < 3; ++k) p[k] += 5e-4 * normal(random);
  ASSERT_GT(fold_energy(units, x), 0);
  ASSERT_TRUE(std::isfinite(fold_energy(units, x)));
  const Eigen::VectorXd direction =
      Eigen::VectorXd::NullaryExpr(3 * model.free_nodes(), [&] { return normal(random); });
  const double step = 1e-7;  // m; rounding and the third derivative then stay below 1e-7 of the result
  const auto moved = [&](double by) {
    Positions y = x;
    for (std::size_t i = 0; i < y.size(); ++i)
      if (free_index[i] >= 0) y[i] += by * direction.segment<3>(3 * free_index[i]);
    return y;
  };
  const auto gradient = [&](const Positions& y) {
    Eigen::VectorXd g = Eigen::VectorXd::Zero(direction.size());
    add_fold_gradient(units, y, free_index, g);
    return g;
  };
  const double slope = (fold_energy(units, moved(step)) - fold_energy(units, moved(-step))) / (2 * step);
  EXPECT_NEAR(gradient(x).dot(direction), slope, 1e-6 * (std::abs(slope) + gradient(x).norm()));
  NodeMatrix hessian(model.free_nodes(), pairs);
  add_fold_hessian(units, x, straight_pushes(units, x), free_index, hessian);
  const Eigen::VectorXd change = (gradient(moved(step)) - gradient(moved(-step))) / (2 * step);
  const Eigen::VectorXd product = hessian.lower().selfadjointView<Eigen::Lower>() * direction;
  EXPECT_LE((change - product).norm(), 1e-6 * change.norm());
}

// The line has the barrier's push and slope at the share that has the push asked for, so that at the balance
// a step by the lines is a step by the barriers.
TEST_F(Folding, LinesTouchTheBarrier) {
  const std::vector<int> free_index = model.free_index();
  Positions x = model.rest_positions();
  for (std::size_t i = 0; i < control.outer.size(); ++i) x[i] += 0.5 * (control.inner[i] - control.outer[i]);
  const std::vector<StraightPush> own = straight_pushes(units, x);
  ASSERT_FALSE(own.empty());
  Eigen::VectorXd pushes = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(units.size()));
  for (const StraightPush& line : own) {
    EXPECT_EQ(line.push, line.at_x);
    EXPECT_LT(line.share, 0.7);
    pushes[line.unit] = line.push;
  }
  const std::vector<StraightPush> same = straight_pushes(units, x, pushes);
  ASSERT_EQ(same.size(), own.size());
  for (std::size_t k = 0; k < own.size(); ++k) {
    EXPECT_NEAR(same[k].push / own[k].push, 1, 1e-9);
    EXPECT_NEAR(same[k].slope / own[k].slope, 1, 1e-6);
    EXPECT_NEAR(same[k].at_x / own[k].at_x, 1, 1e-9);
  }
  for (double share : {1e-9, 1e-6, 1e-3, 1e2, 1e6}) {  // of the push
    for (const StraightPush& line : straight_pushes(units, x, share * pushes))
      EXPECT_NEAR(line.push / (share * pushes[line.unit]), 1, 1e-6) << share;
  }
  // Foreseen to pull: by less than it pushes, it will do neither; by more, that says nothing.
  const std::vector<StraightPush> ended = straight_pushes(units, x, -0.9 * pushes);
  ASSERT_EQ(ended.size(), own.size());
  for (const StraightPush& line : ended) {
    EXPECT_EQ(line.push, 0);
    EXPECT_EQ(line.at_x, 0);
    EXPECT_EQ(line.slope, 0);
  }
  const std::vector<StraightPush> far = straight_pushes(units, x, -1.1 * pushes);
  ASSERT_EQ(far.size(), own.size());
  for (std::size_t k = 0; k < own.size(); ++k) EXPECT_EQ(far[k].push, own[k].push);
  Eigen::VectorXd difference = Eigen::VectorXd::Zero(3 * model.free_nodes()), gradient = difference;
  add_straight_difference(units, x, own, free_index, difference);
  EXPECT_EQ(difference.norm(), 0);
  const std::vector<StraightPush> half = straight_pushes(units, x, pushes / 2);
  add_straight_difference(units, x, half, free_index, difference);
  add_fold_gradient(units, x, free_index, gradient);
  const Eigen::VectorXd still = pushes_after(units, x, half, free_index, 0 * gradient);
  const Eigen::VectorXd after = pushes_after(units, x, half, free_index, -1e-6 * gradient);
  double sum = 0;
  for (std::size_t k = 0; k < half.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    EXPECT_EQ(still[i], half[k].at_x);
    sum += pushes[half[k].unit] * (after[i] - still[i]) / half[k].slope;
  }
  EXPECT_NEAR(sum, 1e-6 * gradient.squaredNorm(), 1e-9 * sum);
}

// A unit that is nearly flat at rest begins to fold at once, and its barrier pushes with many times what acts
// on it. It takes no more than a few steps more for that.
TEST(FoldingUnits, NearlyFlatOnesTakeFewSteps) {
  const Solution plain = solve(build_model(bust_mesh(), {}), chest(0.95), {});
  for (double depth : {0.1, 0.03, 0.01}) {
    geometry::ControlMesh control = bust_mesh();
    const int node = control.triangles[control.triangles.size() / 2][0];
    control.inner[node] = control.outer[node] + depth * (control.inner[node] - control.outer[node]);
    const Solution s = solve(build_model(control, {}), chest(0.95), {});
    EXPECT_EQ(s.status, Status::converged) << s.note;
    expect_balance(s);
    EXPECT_LE(s.iterations, plain.iterations + 5) << depth;
    for (const Iterate& i : s.history) EXPECT_LE(i.merit_change, 1e-12);
  }
}

// Tissue of 0.8 mm gives way until the band's greatest pull; of 0.1 mm no iterations are enough, and the last
// shape on the way says so.
TEST(FoldingUnits, TissueBelowAMillimetreIsSolvedOrSaysWhyNot) {
  for (double depth : {8e-4, 1e-4}) {
    geometry::ControlMesh control = bust_mesh();
    for (std::size_t i = 0; i < control.inner.size(); ++i)
      control.inner[i] = control.outer[i] + depth * (control.inner[i] - control.outer[i]).normalized();
    const Model thin = build_model(control, {});
    const Solution s = solve(thin, chest(0.97), {});
    EXPECT_EQ(triangle_change(thin, positions(s)).turned_over, 0);
    if (depth > 5e-4) {
      EXPECT_EQ(s.status, Status::infeasible) << s.note;
      expect_balance(s);
      EXPECT_NE(s.note.find(" long; "), std::string::npos) << s.note;
    } else {
      EXPECT_EQ(s.status, Status::capped) << s.note;
      EXPECT_NE(s.note.find("last balance on the way"), std::string::npos) << s.note;
    }
  }
}

TEST_F(Folding, NothingTurnsOverAt15Percent) {
  for (int refinement : {1, 2}) {
    BustShape shape;
    shape.columns *= refinement;
    shape.rows *= refinement;
    const Model finer = build_model(bust_mesh(shape), {});
    for (double ratio : {0.90, 0.85}) {
      const Solution s = solve(finer, chest(ratio), {});
      EXPECT_EQ(s.status, Status::converged) << s.note;
      expect_balance(s);
      EXPECT_NEAR(s.lines[0].final / s.lines[0].neutral, 1, 1e-6);
      EXPECT_EQ(triangle_change(finer, positions(s)).turned_over, 0);
      for (const UnitVolume& unit : unit_volumes(finer, finer.free_index()))
        EXPECT_GT(volume_share(unit, positions(s)), 0.01);  // the barrier ends at 0
    }
  }
}

TEST_F(Folding, APatchWithTurnedTrianglesIsInfeasible) {
  int turned = 0;
  for (const double pull : {0.002, 30.0, 200.0, 300.0}) {
    SolverOptions options;
    options.gravity = {0, 0, -pull};
    const Solution s = solve(model, {}, options);  // no line: nothing else is out of reach
    const bool over = triangle_change(model, positions(s)).turned_over > 0;
    turned += over;
    if (s.residual > 1e-8) continue;  // no balance
    EXPECT_EQ(s.status, over ? Status::infeasible : Status::converged) << pull << s.note;
  }
  EXPECT_GT(turned, 0);
}

// Skin that is turned over where the chest line is shorter than `share` of its length at rest.
SkinFolds folds_below(const geometry::ControlMesh& control, double share) {
  const std::vector<int> nodes = control.lines.front().nodes;
  const auto length = [nodes](const std::vector<Eigen::Vector3d>& outer) {
    double sum = 0;
    for (std::size_t i = 1; i < nodes.size(); ++i) sum += (outer[nodes[i]] - outer[nodes[i - 1]]).norm();
    return sum;
  };
  const double least = share * length(control.outer);
  return [=](const std::vector<Eigen::Vector3d>& outer, const std::vector<Eigen::Vector3d>&) {
    return length(outer) < least;
  };
}

TEST_F(Folding, GoesBackToTheLastShapeWhoseSkinIsNotTurnedOver) {
  constexpr double kShare = 0.93;
  const SkinFolds folds = folds_below(control, kShare);
  const Solution loose = solve(model, chest(0.96), {}, nullptr, {}, {}, {}, folds);
  ASSERT_EQ(loose.status, Status::converged);
  for (double ratio : {0.90, 0.80}) {
    const Solution s = solve(model, chest(ratio), {}, nullptr, {}, {}, {}, folds);
    EXPECT_EQ(s.status, Status::infeasible) << s.note;
    EXPECT_NE(s.note.find("skin would turn over"), std::string::npos) << s.note;
    expect_balance(s);
    EXPECT_FALSE(folds(s.outer, s.inner));
    const LineResult& line = s.lines[0];
    EXPECT_EQ(line.request, ratio);
    EXPECT_GE(line.final / line.initial, kShare);
    EXPECT_LE(line.final / line.initial, kShare + 0.002);
    EXPECT_EQ(s.history.back().line_ratios[0], line.final / line.initial);
    const Solution warm = solve(model, chest(ratio), {}, &loose, {}, {}, {}, folds);
    EXPECT_EQ(warm.outer, s.outer);  // wherever it began
    EXPECT_EQ(warm.status, s.status);
  }
}

// It pulls by the neutral length of the way, which is not the one that was asked for.
TEST_F(Folding, AnElasticLineThatWentBackNamesItsNeutralLength) {
  Garment elastic = chest(0.80);
  elastic.lines[0].law.kind = TensionLaw::Kind::stiffness;
  elastic.lines[0].law.stiffness = 20;
  const Solution whole = solve(model, elastic, {});
  ASSERT_EQ(whole.status, Status::converged) << whole.note;
  EXPECT_EQ(whole.note.find("neutral length"), std::string::npos) << whole.note;
  const LineResult& asked = whole.lines[0];
  const double middle = (1 + asked.final / asked.initial) / 2;
  const Solution s = solve(model, elastic, {}, nullptr, {}, {}, {}, folds_below(control, middle));
  ASSERT_EQ(s.status, Status::infeasible);
  const LineResult& line = s.lines[0];
  const double neutral = line.final / (1 + line.tension / line.law.stiffness);
  EXPECT_GT(neutral, 1.01 * line.neutral);
  const std::string sentence = "Line chest pulls as one with a neutral length of " +
                               std::to_string(std::lround(1000 * neutral)) + " mm";
  EXPECT_NE(s.note.find(sentence), std::string::npos) << s.note;
}

TEST_F(Folding, SmoothSkinChangesNothing) {
  const Solution plain = solve(model, chest(0.90), {});
  const Solution s = solve(model, chest(0.90), {}, nullptr, {}, {}, {}, folds_below(control, 0.5));
  EXPECT_EQ(s.outer, plain.outer);
  EXPECT_EQ(s.status, plain.status);
  EXPECT_EQ(s.iterations, plain.iterations);
}

TEST_F(Folding, SkinThatIsTurnedOverAllTheWayLeavesRest) {
  const Solution s = solve(model, chest(0.90), {}, nullptr, {}, {}, {}, folds_below(control, 2));
  EXPECT_EQ(s.status, Status::infeasible);
  EXPECT_EQ(s.outer, control.outer);
}

// Part of a weight is no looser garment: there the shape stays, and is not called a fit.
TEST_F(Folding, TurnedSkinIsNeverConverged) {
  SolverOptions weighed;
  weighed.gravity = {0, 0, -0.01};
  const Solution plain = solve(model, chest(0.95), weighed);
  ASSERT_EQ(plain.status, Status::converged);
  const Solution s = solve(model, chest(0.95), weighed, nullptr, {}, {}, {}, folds_below(control, 2));
  EXPECT_EQ(s.status, Status::infeasible);
  EXPECT_EQ(s.outer, plain.outer);
  SolverOptions papers;
  papers.solver = SolverName::relaxation;
  ASSERT_EQ(solve(model, chest(0.99), papers).status, Status::converged);
  EXPECT_EQ(solve(model, chest(0.99), papers, nullptr, {}, {}, {}, folds_below(control, 2)).status,
            Status::infeasible);
}

TEST_F(Folding, MeritNeverRises) {
  for (double ratio : {0.95, 0.85, 0.5})
    for (const Iterate& iterate : solve(model, chest(ratio), {}).history)
      EXPECT_LE(iterate.merit_change, 1e-12);  // rounding of a sum of some thousand parts
}

TEST_F(Folding, BelowTheStraightWayEndsInABalance) {
  double last = 0;
  for (double ratio : {0.3, 0.1}) {
    const Solution s = solve(model, chest(ratio), {});
    EXPECT_EQ(s.status, Status::infeasible) << s.note;
    expect_balance(s);
    EXPECT_LE(s.iterations, 120);
    const LineResult& chest_line = s.lines[0];
    const auto& nodes = chest_line.nodes;
    EXPECT_NEAR(chest_line.straight, (control.outer[nodes.front()] - control.outer[nodes.back()]).norm(),
                1e-12);
    EXPECT_LT(chest_line.neutral, chest_line.straight);
    EXPECT_GE(chest_line.final, chest_line.straight);
    EXPECT_EQ(chest_line.reachable, chest_line.final);
    EXPECT_NE(s.note.find("straight"), std::string::npos) << s.note;
    if (last > 0) {
      EXPECT_NEAR(chest_line.final, last, 1e-6);  // pulled as hard, it comes as far
    }
    last = chest_line.final;
  }
}

TEST_F(Folding, ContradictingLinesEndInABalance) {
  for (double ratio : {0.6, 0.3}) {
    Garment garment = chest(ratio);
    garment.lines.push_back(line("tips", ratio, {"bust_point_L", "bust_point_R"}));
    garment.lines.push_back(line("left", ratio, {"bust_point_L", "axilla_L"}));
    garment.lines.push_back(line("right", ratio, {"bust_point_R", "axilla_R"}));
    garment.lines.push_back(line("left again", ratio, {"bust_point_L", "axilla_L"}));
    for (std::size_t i = 1; i < garment.lines.size(); ++i) garment.lines[i].taut = true;
    const Solution s = solve(model, garment, {});
    EXPECT_EQ(s.status, Status::infeasible) << s.note;
    expect_balance(s);
    EXPECT_LE(s.iterations, 250);  // below the cap: they pull against each other up to the limit of 260 N
  }
}

TEST_F(Folding, VeryStiffBandsAreAsGoodAsRigid) {
  const Solution rigid = solve(model, chest(0.90), {});
  for (double stiffness : {1e3, 1e6, 1e9}) {
    Garment garment = chest(0.90);
    garment.lines[0].law.kind = TensionLaw::Kind::stiffness;
    garment.lines[0].law.stiffness = stiffness;
    const Solution s = solve(model, garment, {});
    EXPECT_EQ(s.status, Status::converged) << s.note;
    expect_balance(s);
    const LineResult& chest_line = s.lines[0];
    // T = stiffness (L / l - 1), as far as the stretch differs from 1
    EXPECT_NEAR(chest_line.final / chest_line.neutral - 1, chest_line.tension / stiffness, 1e-11);
    // The tension stretches the band by tension / stiffness, and falls by some 600 per stretch.
    EXPECT_NEAR(chest_line.tension, rigid.lines[0].tension, 1000 * rigid.lines[0].tension / stiffness);
  }
  Garment beyond = chest(0.3);
  beyond.lines[0].law.kind = TensionLaw::Kind::table;
  beyond.lines[0].law.table = {{1, 0}, {1.01, 1}, {1.02, 1e9}};
  const Solution s = solve(model, beyond, {});
  EXPECT_EQ(s.status, Status::infeasible) << s.note;
  expect_balance(s);
}

// Stopped at any time, by whatever means, the answer is a balance on the way.
TEST_F(Folding, StoppedEarlyItIsTheLastBalance) {
  const int whole = solve(model, chest(0.80), {}).iterations;
  double last = 1;
  for (int most = 1; most < whole - 1;
       ++most) {  // the last step goes from what is wanted to what is aimed at
    SolverOptions options;
    options.max_iterations = most;
    const Solution s = solve(model, chest(0.80), options);
    EXPECT_EQ(s.status, Status::capped);
    for (const RegionResult& r : s.regions) EXPECT_NEAR(r.volume_after / r.volume_before, 1, 1e-9);
    EXPECT_LE(s.residual, 0.21);  // the balance of a load on the way is found to 0.2
    EXPECT_NE(s.note.find("%"), std::string::npos) << s.note;
    const double ratio = s.lines[0].final / s.lines[0].initial;
    EXPECT_LE(ratio, last + 1e-9);  // the longer the nearer
    last = ratio;
  }
  EXPECT_LT(last, 0.95);
}

TEST_F(Folding, TimeBudgetAndCancelling) {
  SolverOptions options;
  options.time_budget = 1e-9;
  const Solution none = solve(model, chest(0.90), options);
  EXPECT_EQ(none.status, Status::capped);
  EXPECT_EQ(none.iterations, 0);
  EXPECT_EQ(none.outer, control.outer);
  EXPECT_NE(none.note.find("time budget"), std::string::npos);
  options.time_budget = 600;
  EXPECT_EQ(solve(model, chest(0.90), options).status, Status::converged);
  const Solution cancelled =
      solve(model, chest(0.90), {}, nullptr,
            [](const Iterate& iterate, const auto&, const auto&) { return iterate.iteration < 4; });
  EXPECT_EQ(cancelled.status, Status::capped);
  EXPECT_NE(cancelled.note.find("cancelled"), std::string::npos);
  EXPECT_NEAR(cancelled.regions[0].volume_after / cancelled.regions[0].volume_before, 1, 1e-9);
}

}  // namespace
}  // namespace tensegric_fit::tensegric
