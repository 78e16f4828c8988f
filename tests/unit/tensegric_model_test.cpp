// The tensegric model: counts, prestress, and derivatives of its energy, volumes and lines.
#include "tensegric/model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>

#include "geometry/status.hpp"
#include "tensegric/band_length.hpp"
#include "tensegric/members.hpp"
#include "tensegric/prestress.hpp"
#include "tensegric/problem.hpp"
#include "tensegric/region_volume.hpp"
#include "tensegric/tension_law.hpp"
#include "tensegric_bust.hpp"

namespace tensegric_fit::tensegric {
namespace {

TEST(Model, CountsOfTheBust) {
  const Model model = build_model(bust_mesh(), papers_model());
  EXPECT_EQ(model.control.outer.size(), 77U);
  EXPECT_EQ(model.control.triangles.size(), 120U);
  EXPECT_EQ(model.struts(), 360);
  EXPECT_EQ(model.tensile_parts(), 469);
  EXPECT_EQ(model.free_nodes(), 90);  // 45 within the rim, in both layers
  BustShape shape;
  shape.rim_inner_fixed = false;
  EXPECT_EQ(3 * build_model(bust_mesh(shape), papers_model()).free_nodes(), 366);
  EXPECT_EQ(build_model(bust_mesh(shape), {}).free_nodes(), 45);  // inner nodes bound
}

TEST(Member, StiffensWithStrain) {
  for (const bool strut : {true, false})
    for (const double length : {0.07, 0.097, 0.101, 0.12}) {
      const Member m{0, 1, strut, 2, 0.1, strut ? 0.103 : 0.09, 300};
      Model model;
      model.members = {m};
      const auto energy = [&](double l) { return member_energy(model, {{0, 0, 0}, {l, 0, 0}}); };
      const double h = 1e-6;
      EXPECT_NEAR((energy(length + h) - energy(length - h)) / (2 * h), tension(m, length), 1e-7);
      if (!strut && length <= m.natural) {
        EXPECT_EQ(tension(m, length), 0);
        continue;
      }
      EXPECT_NEAR((tension(m, length + h) - tension(m, length - h)) / (2 * h), tangent(m, length), 1e-4);
      if (!strut) {
        EXPECT_NEAR(secant(m, length) * (length - m.natural), tension(m, length), 1e-12);
      }
    }
  // By hand at a strain of 0.2: k l0 ((e - prestrain)^2 / 2 + c e^4 / 4), and k (e - prestrain + c e^3).
  Model part;
  part.members = {{0, 1, false, 2, 0.1, 0.09, 300}};
  EXPECT_NEAR(member_energy(part, {{0, 0, 0}, {0.12, 0, 0}}), 0.2 * (0.045 + 0.12), 1e-12);
  EXPECT_NEAR(tension({0, 1, false, 2, 0.1, 0.09, 300}, 0.12), 2 * (0.3 + 300 * 0.008), 1e-12);
}

TEST(Model, PrestressBalancesWithTheRightSigns) {
  ModelOptions layered;
  layered.layers = 3;
  for (const ModelOptions& options : {ModelOptions(), papers_model(), layered}) {
    for (double thinner : {1.0, 0.5}) {
      for (bool rim_inner_fixed : {true, false}) {
        BustShape shape;
        shape.rim_inner_fixed = rim_inner_fixed;
        geometry::ControlMesh control = bust_mesh(shape);
        for (std::size_t i = 0; i < control.outer.size(); ++i)
          control.inner[i] = control.outer[i] + thinner * (control.inner[i] - control.outer[i]);
        const Model model = build_model(control, options);
        const Positions rest = model.rest_positions();
        double highest = 0;
        for (const Member& m : model.members) {
          const double force = tension(m, m.rest);
          highest = std::max(highest, std::abs(force));
          if (m.strut)
            EXPECT_LE(force, 0);
          else
            EXPECT_GT(force, 0);
          EXPECT_GT(m.natural, 0);
        }
        Eigen::VectorXd gradient = Eigen::VectorXd::Zero(3 * model.free_nodes());
        add_member_gradient(model, rest, model.free_index(), gradient);
        EXPECT_LE(gradient.cwiseAbs().maxCoeff(), 1e-12 * highest);
        EXPECT_LE(model.mean_tension(), options.prestress + 1e-12);
        EXPECT_GT(model.mean_tension(),
                  0.2 * options.prestress);  // less only where a part would be stretched too far
      }
    }
  }
}

// Its prestress balances to no more than round-off.
TEST(Model, OneFreeNodeOnADomeHasAPrestress) {
  geometry::ControlMesh control;
  for (int j = 0; j <= 2; ++j)
    for (int i = 0; i <= 2; ++i) {
      const double x = 0.02 * i, y = 0.02 * j;
      control.outer.emplace_back(x, y, 0.02 * std::cos(12 * (x - 0.06)) * std::cos(12 * (y - 0.06)));
      control.outer_fixed.push_back(i != 1 || j != 1);
      if (i == 2 || j == 2) continue;
      const int here = 3 * j + i;
      control.triangles.emplace_back(here, here + 1, here + 4);
      control.triangles.emplace_back(here, here + 4, here + 3);
    }
  const auto normals = geometry::vertex_normals(control.outer, control.triangles);
  for (int v = 0; v < 9; ++v) control.inner.push_back(control.outer[v] - 0.01 * normals[v]);
  control.inner_fixed = control.outer_fixed;
  control.names.resize(9);
  control.regions.push_back({"dome", {0, 1, 2, 3, 4, 5, 6, 7}});
  const Model model = build_model(control, {});
  EXPECT_EQ(model.free_nodes(), 1);
  for (const Member& m : model.members) EXPECT_TRUE(m.strut || tension(m, m.rest) >= 0);
}

// A piece of fixed nodes alone stands, wherever it comes in the list.
TEST(Model, ATriangleThatIsFixedStands) {
  geometry::ControlMesh lone;
  lone.outer = {{0, 0, 0}, {0.02, 0, 0}, {0, 0.02, 0}};
  for (const Eigen::Vector3d& p : lone.outer) lone.inner.push_back(p - Eigen::Vector3d(0, 0, 0.01));
  lone.triangles = {{0, 1, 2}};
  lone.outer_fixed = lone.inner_fixed = {1, 1, 1};
  lone.names.resize(3);
  lone.regions.push_back({"lone", {0}});
  for (const auto& parts : {std::vector{lone, bust_mesh()}, std::vector{bust_mesh(), lone}})
    EXPECT_EQ(build_model(geometry::joined(parts), papers_model()).free_nodes(), 90);
}

// Else a garment of the bust pulls differently where the hips have a control mesh, too.
TEST(Model, APieceIsPrestressedAsIfItStoodAlone) {
  const geometry::ControlMesh bust = bust_mesh();
  geometry::ControlMesh other = bust;  // larger, and thinner
  for (auto* nodes : {&other.outer, &other.inner})
    for (Eigen::Vector3d& p : *nodes) p = Eigen::Vector3d(1.6 * p.x(), 1.3 * p.y(), 0.7 * p.z() - 1);
  for (std::size_t i = 0; i < other.outer.size(); ++i)
    other.inner[i] = other.outer[i] + 0.5 * (other.inner[i] - other.outer[i]);
  other.names.assign(other.outer.size(), "");
  other.lines.clear();
  other.regions[0].name = "other";
  ModelOptions options;
  options.layers = 3;
  const Model alone = build_model(bust, options),
              both = build_model(geometry::joined({bust, other}), options);
  const int here = static_cast<int>(bust.outer.size()), there = static_cast<int>(both.control.outer.size());
  std::map<std::pair<int, int>, double> shortened;
  for (const Member& m : both.members) shortened[{m.a, m.b}] = m.natural / m.rest;
  const auto moved = [&](int node) { return node / here * there + node % here; };  // in the same level
  for (const Member& m : alone.members) {
    const auto same = shortened.find({moved(m.a), moved(m.b)});
    ASSERT_NE(same, shortened.end());
    EXPECT_NEAR(same->second, m.natural / m.rest, 1e-9);  // rounding of what is summed in another order
  }
}

// Only the ratios of the ideal densities count: in other units the densities are the same ones.
TEST(Model, DensitiesBalanceInAnyUnit) {
  const Model model = build_model(bust_mesh(), {});
  const Positions rest = model.rest_positions();
  const std::vector<int> free_index = model.free_index();
  for (const double unit : {1.0, 0.01, 100.0}) {
    std::vector<double> ideal;
    for (const Member& m : model.members) ideal.push_back(m.strut ? unit : 0.6 * unit);
    const Eigen::VectorXd density = force_densities(model, ideal);
    std::vector<Eigen::Vector3d> net(model.free_nodes(), Eigen::Vector3d::Zero());
    double largest = 0;
    for (std::size_t i = 0; i < model.members.size(); ++i) {
      const Member& m = model.members[i];
      const Eigen::Vector3d force = density[i] * (rest[m.b] - rest[m.a]);
      largest = std::max(largest, force.norm());
      if (free_index[m.a] >= 0) net[free_index[m.a]] += force;
      if (free_index[m.b] >= 0) net[free_index[m.b]] -= force;
    }
    for (const Eigen::Vector3d& force : net) EXPECT_LE(force.norm(), 1e-12 * largest) << unit;
  }
}

TEST(Model, RefusesWhatCannotStand) {
  const auto code = [](const geometry::ControlMesh& control, const ModelOptions& options) {
    try {
      build_model(control, options);
    } catch (const geometry::Refusal& r) {
      return r.code();
    }
    return std::string("built");
  };
  geometry::ControlMesh loose = bust_mesh();
  loose.outer_fixed.assign(loose.outer.size(), 0);
  loose.inner_fixed.assign(loose.outer.size(), 0);
  EXPECT_EQ(code(loose, papers_model()), "bad_mesh");
  geometry::ControlMesh flat = bust_mesh();
  flat.inner = flat.outer;
  EXPECT_EQ(code(flat, papers_model()), "bad_mesh");
  geometry::ControlMesh second = bust_mesh();
  for (std::string& name : second.names) name.clear();
  second.regions[0].name = second.lines[0].name = "second";
  geometry::ControlMesh both = geometry::joined({bust_mesh(), second});
  EXPECT_EQ(code(both, papers_model()), "built");
  std::fill(both.outer_fixed.begin() + 77, both.outer_fixed.end(), 0);
  std::fill(both.inner_fixed.begin() + 77, both.inner_fixed.end(), 0);
  EXPECT_EQ(code(both, papers_model()), "bad_mesh");  // one of the two would float
  const auto code_with = [&](double ModelOptions::*option, double value) {
    ModelOptions options;
    options.*option = value;
    return code(bust_mesh(), options);
  };
  for (const auto& [name, option, range] : kModelNumbers) {
    EXPECT_EQ(code_with(option, 0.9 * range.low - 1e-9), "bad_option") << name;
    EXPECT_EQ(code_with(option, 1.1 * range.high), "bad_option") << name;
    EXPECT_EQ(code_with(option, range.high), "built") << name;
  }
}

// A deformed state and a direction for differences; the seed is printed where a test fails.
class Derivatives : public testing::Test {
 protected:
  Derivatives() : model(build_model(bust_mesh(), {})), free_index(model.free_index()) {
    std::normal_distribution<double> normal(0, 1);
    direction =
        Eigen::VectorXd::NullaryExpr(3 * model.free_nodes(), [&](Eigen::Index) { return normal(random); });
    do {
      x = model.rest_positions();
      for (std::size_t i = 0; i < x.size(); ++i)
        if (free_index[i] >= 0)
          for (int k = 0; k < 3; ++k) x[i][k] += 0.003 * normal(random);
    } while (any_part_about_to_slacken());
    std::vector<std::pair<int, int>> pairs;
    for (const Member& m : model.members)
      if (free_index[m.a] >= 0 && free_index[m.b] >= 0) pairs.emplace_back(free_index[m.a], free_index[m.b]);
    hessian = std::make_unique<NodeMatrix>(model.free_nodes(), pairs);
  }

  // There the second derivative jumps.
  bool any_part_about_to_slacken() const {
    return std::any_of(model.members.begin(), model.members.end(), [this](const Member& m) {
      return !m.strut && std::abs((x[m.a] - x[m.b]).norm() - m.natural) < 20 * kStep;
    });
  }

  Positions moved(double step) const {
    Positions y = x;
    for (std::size_t i = 0; i < y.size(); ++i)
      if (free_index[i] >= 0) y[i] += step * direction.segment<3>(3 * free_index[i]);
    return y;
  }

  // Central differences of value and gradient along the direction, against gradient and second derivative.
  template <typename Value, typename Gradient>
  void check(const Value& value, const Gradient& gradient) const {
    const Positions up = moved(kStep), down = moved(-kStep);
    const Eigen::VectorXd here = gradient(x);
    const double slope = (value(up) - value(down)) / (2 * kStep);
    EXPECT_NEAR(here.dot(direction), slope, 1e-6 * (std::abs(slope) + here.norm()));
    const Eigen::VectorXd change = (gradient(up) - gradient(down)) / (2 * kStep);
    const Eigen::VectorXd product = hessian->lower().selfadjointView<Eigen::Lower>() * direction;
    EXPECT_LE((change - product).norm(), 1e-6 * change.norm());
  }

  static constexpr double kStep =
      1e-7;  // m; rounding and the third derivative then stay below 1e-7 of the result
  const unsigned seed = std::random_device{}();
  const testing::ScopedTrace trace{__FILE__, __LINE__, "seed " + std::to_string(seed)};
  std::mt19937 random{seed};
  Model model;
  std::vector<int> free_index;
  Positions x;
  Eigen::VectorXd direction;
  std::unique_ptr<NodeMatrix> hessian;
};

TEST_F(Derivatives, OfTheMembersEnergy) {
  add_member_hessian(model, x, free_index, *hessian);
  check([&](const Positions& y) { return member_energy(model, y); },
        [&](const Positions& y) {
          Eigen::VectorXd gradient = Eigen::VectorXd::Zero(direction.size());
          add_member_gradient(model, y, free_index, gradient);
          return gradient;
        });
}

TEST_F(Derivatives, OfTheVolume) {
  const RegionVolume region = region_volume_of(model, model.control.regions[0]);
  EXPECT_EQ(volume_error(region, model.rest_positions()), 0);
  add_volume_hessian(region, x, free_index, 1, *hessian);
  check([&](const Positions& y) { return volume(region, y); },
        [&](const Positions& y) {
          Eigen::VectorXd gradient = Eigen::VectorXd::Zero(direction.size());
          add_volume_gradient(region, y, free_index, 1, gradient);
          return gradient;
        });
}

TEST_F(Derivatives, OfALineAlsoWhereItCollapses) {
  Garment garment;
  garment.lines.push_back({"chest", 0.9, {}, 1, {}, false});
  const Band band = lay_bands(model, garment)[0];
  EXPECT_DOUBLE_EQ(smooth_length(band, x), line_length(band.nodes, x));
  x[band.nodes[4]] = x[band.nodes[5]] + Eigen::Vector3d(2e-4, 1e-4, -3e-4);  // a segment below 1 mm
  EXPECT_GT(smooth_length(band, x), line_length(band.nodes, x));
  LengthCurvature(band, free_index).add(x, 1, *hessian);
  check([&](const Positions& y) { return smooth_length(band, y); },
        [&](const Positions& y) {
          Eigen::VectorXd gradient = Eigen::VectorXd::Zero(direction.size());
          add_length_gradient(band, y, free_index, 1, gradient);
          return gradient;
        });
}

TEST(Band, ARatioOrATensionLimitThatIsNotPositiveIsRefused) {
  const Model model = build_model(bust_mesh(), {});
  const auto code = [&](double ratio, double limit) {
    Garment garment = chest(ratio);
    garment.lines.front().tension_limit = limit;
    try {
      lay_bands(model, garment);
    } catch (const geometry::Refusal& refusal) {
      return refusal.code();
    }
    return std::string("laid");
  };
  EXPECT_EQ(code(0.9, 1), "laid");
  EXPECT_EQ(code(1e-9, 0), "laid");
  for (const double ratio : {0.0, -0.9, static_cast<double>(NAN), static_cast<double>(INFINITY)})
    EXPECT_EQ(code(ratio, 1), "bad_garment") << ratio;
  for (const double limit : {-1.0, static_cast<double>(NAN)})
    EXPECT_EQ(code(0.9, limit), "bad_garment") << limit;
}

// What no garment pulls is so many newtons, whatever the mesh.
TEST(Band, WithoutALimitItGivesWayAtTheSameNewtonsOnEveryMesh) {
  BustShape finer;
  finer.columns *= 2;
  finer.rows *= 2;
  std::vector<double> pseudo;
  for (const geometry::ControlMesh& mesh : {bust_mesh(), bust_mesh(finer)}) {
    const Model model = build_model(mesh, {});
    const SolverOptions options;
    const Problem problem = lay_garment(model, chest(0.9), options);
    pseudo.push_back(hold_limit(problem, problem.bands[0]));
    EXPECT_NEAR(pseudo.back() * model.newtons(), 260, 1e-9);
    Garment limited = chest(0.9);
    limited.lines[0].tension_limit = 3;
    const Problem with_limit = lay_garment(model, limited, options);
    EXPECT_EQ(hold_limit(with_limit, with_limit.bands[0]), 3);
  }
  EXPECT_GT(pseudo[1], 1.5 * pseudo[0]);
}

TEST(Law, TableIsLinearInBetweenAndGoesOn) {
  TensionLaw law;
  law.kind = TensionLaw::Kind::table;
  law.table = {{1, 0}, {1.1, 2}, {1.3, 3}};
  EXPECT_EQ(law_tension(law, 0.8), 0);
  EXPECT_NEAR(law_tension(law, 1.05), 1, 1e-12);
  EXPECT_NEAR(law_tension(law, 1.2), 2.5, 1e-12);
  EXPECT_NEAR(law_tension(law, 1.5), 4, 1e-12);
  for (double stretch : {1.04, 1.2, 1.45})  // away from the corners; 1e-6 is far above rounding
    EXPECT_NEAR((law_work(law, stretch + 1e-5) - law_work(law, stretch - 1e-5)) / 2e-5,
                law_tension(law, stretch), 1e-6);
}

}  // namespace
}  // namespace tensegric_fit::tensegric
