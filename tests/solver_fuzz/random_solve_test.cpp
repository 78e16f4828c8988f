/// What the checks of random solves see: results that are spoilt by hand.
#include "random_solve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace tensegric_fit::solver_fuzz {
namespace {

using tensegric::Solution;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

class SpoiltSolve : public testing::Test {
 protected:
  static constexpr auto kSolver = tensegric::SolverName::equilibrium;
  static constexpr unsigned kSeed = 1;

  std::vector<std::string> faults_of(const std::function<void(Solution&)>& spoil) const {
    Solution other = solution_;
    spoil(other);
    Finding found;
    check(drawn_, other, kSolver, found);
    return found.faults;
  }
  bool sees(const std::string& fault, const std::function<void(Solution&)>& spoil) const {
    const std::vector<std::string> faults = faults_of(spoil);
    return std::find(faults.begin(), faults.end(), fault) != faults.end();
  }

  const stability::Case drawn_ = random_case(kSeed);
  const Solution solution_ =
      tensegric::solve(tensegric::build_model(drawn_.control, drawn_.model), drawn_.garment, {});
};

TEST_F(SpoiltSolve, TheSolversOwnHasNoFaults) {
  EXPECT_EQ(faults_of([](Solution&) {}), std::vector<std::string>());
}

TEST_F(SpoiltSolve, LengthsAndVolumes) {
  const std::string length = "a length is not what the solver says",
                    volume = "a volume is not what the solver says";
  EXPECT_TRUE(sees(length, [](Solution& s) { s.lines[0].final *= 1 + 1e-6; }));
  EXPECT_TRUE(sees(length, [](Solution& s) { s.lines[0].final = kNone; }));
  EXPECT_TRUE(sees(volume, [](Solution& s) { s.regions[0].volume_after *= 1 + 1e-6; }));
  EXPECT_TRUE(sees(volume, [](Solution& s) { s.regions[0].volume_after = kNone; }));
}

TEST_F(SpoiltSolve, WhatIsNotThereAndASolverThatDoesNothing) {
  const std::string gone = "a line, a region or a node is not in the result",
                    idle = "infeasible, and no line that pulls is longer than asked for";
  EXPECT_TRUE(sees(gone, [](Solution& s) { s.lines.clear(); }));
  EXPECT_TRUE(sees(gone, [](Solution& s) { s.regions.clear(); }));
  const auto rest = [this](Solution& s) {
    s.outer = drawn_.control.outer;
    s.inner = drawn_.control.inner;
    s.status = tensegric::Status::infeasible;
    for (auto& line : s.lines) {
      line.law = {};
      line.tension = 0;
    }
  };
  EXPECT_TRUE(sees(idle, rest));
}

TEST_F(SpoiltSolve, NodesThatAreHeld) {
  const auto held = [](const std::vector<char>& fixed) {
    return static_cast<std::size_t>(std::find(fixed.begin(), fixed.end(), 1) - fixed.begin());
  };
  const std::size_t outer = held(drawn_.control.outer_fixed), inner = held(drawn_.control.inner_fixed);
  EXPECT_TRUE(sees("a fixed node moved", [&](Solution& s) { s.outer[outer].x() += 1e-9; }));
  EXPECT_TRUE(sees("a fixed node moved", [&](Solution& s) { s.inner[inner].x() += 1e-9; }));
  EXPECT_TRUE(sees("not finite", [&](Solution& s) { s.inner[inner].x() = kNone; }));
}

}  // namespace
}  // namespace tensegric_fit::solver_fuzz
