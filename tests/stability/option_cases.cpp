#include <cmath>
#include <random>

#include "../unit/tensegric_bust.hpp"
#include "shapes.hpp"
#include "stability_case.hpp"

namespace tensegric_fit::stability {
namespace {

using tensegric::bust_mesh;
using tensegric::Solution;
using tensegric::Status;

Case bust_case(const std::string& name, double ratio) {
  Case made;
  made.name = name;
  made.control = bust_mesh();
  made.garment = chest(ratio);
  return made;
}

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

Solution standing(const geometry::ControlMesh& control) {
  Solution s;
  s.outer = control.outer;
  s.inner = control.inner;
  s.status = Status::converged;
  return s;
}

}  // namespace

std::vector<Case> option_cases() {
  std::vector<Case> cases;
  for (const tensegric::ModelOptions& model : {tensegric::ModelOptions(), tensegric::papers_model()}) {
    const std::string inner = ", inner nodes " + to_string(model.inner);
    const auto add = [&](const std::string& name, double ratio) -> tensegric::ModelOptions& {
      cases.push_back(bust_case(name + inner, ratio));
      return cases.back().model = model;
    };
    for (double ratio : {0.97, 0.9}) {
      for (double stiffness : {1e-3, 1e-2, 1e-1, 1.0, 1e2, 1e4, 1e6})
        add("strut stiffness/" + text(stiffness) + " at " + text(ratio), ratio).strut_stiffness = stiffness;
      for (double stiffness : {1e-3, 1.0, 1e3})
        add("lateral stiffness/" + text(stiffness) + " at " + text(ratio), ratio).lateral_stiffness =
            stiffness;
      for (double skin : {0.0, 0.1, 10.0})
        add("skin/" + text(skin) + " at " + text(ratio), ratio).skin = skin;
      for (double stiffness : {0.0, 1.0, 30.0, 1e3})
        add("volume stiffness/" + text(stiffness) + " at " + text(ratio), ratio).volume_stiffness = stiffness;
      for (double stiffness : {0.0, 10.0, 1e3})
        add("shear stiffness/" + text(stiffness) + " at " + text(ratio), ratio).shear_stiffness = stiffness;
    }
    for (const int layers : {0, 2, 3, 8, 9})
      for (double ratio : {0.97, 0.9}) {
        add("layers/" + text(layers) + " at " + text(ratio), ratio).layers = layers;
        cases.back().refusal = layers < 1 || layers > 8 ? "bad_option" : "";
      }
    for (double prestress : {0.0, 1e-6, 1e-3, 0.1, 0.2, 0.5, 1.0}) {
      add("prestress/" + text(prestress), 0.9).prestress = prestress;
      cases.back().refusal = prestress == 0 || prestress > 0.5 ? "bad_option" : "";
    }
    tensegric::ModelOptions& near =
        add("prestress/near buckling", 0.95);  // soft struts under a high pressure
    near.strut_stiffness = 0.05;
    near.prestress = 0.2;
  }
  for (double force : {0.0, 1.0, 30.0, 1e3, 1e6}) {
    cases.push_back(bust_case("pseudo forces/of lines " + text(force), 0.9));
    cases.back().solver.line_force = force;
    cases.push_back(bust_case("pseudo forces/of volume " + text(force), 0.9));
    cases.back().solver.volume_force = force;
  }
  for (double gravity : {1e-6, 1e-2, 1.0, 1e3, 1e9}) {
    cases.push_back(bust_case("gravity/" + text(gravity), 0.95));
    cases.back().solver.gravity = {0, 0, -gravity};
  }
  cases.push_back(bust_case("cap/one iteration", 0.9));
  cases.back().solver.max_iterations = 1;

  const geometry::ControlMesh bust = bust_mesh();
  cases.push_back(bust_case("start/all free nodes on one point", 0.9));
  cases.back().start = standing(bust);
  for (std::size_t i = 0; i < bust.outer.size(); ++i)
    if (!bust.outer_fixed[i]) cases.back().start->outer[i] = cases.back().start->inner[i] = {0, 0, 1.2};
  cases.push_back(bust_case("start/turned inside out", 0.9));
  cases.back().start = standing(bust);
  for (std::size_t i = 0; i < bust.outer.size(); ++i)
    if (!bust.outer_fixed[i]) std::swap(cases.back().start->outer[i], cases.back().start->inner[i]);
  cases.push_back(bust_case("start/a kilometre away", 0.9));
  cases.back().start = standing(bust);
  for (auto* layer : {&cases.back().start->outer, &cases.back().start->inner})
    for (Eigen::Vector3d& p : *layer) p.x() += 1000;
  cases.push_back(bust_case("start/not a number", 0.9));
  cases.back().start = standing(bust);
  cases.back().start->inner[40].z() = std::nan("");
  cases.back().refusal = "bad_option";
  cases.push_back(bust_case("start/of another mesh", 0.9));
  cases.back().start = standing(bust);
  cases.back().start->outer.pop_back();
  cases.back().refusal = "bad_option";
  return cases;
}

Case random_start_case(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&random](double low, double high) {  // the standard's distributions differ by library
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  tensegric::BustShape shape;
  shape.columns = 6;
  shape.rows = 4;
  shape.lopsided = between(-0.01, 0.01);
  Case made;
  made.name = "random start/seed " + std::to_string(seed);
  made.control = bust_mesh(shape);
  const std::vector<int> middle = made.control.lines[0].nodes;
  made.garment = line_over(made.control, middle, between(0.7, 1.1));
  made.start = standing(made.control);
  const double reach = std::pow(10, between(-4, 0));  // metres
  for (std::size_t i = 0; i < made.control.outer.size(); ++i) {
    for (int k = 0; k < 3 && !made.control.outer_fixed[i]; ++k)
      made.start->outer[i][k] += between(-reach, reach);
    for (int k = 0; k < 3 && !made.control.inner_fixed[i]; ++k)
      made.start->inner[i][k] += between(-reach, reach);
  }
  return made;
}

}  // namespace tensegric_fit::stability
