// Lines laid on the body: where their fibres lie, and what carries them.
#include "tffd/lay_line.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "geometry/section.hpp"
#include "geometry/status.hpp"
#include "tffd_shapes.hpp"

namespace tensegric_fit::tffd {
namespace {

using Eigen::Vector3d;

/// Over the bump from one side of the patch to the other.
std::vector<Vector3d> over_the_bump() {
  std::vector<Vector3d> points;
  for (int i = 0; i <= 60; ++i) {
    const double x = -0.09 + 0.003 * i;
    points.emplace_back(x, 0, bump(x, 0));
  }
  return points;
}

double length_at_rest(const std::vector<geometry::Fibre>& fibres) {
  double length = 0;
  for (const geometry::Fibre& fibre : fibres) {
    std::vector<Vector3d> points;
    for (const geometry::CarriedPoint& point : fibre.points) points.push_back(point.rest);
    length += fibre.share * geometry::length_of(points, false);
  }
  return length;
}

struct Slab : testing::Test {
  const geometry::TriangleMesh body = slab(121);  // 2.5 mm apart
  const geometry::ControlMesh control = patch();
  const Binding binding{body, control, {}};
};

TEST_F(Slab, AThreadIsAsLongAsTheSkinUnderIt) {
  const auto fibres = lay_line({over_the_bump()}, body, binding);
  ASSERT_EQ(fibres.size(), 1u);
  // Facets of 2.5 mm on a bend of 40 mm radius cut off 1e-4 of the way.
  EXPECT_NEAR(length_at_rest(fibres), geometry::length_of(over_the_bump(), false), 1e-4);
}

TEST_F(Slab, ALineOfMoreThan100MetresIsRefused) {
  try {
    lay_line({{Eigen::Vector3d(0, 0, 0.1), Eigen::Vector3d(1e6, 0, 0.1)}}, body, binding);
    FAIL() << "it would take 8 GB";
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(refusal.code(), std::string(geometry::refusal::kBadGarment));
  }
}

TEST_F(Slab, ABandSpreadsOverItsWidthAndStaysOnTheSkin) {
  const auto fibres = lay_line({over_the_bump(), 0.03}, body, binding);
  double shares = 0, widest = 0;
  for (const geometry::Fibre& fibre : fibres) {
    shares += fibre.share;
    for (const geometry::CarriedPoint& point : fibre.points) {
      widest = std::max(widest, std::abs(point.rest.y()));
      // Facets lie up to size^2 / (8 radius) = 0.02 mm inside the bump.
      EXPECT_NEAR(point.rest.z(), bump(point.rest.x(), point.rest.y()), 5e-5);
    }
  }
  EXPECT_NEAR(shares, 1, 1e-12);
  ASSERT_GE(fibres.size(), 3u);  // evenly over the width: those along the edges stand for half as much
  EXPECT_NEAR(fibres.front().share, fibres[1].share / 2, 1e-12);
  EXPECT_NEAR(fibres.back().share, fibres[1].share / 2, 1e-12);
  // The outermost of seven fibres runs along the band's edge, measured over the skin.
  EXPECT_LE(widest, 0.015 + 1e-4);
  EXPECT_GT(widest, 0.014);
}

TEST_F(Slab, FibresLieInOrderFromRightToLeft) {
  const auto fibres = lay_line({over_the_bump(), 0.03}, body, binding);  // along x, seen from above
  ASSERT_GT(fibres.size(), 1u);
  double last = -1;
  for (const geometry::Fibre& fibre : fibres) {
    const double y = fibre.points[fibre.points.size() / 2].rest.y();
    EXPECT_GT(y, last);
    last = y;
  }
}

TEST_F(Slab, SmoothingShortensWhereTheBandBends) {
  const double thread = length_at_rest(lay_line({over_the_bump(), 0, 0}, body, binding));
  const double smooth = length_at_rest(lay_line({over_the_bump(), 0, 0.02}, body, binding));
  EXPECT_LT(smooth, thread - 5e-4);
  EXPECT_GT(smooth, 0.18);  // not below the straight way
}

// Else a band over the middle of a symmetric body is not symmetric, and a short last step bends sharply.
TEST_F(Slab, AnAveragedFibreIsEvenAndTheSameFromEitherEnd) {
  for (std::size_t count = 40; count <= 61; ++count) {
    std::vector<Vector3d> way = over_the_bump();
    way.resize(count);
    LineOnBody line{way, 0.03, 0.02};
    const auto there = lay_line(line, body, binding);
    std::reverse(line.points.begin(), line.points.end());
    const auto back = lay_line(line, body, binding);
    ASSERT_EQ(there.size(), back.size());
    for (std::size_t f = 0; f < there.size(); ++f) {
      const auto &points = there[f].points, &reversed = back[back.size() - 1 - f].points;
      ASSERT_EQ(points.size(), reversed.size()) << count;
      double shortest = 1, longest = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_LT((points[i].rest - reversed[points.size() - 1 - i].rest).norm(), 1e-9) << count;
        if (i == 0) continue;
        const double step = (points[i].rest - points[i - 1].rest).norm();
        shortest = std::min(shortest, step);
        longest = std::max(longest, step);
      }
      // Steps are 2 or 3, or 3 or 4, of the points that are laid every 3 mm.
      EXPECT_LT(longest, 1.7 * shortest) << count;
    }
  }
}

TEST_F(Slab, AnAffineMapOfTheNodesCarriesTheFibresAlong) {
  const Eigen::Matrix3d a = (Eigen::Matrix3d() << 1.1, 0.2, 0, -0.1, 0.9, 0.05, 0.02, 0, 1.2).finished();
  geometry::ControlMesh loose = control;  // nothing fixed: the share is 1 all over the patch
  loose.outer_fixed.assign(loose.outer.size(), 0);
  loose.inner_fixed = loose.outer_fixed;
  const Binding free(body, loose, {});
  const auto fibres = lay_line({over_the_bump(), 0.03, 0.02, false, {false, false}}, body, free);
  for (const geometry::Fibre& fibre : fibres)
    for (const geometry::CarriedPoint& point : fibre.points) {
      Vector3d moved = point.rest;
      for (const auto& [node, weight] : point.weights) {
        const std::size_t i = static_cast<std::size_t>(node) % loose.outer.size();
        const Vector3d& rest =
            static_cast<std::size_t>(node) < loose.outer.size() ? loose.outer[i] : loose.inner[i];
        moved += weight * (a * rest - rest);
      }
      EXPECT_LT((moved - a * point.rest).norm(), 1e-12);
    }
}

// A garment pulled more than twice as hard on a mesh of 5,000 triangles as on one of 107,000: fibres moved as
// straight lines between vertices make of the mapping, not by the mapping itself.
TEST_F(Slab, ABandMovesAlikeOnCoarseAndFineMeshesOfOneSurface) {
  const geometry::TriangleMesh coarse = slab(13);  // 25 mm apart, as the nodes
  geometry::TriangleMesh divided = coarse;         // flat, without another shape
  for (int round = 0; round < 3; ++round) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), divided.vertices.size());
      if (is_new) divided.vertices.push_back((divided.vertices[a] + divided.vertices[b]) / 2);
      return at->second;
    };
    std::vector<Eigen::Vector3i> parts;
    for (const Eigen::Vector3i& t : divided.triangles) {
      const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      for (const Eigen::Vector3i& part : {Eigen::Vector3i(t[0], a, c), Eigen::Vector3i(a, t[1], b),
                                          Eigen::Vector3i(c, b, t[2]), Eigen::Vector3i(a, b, c)})
        parts.push_back(part);
    }
    divided.triangles = std::move(parts);
  }
  const Moved moved = squeezed(control, 0.01);
  struct Move {
    Vector3d motion;
    double share;
  };
  const auto moves_on = [&](const geometry::TriangleMesh& mesh) {
    std::vector<Move> all;
    for (const geometry::Fibre& fibre : lay_line({over_the_bump(), 0.03}, mesh, Binding(mesh, control, {}))) {
      for (const geometry::CarriedPoint& point : fibre.points) {
        Move& move = all.emplace_back(Move{Vector3d::Zero(), 0});
        for (const auto& [node, weight] : point.weights) {
          const std::size_t i = static_cast<std::size_t>(node) % control.outer.size();
          move.motion += weight * (static_cast<std::size_t>(node) < control.outer.size()
                                       ? moved.outer[i] - control.outer[i]
                                       : moved.inner[i] - control.inner[i]);
          move.share += weight;
        }
      }
    }
    return all;
  };
  const std::vector<Move> on_coarse = moves_on(coarse), on_fine = moves_on(divided);
  ASSERT_EQ(on_coarse.size(), on_fine.size());
  std::size_t whole = 0;
  for (std::size_t i = 0; i < on_fine.size(); ++i) {
    // Fibres beside the middle one walk by normals that are interpolated over other triangles, and lie some
    // hundredths of a millimetre apart; near the rim the share of the motion is the vertices'.
    const double share = std::min(on_coarse[i].share, on_fine[i].share);
    EXPECT_LT((on_coarse[i].motion - on_fine[i].motion).norm(), share < 1 - 1e-9 ? 5e-4 : 1e-4) << i;
    if (share >= 1 - 1e-9) ++whole;
  }
  EXPECT_GT(whole, on_fine.size() / 2);
}

TEST_F(Slab, ATautBandBridgesAHollow) {
  const auto hollow = [](double x) { return bump(2 * (x - 0.045), 0) + bump(2 * (x + 0.045), 0); };
  geometry::TriangleMesh two = body;
  for (std::size_t v = 0; v < 121 * 121; ++v) {
    const Vector3d& p = two.vertices[v];
    two.vertices[v].z() = bump(2 * (p.x() - 0.045), 2 * p.y()) + bump(2 * (p.x() + 0.045), 2 * p.y());
  }
  geometry::ControlMesh over = control;
  for (std::size_t i = 0; i < over.outer.size(); ++i) {
    const double rise = bump(2 * (over.outer[i].x() - 0.045), 2 * over.outer[i].y()) +
                        bump(2 * (over.outer[i].x() + 0.045), 2 * over.outer[i].y()) - over.outer[i].z();
    over.outer[i].z() += rise;
    over.inner[i].z() += rise;
  }
  std::vector<Vector3d> points;
  for (int i = 0; i <= 60; ++i) points.emplace_back(-0.09 + 0.003 * i, 0, hollow(-0.09 + 0.003 * i));
  const Binding bound(two, over, {});
  const double skin = length_at_rest(lay_line({points}, two, bound));
  const double taut = length_at_rest(lay_line({points, 0, 0, true}, two, bound));
  const std::vector<Vector3d> tape = geometry::tape(points, Vector3d::UnitY());
  const double hull = geometry::length_of(tape, true) - (points.back() - points.front()).norm();
  EXPECT_LT(taut, skin - 5e-4);
  EXPECT_NEAR(taut, hull, 1e-4);  // facets, as above

  // From crest to crest nothing but air: the bottom of the hollow is no part of the tape's outside.
  points.clear();
  for (int i = 0; i <= 30; ++i) points.emplace_back(-0.045 + 0.003 * i, 0, hollow(-0.045 + 0.003 * i));
  EXPECT_NEAR(length_at_rest(lay_line({points, 0, 0, true}, two, bound)), 0.09, 2e-4);
}

// An averaged band too spans the hollow first, with points of its own, and these hang on the crests alone:
// what lies in the hollow may move.
TEST_F(Slab, WhatATautBandBridgesIsNoPartOfItsMean) {
  const auto height = [](double x, double y) {
    const double hollow = std::max(0.0, 1 - std::pow(x / 0.02, 2));
    return bump(2 * (x - 0.045), 2 * y) + bump(2 * (x + 0.045), 2 * y) - 0.008 * hollow;
  };
  geometry::TriangleMesh two = body;
  for (std::size_t v = 0; v < 121 * 121; ++v)
    two.vertices[v].z() = height(two.vertices[v].x(), two.vertices[v].y());
  geometry::ControlMesh over = control;
  for (std::size_t i = 0; i < over.outer.size(); ++i) {
    const double rise = height(over.outer[i].x(), over.outer[i].y()) - over.outer[i].z();
    over.outer[i].z() += rise;
    over.inner[i].z() += rise;
  }
  std::vector<Vector3d> points;
  for (int i = 0; i <= 60; ++i) points.emplace_back(-0.09 + 0.003 * i, 0, height(-0.09 + 0.003 * i, 0));
  for (const geometry::Fibre& fibre : lay_line({points, 0.03, 0.02, true}, two, Binding(two, over, {}))) {
    for (std::size_t i = 1; i < fibre.points.size(); ++i)
      EXPECT_LT((fibre.points[i].rest - fibre.points[i - 1].rest).norm(), 0.015);  // two a reach, evenly
    for (const geometry::CarriedPoint& point : fibre.points) {
      if (std::abs(point.rest.x()) > 0.02) continue;
      EXPECT_GT(point.rest.z(), height(point.rest.x(), point.rest.y()) + 0.005) << "not in the air";
      double middle = 0;
      for (const auto& [node, weight] : point.weights)
        if (std::abs(over.outer[static_cast<std::size_t>(node) % over.outer.size()].x()) < 0.01)
          middle += std::abs(weight);
      EXPECT_LT(middle, 0.1) << "hangs on the hollow";  // 0.009 at most as it is
    }
  }
}

TEST_F(Slab, ATautBandLiesOnSkinThatIsFlatAlongIt) {
  const auto roof = [](const Vector3d& p) { return -0.5 * std::abs(p.x()); };
  geometry::TriangleMesh ridge = body;
  for (std::size_t v = 0; v < 121 * 121; ++v) ridge.vertices[v].z() = roof(ridge.vertices[v]);
  geometry::ControlMesh over = control;
  for (std::size_t i = 0; i < over.outer.size(); ++i) {
    const double rise = roof(over.outer[i]) - over.outer[i].z();
    over.outer[i].z() += rise;
    over.inner[i].z() += rise;
  }
  std::vector<Vector3d> points;
  for (int i = 0; i <= 60; ++i) points.emplace_back(-0.09 + 0.003 * i, 0, roof({-0.09 + 0.003 * i, 0, 0}));
  const auto fibres = lay_line({points, 0, 0, true}, ridge, Binding(ridge, over, {}));
  ASSERT_EQ(fibres.size(), 1u);
  const auto& laid = fibres.front().points;
  for (std::size_t i = 1; i < laid.size();
       ++i)  // skin carries it all along, not at the ridge and the ends alone
    EXPECT_LT((laid[i].rest - laid[i - 1].rest).norm(), 0.010) << i;
}

TEST_F(Slab, NothingCarriesAnEndThatIsHeld) {
  constexpr double kReach = 0.02;  // of the means
  LineOnBody line{over_the_bump(), 0.03, kReach};
  line.held = {true, false};
  const auto half_held = lay_line(line, body, binding);
  line.held = {false, false};
  const auto carried = lay_line(line, body, binding);
  ASSERT_EQ(half_held.size(), carried.size());
  for (std::size_t f = 0; f < carried.size(); ++f) {
    const auto &held = half_held[f].points, &free = carried[f].points;
    ASSERT_EQ(held.size(), free.size());
    EXPECT_TRUE(held.front().weights.empty());
    EXPECT_FALSE(free.front().weights.empty());
    const auto sum = [](const geometry::CarriedPoint& point) {
      double weights = 0;
      for (const auto& [node, weight] : point.weights) weights += weight;
      return weights;
    };
    double before = 0;
    for (std::size_t i = 0; i < held.size(); ++i) {
      EXPECT_EQ(held[i].rest, free[i].rest);
      const double share = sum(held[i]) / sum(free[i]);
      EXPECT_GE(share, before - 1e-12) << "farther from the end it hangs on it less";
      before = share;
      if ((held[i].rest - held.front().rest).norm() > 2 * kReach) {
        EXPECT_EQ(held[i].weights, free[i].weights);
      }
    }
    EXPECT_LT(sum(held[1]), 0.999 * sum(free[1]));
  }
  // Nor has a taut one entries of weight 0 there: what is held was taken to move.
  LineOnBody taut{over_the_bump()};
  taut.taut = true;
  taut.held = {true, true};
  const auto fibres = lay_line(taut, body, binding);
  EXPECT_TRUE(fibres[0].points.front().weights.empty());
  EXPECT_TRUE(fibres[0].points.back().weights.empty());
}

TEST_F(Slab, RefusesByName) {
  const auto code = [](const auto& work) -> std::string {
    try {
      work();
    } catch (const geometry::Refusal& refusal) {
      return refusal.code();
    }
    return "";
  };
  EXPECT_EQ(code([&] { lay_line({{{-0.05, 0, 0.2}, {0.05, 0, 0.2}}}, body, binding); }), "bad_garment");
  EXPECT_EQ(code([&] { lay_line({{{-0.05, 0, 5}, {0.05, 0, 5}}}, body, binding); }), "bad_garment");
  EXPECT_EQ(code([&] { lay_line({{{0, 0, 0.06}, {0, 0, 0.06}}}, body, binding); }), "bad_garment");
  Options paper;
  paper.setting = Setting::paper;
  const Binding published(body, control, paper);
  EXPECT_EQ(code([&] { lay_line({over_the_bump()}, body, published); }), "bad_option");
}

}  // namespace
}  // namespace tensegric_fit::tffd
