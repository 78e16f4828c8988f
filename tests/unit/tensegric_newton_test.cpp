// Newton's method at one load: how many steps it takes, and what it mends.
#include "tensegric/newton.hpp"

#include <gtest/gtest.h>

#include "tensegric_bust.hpp"

namespace tensegric_fit::tensegric {
namespace {

// The chest line, and one from tip to tip that is longer than the way between them.
Garment tight_and_loose() {
  Garment garment = chest(0.97);
  GarmentLine tips = garment.lines[0];
  tips.name = "tips";
  tips.ratio = 1.2;
  tips.through = {"bust_point_L", "bust_point_R"};
  tips.taut = true;
  garment.lines.push_back(tips);
  return garment;
}

class NewtonOnTheBust : public testing::Test {
 protected:
  NewtonOnTheBust() : problem(lay_garment(model, tight_and_loose(), options)), recorder(problem, go_on) {
    for (const Band& band : problem.bands) {
      load.neutral.push_back(band.neutral);
      load.limit.push_back(200);
    }
    load.gravity.setZero();
  }

  Balance at_rest() const {
    return {problem.rest, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(2), {Hold::length, Hold::slack}};
  }

  const Model model = build_model(bust_mesh(), {});
  const SolverOptions options;
  const Progress go_on;
  const Problem problem;
  Recorder recorder;
  Load load;
};

constexpr Tolerance kExact{1e-10, 1e-12, 1e-11};

TEST_F(NewtonOnTheBust, TakesAsManySteps) {
  for (const int most : {1, 2}) {
    Newton newton(problem, recorder, 0, 100);
    Balance at = at_rest();
    EXPECT_FALSE(newton.settle(at, load, kExact, most));
    EXPECT_EQ(newton.iterations(), most);
  }
  Newton newton(problem, recorder, 0, 100);
  Balance at = at_rest();
  EXPECT_TRUE(newton.settle(at, load, kExact, 100));
  EXPECT_EQ(newton.kkt().factorisations(), 3);  // one step each are not enough
}

// A second step by the matrix of the first leaves a hundredth of what the first one left.
TEST_F(NewtonOnTheBust, TheMatrixOfAStepServesForTheNext) {
  Newton newton(problem, recorder, 0, 100);
  Balance at = at_rest();
  ASSERT_TRUE(newton.settle(at, load, {1, 1e-2, 1e-2}, 100));
  Kkt& kkt = newton.kkt();
  const auto after = [&](const Step& step) {
    for (std::size_t i = 0; i < at.x.size(); ++i)
      if (problem.free_index[i] >= 0) at.x[i] += step.move.segment<3>(3 * problem.free_index[i]);
    at.pressures += step.multipliers.head(1);
    at.tensions += step.multipliers.tail(2);
    return kkt.defect(at, load);
  };
  const KktResidual start = kkt.defect(at, load);
  const KktResidual left = after(kkt.step(at, load, start, false, true));
  ASSERT_GT(left.residual, 1e-8);
  const KktResidual left_again = after(kkt.step_again(left));
  EXPECT_LT(left_again.residual, 0.01 * left.residual);
}

// Tensions take no part in it, nor do lines that are not kept at their lengths.
TEST_F(NewtonOnTheBust, MendsVolumesAndKeptLengthsAlone) {
  Newton newton(problem, recorder, 0, 100);
  load.neutral[0] = 0.9999 * problem.bands[0].initial;
  Balance at = at_rest(), pulling = at;
  pulling.tensions << 0.3, 0.2;
  newton.mend(at, load);
  newton.mend(pulling, load);
  const KktResidual defect = newton.kkt().defect(at, load);
  EXPECT_LE(defect.volume_error, 1e-12);
  EXPECT_LE(defect.length_error, 1e-12);
  EXPECT_EQ(pulling.x, at.x);  // to the bit
  double farthest = 0;
  for (std::size_t i = 0; i < at.x.size(); ++i)
    farthest = std::max(farthest, (at.x[i] - problem.rest[i]).norm());
  EXPECT_GT(farthest, 0);
  EXPECT_LT(farthest, 0.001);  // by the shortest way: the line is 50 micrometres longer than it is to be
}

}  // namespace
}  // namespace tensegric_fit::tensegric
