#include <cmath>

#include "../unit/tensegric_bust.hpp"
#include "shapes.hpp"
#include "stability_case.hpp"

namespace tensegric_fit::stability {
namespace {

using Eigen::Vector3d;
using geometry::ControlMesh;
using tensegric::bust_mesh;

Vector3d flat(Vector3d p) {
  return p;
}

/// Mildly curved, so that there is a volume to keep.
Vector3d dome(Vector3d p) {
  return {p.x(), p.y(), 0.02 * std::cos(12 * (p.x() - 0.06)) * std::cos(12 * (p.y() - 0.06))};
}

class Cases {
 public:
  std::vector<Case> list;

  Case& add(const std::string& name, ControlMesh control, tensegric::Garment garment,
            const std::string& refusal = "") {
    list.emplace_back();
    Case& made = list.back();
    made.name = name;
    made.control = std::move(control);
    made.garment = std::move(garment);
    made.refusal = refusal;
    return made;
  }
};

void add_fixing(Cases& cases) {
  ControlMesh control = bust_mesh();
  hold(control, [](int) { return true; });
  cases.add("fixing/all nodes", control, chest(0.9));
  hold(control, [](int) { return false; });
  cases.add("fixing/no node", control, chest(0.9), "bad_mesh").model = tensegric::papers_model();
  const int tip = control.node("bust_point_L");
  hold(control, [tip](int node) { return node != tip; });
  cases.add("fixing/one node free in both layers", control, chest(0.9));
  control.inner_fixed[tip] = 1;
  cases.add("fixing/one outer node free", control, chest(0.9));
  cases.add("fixing/one outer node free, asked for half", control, chest(0.5));
  hold(control, [](int node) { return node < 1; });
  cases.add("fixing/one node held", control, chest(0.9), "bad_mesh").model = tensegric::papers_model();
  hold(control, [](int node) { return node < 2; });
  cases.add("fixing/two nodes held in both layers", control, chest(0.9));
  hold(control, [](int) { return false; });
  control.outer_fixed[0] = control.outer_fixed[5] = control.outer_fixed[10] = 1;
  cases.add("fixing/three nodes held", control, chest(0.9));
}

void add_small(Cases& cases) {
  const geometry::TriangleMesh one{{{0, 0, 0}, {0.05, 0, 0}, {0.01, 0.04, 0}}, {{0, 1, 2}}};
  ControlMesh control = control_of(one, 0.01);
  control.inner_fixed.assign(3, 1);
  cases.add("small/single triangle on a fixed base", control, line_over(control, {0, 1, 2}, 0.9));
  control.outer_fixed[0] = 1;
  cases.add("small/single triangle, a line of two nodes", control, line_over(control, {0, 1}, 0.8));
  hold(control, [](int node) { return node < 2; });
  cases.add("small/single triangle, one node free in both layers", control,
            line_over(control, {0, 1, 2}, 0.9));
  control = sheet(2, 2, dome);
  cases.add("small/one free node in the middle", control, line_over(control, {3, 4, 5}, 0.97));
}

void add_pieces(Cases& cases) {
  ControlMesh second = bust_mesh();
  for (auto* layer : {&second.outer, &second.inner})
    for (Vector3d& p : *layer) p += Vector3d(0.5, 0, 0);
  for (std::string& name : second.names)
    if (!name.empty()) name += "_2";
  second.regions[0].name = "bust_2";
  second.lines[0].name = "chest_2";
  const ControlMesh both = geometry::joined({bust_mesh(), second});
  cases.add("pieces/two busts, one laced", both, chest(0.9));
  tensegric::Garment tie = chest(0.95);
  tie.lines.push_back(tie.lines[0]);
  tie.lines.back().name = "tie";
  tie.lines.back().taut = true;
  tie.lines.back().through = {"bust_point_L", "bust_point_R_2"};
  cases.add("pieces/a line from one to the other", both, tie);
  ControlMesh loose = both;
  for (std::size_t i = both.outer.size() / 2; i < both.outer.size(); ++i)
    loose.outer_fixed[i] = loose.inner_fixed[i] = 0;
  cases.add("pieces/one of them held by nothing", loose, chest(0.9), "bad_mesh").model =
      tensegric::papers_model();
}

void add_degenerate(Cases& cases) {
  const auto add_sheet = [&cases](const std::string& name, const std::function<Vector3d(Vector3d)>& shape,
                                  const std::string& refusal = "?") {
    ControlMesh control = sheet(6, 6, shape);
    cases.add("degenerate/" + name, control, line_over(control, {21, 22, 23, 24, 25, 26, 27}, 0.95), refusal);
  };
  add_sheet("flat sheet", flat, "");
  add_sheet("dome", dome, "");
  for (double aspect : {1e2, 1e4, 1e6})
    add_sheet("slivers of aspect " + std::to_string(static_cast<int>(aspect)), [aspect](Vector3d p) {
      return dome({p.x(), p.y() / aspect, 0});
    });
  add_sheet("one row of slivers", [](Vector3d p) {
    return dome({p.x(), p.y() > 0.05 ? p.y() - 0.02 * (1 - 1e-6) : p.y(), 0});
  });
  add_sheet("all nodes in one line", [](Vector3d p) { return Vector3d(p.x() + 7 * p.y(), 0, 0); });
  add_sheet(
      "all nodes on one point", [](Vector3d) { return Vector3d(0.1, 0.2, 0.3); }, "bad_mesh");
  add_sheet("a triangle of no area", [](Vector3d p) {
    return (p - 0.02 * Vector3d(3, 3, 0)).norm() < 1e-9 ? dome(p + Vector3d(0.01, 0, 0)) : dome(p);
  });
  add_sheet(
      "two joined nodes on one point",
      [](Vector3d p) {
        return (p - 0.02 * Vector3d(3, 3, 0)).norm() < 1e-9 ? dome({0.08, 0.06, 0}) : dome(p);
      },
      "bad_mesh");
  add_sheet("two joined nodes all but on one point", [](Vector3d p) {
    return (p - 0.02 * Vector3d(3, 3, 0)).norm() < 1e-9 ? dome({0.08 - 1e-9, 0.06, 0}) : dome(p);
  });
  add_sheet("a node far out", [](Vector3d p) {
    return (p - 0.02 * Vector3d(3, 3, 0)).norm() < 1e-9 ? Vector3d(0.06, 0.06, 100) : dome(p);
  });
  ControlMesh seam = sheet(6, 6, dome);  // a slit along the middle: the nodes there are double, not joined
  for (int k = 1; k < 6; ++k) {
    const int node = 21 + k, twin = static_cast<int>(seam.outer.size());
    seam.outer.push_back(seam.outer[node]);
    seam.inner.push_back(seam.inner[node]);
    seam.outer_fixed.push_back(0);
    seam.inner_fixed.push_back(0);
    seam.names.emplace_back();
    for (std::size_t t = 36; t < seam.triangles.size(); ++t)
      for (int c = 0; c < 3; ++c)
        if (seam.triangles[t][c] == node) seam.triangles[t][c] = twin;
  }
  cases.add("degenerate/duplicate nodes along a slit", seam,
            line_over(seam, {21, 22, 23, 24, 25, 26, 27}, 0.95), "?");
}

void add_folded(Cases& cases) {
  const auto add_sheet = [&cases](const std::string& name, const std::function<Vector3d(Vector3d)>& shape) {
    ControlMesh control = sheet(6, 6, shape);
    cases.add("folded/" + name, control, line_over(control, {21, 22, 23, 24, 25, 26, 27}, 0.95), "?");
  };
  add_sheet("over a crease", [](Vector3d p) {
    return p.x() > 0.065 ? Vector3d(0.13 - p.x(), p.y(), 0.004) : Vector3d(p.x(), p.y(), 0);
  });
  add_sheet("crossing itself", [](Vector3d p) {
    const double a = 60 * p.x();
    return Vector3d(0.03 * std::sin(a), p.y(), 0.03 * std::cos(a) + 0.001 * p.x());
  });
  add_sheet("one node across its neighbours", [](Vector3d p) {
    return (p - 0.02 * Vector3d(3, 3, 0)).norm() < 1e-9 ? dome(p + Vector3d(0.03, 0.005, 0)) : dome(p);
  });
  add_sheet("saw teeth",
            [](Vector3d p) { return Vector3d(p.x(), p.y(), 0.03 * (std::lround(p.x() / 0.02) % 2)); });
}

void add_thickness(Cases& cases) {
  for (double factor : {0.0, 1e-6, 1e-3, 0.1, 3.0, 10.0, 100.0, -1.0, -0.1}) {
    ControlMesh control = bust_mesh();
    for (std::size_t i = 0; i < control.outer.size(); ++i)
      control.inner[i] = control.outer[i] + factor * (control.inner[i] - control.outer[i]);
    std::string text = std::to_string(factor);
    cases.add("thickness/times " + text.substr(0, text.find_last_not_of('0') + 1), control, chest(0.9),
              factor == 0 ? "bad_mesh" : "?");
  }
  ControlMesh uneven = bust_mesh();
  for (std::size_t i = 0; i < uneven.outer.size(); i += 2)
    uneven.inner[i] = 0.9 * uneven.outer[i] + 0.1 * uneven.inner[i];
  cases.add("thickness/every second node a tenth", uneven, chest(0.9), "?");
}

void add_place_and_size(Cases& cases) {
  const auto moved = [](double scale, const Vector3d& by) {
    ControlMesh control = bust_mesh();
    for (auto* layer : {&control.outer, &control.inner})
      for (Vector3d& p : *layer) p = scale * p + by;
    return control;
  };
  cases.add("scale/a thousandth", moved(1e-3, {0, 0, 0}), chest(0.9));
  cases.add("scale/a thousandth, asked for 0.6", moved(1e-3, {0, 0, 0}), chest(0.6));
  cases.add("scale/thousandfold", moved(1e3, {0, 0, 0}), chest(0.9));
  cases.add("offset/10 km", moved(1, {1e4, -1e4, 1e4}), chest(0.9));
  cases.add("offset/10 km, a thousandth", moved(1e-3, {1e4, -1e4, 1e4}), chest(0.9));
  ControlMesh bad = bust_mesh();
  bad.outer[40].x() = std::nan("");
  cases.add("numbers/a node that is not a number", bad, chest(0.9), "non_finite");
  cases.add("numbers/nodes near the largest number", moved(1e300, {0, 0, 0}), chest(0.9), "bad_mesh");
}

void add_closed(Cases& cases) {
  for (const auto& [around, across] : {std::pair{6, 4}, std::pair{12, 6}, std::pair{24, 12}}) {
    for (double gravity : {1e-4, 1e-3, 1e-2, 1.0}) {
      const std::string size = std::to_string(2 * around * across);
      Case& hung = cases.add("closed/torus of " + size + " triangles, gravity " + std::to_string(gravity),
                             torus(around, across), {});
      hung.solver.gravity = {0, 0, -gravity};
      hung.slow = around > 12;
    }
    ControlMesh ring = torus(around, across);
    std::vector<int> nodes;
    for (int i = 0; i <= around; ++i) nodes.push_back((i % around) * across);
    const tensegric::Garment band = line_over(ring, nodes, 0.9);
    cases
        .add("closed/torus of " + std::to_string(2 * around * across) + " triangles, a band around", ring,
             band)
        .slow = around > 12;
  }
}

}  // namespace

std::vector<Case> mesh_cases() {
  Cases cases;
  add_fixing(cases);
  add_small(cases);
  add_pieces(cases);
  add_degenerate(cases);
  add_folded(cases);
  add_thickness(cases);
  add_place_and_size(cases);
  add_closed(cases);
  return std::move(cases.list);
}

}  // namespace tensegric_fit::stability
