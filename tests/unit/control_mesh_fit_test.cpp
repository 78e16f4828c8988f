// The bust template on a trunk whose shape is known in closed form: an elliptic cylinder with two breasts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "control_mesh/fit_template.hpp"
#include "control_mesh/grid.hpp"
#include "control_mesh/placing.hpp"
#include "control_mesh/skin.hpp"
#include "control_mesh_templates.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kBustLevel = 1.2, kBustAngle = kPi / 5, kBreastHeight = 0.05;
constexpr int kAround = 200,
              kUp = 140;  // even and mirror-symmetric: columns at +-theta, one at 0 and one at pi

struct Trunk {
  geometry::TriangleMesh mesh;
  geometry::BodyMeasures measures;
};

struct Breast {
  double sag = 0;   // m, how far it hangs; above 0.02 it hides its own fold from the front
  double tilt = 0;  // m/rad, how its fold rises sideways
};

Vector3d trunk_point(double level, double angle, const Breast& shape) {
  const double turn = std::abs(angle) - kBustAngle, rise = level - kBustLevel - shape.tilt * turn;
  const double breast = std::exp(-(turn * turn) / (2 * 0.25 * 0.25) - rise * rise / (2 * 0.03 * 0.03));
  const double taper = 1 - 0.8 * std::max(0.0, level - 1.25);
  return {(0.11 * taper + kBreastHeight * breast) * std::cos(angle),
          (0.15 * taper + 0.02 * breast) * std::sin(angle), level - shape.sag * breast};
}

Trunk make_trunk(const Breast& shape = {}) {
  Trunk trunk;
  auto& [vertices, triangles] = trunk.mesh;
  const auto at = [](int up, int around) { return up * kAround + (around + kAround) % kAround; };
  const auto angle_of = [](int around) {
    return 2 * kPi * (around > kAround / 2 ? around - kAround : around) / kAround;
  };
  for (int up = 0; up < kUp; ++up)
    for (int around = 0; around < kAround; ++around)
      vertices.push_back(trunk_point(kBustLevel - 0.35 + 0.005 * up, angle_of(around), shape));
  for (int up = 0; up + 1 < kUp; ++up)
    for (int around = 0; around < kAround; ++around) {
      const int a = at(up, around), b = at(up, around + 1), c = at(up + 1, around),
                d = at(up + 1, around + 1);
      if (around < kAround / 2) {  // the diagonals are mirrored too
        triangles.emplace_back(a, b, d);
        triangles.emplace_back(a, d, c);
      } else {
        triangles.emplace_back(a, b, c);
        triangles.emplace_back(b, d, c);
      }
    }
  const int bottom = static_cast<int>(vertices.size()), top = bottom + 1;
  vertices.emplace_back(0, 0, vertices[at(0, 0)].z());
  vertices.emplace_back(0, 0, vertices[at(kUp - 1, 0)].z());
  for (int around = 0; around < kAround; ++around) {
    triangles.emplace_back(bottom, at(0, around + 1), at(0, around));
    triangles.emplace_back(top, at(kUp - 1, around), at(kUp - 1, around + 1));
  }

  const auto add = [&](const std::string& name, int up, int around) {
    trunk.measures.landmarks.push_back({name, vertices[at(up, around)], 1.0, ""});
  };
  const int level = 70, side = kAround / 4, bust = kAround / 10;  // vertices at bust level, 90 and 36 degrees
  for (int sign : {1, -1}) {
    const std::string ending = sign > 0 ? "_L" : "_R";
    add("bust_point" + ending, level, sign * bust);
    add("underbust" + ending, level - 14, sign * bust);
    add("axilla" + ending, level + 12, sign * side);
  }
  add("neck_front", level + 40, 0);
  return trunk;
}

control_mesh::Options finer(int triangles) {
  control_mesh::Options options;
  options.control_triangles = triangles;
  return options;
}

geometry::ControlMesh fit(const Trunk& trunk, int triangles = 120) {
  return control_mesh::fit_template(control_mesh::load_template(kBust), trunk.mesh, trunk.measures,
                                    finer(triangles));
}

std::vector<char> on_rim(const geometry::ControlMesh& control) {
  std::vector<char> rim(control.outer.size(), 0);
  for (const geometry::Edge& edge : geometry::edges_of({control.outer, control.triangles}))
    if (edge.right < 0) rim[edge.first] = rim[edge.second] = 1;
  return rim;
}

/// Triangles that face against the skin nearest to them.
int turned_triangles(const geometry::ControlMesh& control, const geometry::TriangleMesh& body) {
  const geometry::PointTree tree(body.vertices);
  const auto normals = geometry::vertex_normals(body.vertices, body.triangles);
  int turned = 0;
  for (const Eigen::Vector3i& t : control.triangles) {
    const Vector3d middle = (control.outer[t[0]] + control.outer[t[1]] + control.outer[t[2]]) / 3;
    Vector3d skin = normals[tree.nearest(middle)];
    for (int i = 0; i < 3; ++i) skin += normals[tree.nearest((middle + control.outer[t[i]]) / 2)];
    turned += area_of(control.outer, t).dot(skin) <= 0;
  }
  return turned;
}

/// Angle in degrees between two triangles' normals, the largest over all edges.
double sharpest_fold(const geometry::ControlMesh& control, const std::vector<Vector3d>& nodes) {
  double least = 1;
  for (const geometry::Edge& edge : geometry::edges_of({control.outer, control.triangles}))
    if (edge.right >= 0)
      least = std::min(least, area_of(nodes, control.triangles[edge.left])
                                  .normalized()
                                  .dot(area_of(nodes, control.triangles[edge.right]).normalized()));
  return std::acos(least) * 180 / kPi;
}

double smallest_angle(const geometry::ControlMesh& control) {
  double least = kPi;
  for (const auto& t : control.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vector3d u = control.outer[t[(k + 1) % 3]] - control.outer[t[k]];
      const Vector3d v = control.outer[t[(k + 2) % 3]] - control.outer[t[k]];
      least = std::min(least, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
  return least * 180 / kPi;
}

class OnTrunk : public testing::TestWithParam<double> {};  // the parameter is the sag
INSTANTIATE_TEST_SUITE_P(FirmAndHanging, OnTrunk, testing::Values(0.0, 0.03));

TEST_P(OnTrunk, NodesLieOnTheSkin) {
  const Trunk trunk = make_trunk({GetParam()});
  const control_mesh::Skin skin(trunk.mesh);
  const auto control = fit(trunk);
  const std::vector<char> rim = on_rim(control);
  for (std::size_t v = 0; v < control.outer.size(); ++v) {
    const double distance = (skin.nearest(control.outer[v]) - control.outer[v]).norm();
    EXPECT_LE(distance, rim[v] ? 1e-9 : 0.003 + 1e-9) << "node " << v;  // nodes inside may be lifted by 3 mm
  }
}

TEST_P(OnTrunk, BustPointsAndFoldAreNodes) {
  const Trunk trunk = make_trunk({GetParam()});
  const auto control = fit(trunk);
  for (const char* name : {"bust_point_L", "bust_point_R", "underbust_L", "underbust_R"})
    EXPECT_LE((control.outer[control.node(name)] - trunk.measures.landmark(name)).norm(), 1e-9) << name;
  const Vector3d side = control.outer[control.node("axilla_L")];
  EXPECT_NEAR(side.z(), trunk.measures.landmark("bust_point_L").z(),
              1e-9);                              // the chest line starts at bust level
  EXPECT_LT(std::abs(side.x()), 0.3 * side.y());  // and at the side
}

TEST_P(OnTrunk, SymmetricBodyGivesSymmetricControlMesh) {
  const auto control = fit(make_trunk({GetParam()}), 480);
  std::vector<char> met(control.outer.size(), 0);
  for (std::size_t v = 0; v < control.outer.size(); ++v) {
    const Vector3d mirrored = control.outer[v].cwiseProduct(Vector3d(1, -1, 1));
    std::size_t twin = 0;
    for (std::size_t w = 1; w < control.outer.size(); ++w)
      if ((control.outer[w] - mirrored).norm() < (control.outer[twin] - mirrored).norm()) twin = w;
    met[twin] = 1;
    EXPECT_LE((control.outer[twin] - mirrored).norm(), 1e-9);  // symmetric to 1e-9 m
    EXPECT_LE((control.inner[twin] - control.inner[v].cwiseProduct(Vector3d(1, -1, 1))).norm(), 1e-9);
    EXPECT_EQ(control.outer_fixed[twin], control.outer_fixed[v]);
  }
  EXPECT_EQ(std::count(met.begin(), met.end(), 0), 0);
}

TEST_P(OnTrunk, TrianglesAreWellShaped) {
  const auto control = fit(make_trunk({GetParam()}));
  for (const auto& t : control.triangles) {
    const Vector3d outer = area_of(control.outer, t), inner = area_of(control.inner, t);
    EXPECT_GT(outer.dot(inner), 0) << "an inner triangle is turned over";
    EXPECT_GT(inner.norm(), 0.1 * outer.norm());
  }
  EXPECT_GT(smallest_angle(control), 12);
  EXPECT_LT(sharpest_fold(control, control.outer),
            GetParam() > 0 ? 130 : 90);  // a hanging breast's fold is sharp itself
}

TEST_P(OnTrunk, InnerNodesAreInside) {
  const Trunk trunk = make_trunk({GetParam()});
  const auto control = fit(trunk);
  const control_mesh::Skin skin(trunk.mesh);
  for (std::size_t v = 0; v < control.inner.size(); ++v) {
    const Vector3d foot = skin.nearest(control.inner[v]);
    EXPECT_GT((foot - control.inner[v]).norm(), 0.004) << "node " << v;
    const auto above =
        skin.first_exit(control.inner[v], (control.outer[v] - control.inner[v]).normalized(), 0.1);
    EXPECT_TRUE(above.has_value()) << "node " << v;
  }
}

TEST_P(OnTrunk, HoldsAsMuchAsTheBodyBelowIt) {
  const Trunk trunk = make_trunk({GetParam()});
  const auto coarse = fit(trunk),
             fine = fit(trunk, 7680);  // 7680 triangles of 3 mm stand for the skin itself
  const Vector3d apex = geometry::region_apex(coarse, coarse.regions[0]);
  const double body = geometry::cone_volume(fine.outer, fine.triangles, apex);
  EXPECT_NEAR(geometry::cone_volume(coarse.outer, coarse.triangles, apex) / body, 1, 0.02);
}

TEST(FitTemplate, FoldsThatAreNotLevelTurnNoTriangle) {
  const Breast rising{0.07, 0.4}, falling{0.07, -0.15}, at_bust_level{0.08, 0};
  for (const Breast& shape : {rising, falling, at_bust_level}) {
    const Trunk trunk = make_trunk(shape);
    EXPECT_EQ(turned_triangles(fit(trunk), trunk.mesh), 0) << "sag " << shape.sag << ", tilt " << shape.tilt;
  }
}

// Of finer triangles the middles of edges would lie across the fold; they slide along it first.
TEST(FitTemplate, FinerTrianglesOverAFoldAreWellShaped) {
  for (const double tilt : {-0.3, 0.0, 0.2}) {
    const Trunk trunk = make_trunk({0.06, tilt});
    const auto fine = fit(trunk, 480);
    EXPECT_EQ(turned_triangles(fine, trunk.mesh), 0) << tilt;
    EXPECT_GT(smallest_angle(fine), 8) << tilt;
  }
}

/// How far out of the bare trunk, as a share of it.
double out_of_trunk(const Vector3d& p) {
  return std::hypot(p.x() / 0.11, p.y() / 0.15) - 1;
}

Vector3d left_node(const std::vector<Vector3d>& nodes, const control_mesh::Template& pattern, int row,
                   int column) {
  return nodes[control_mesh::node_at(pattern, row, column, control_mesh::Side::left)];
}

TEST(FitTemplate, NodesBelowTheFoldLieOnTheChest) {
  Trunk trunk = make_trunk({0.1, 0.3});  // the fold falls steeply towards the middle
  for (geometry::Landmark& landmark : trunk.measures.landmarks)
    if (landmark.name.rfind("bust_point", 0) == 0) {  // on top of the breasts
      const int around = landmark.name.back() == 'L' ? kAround / 10 : kAround - kAround / 10;
      landmark.position = trunk.mesh.vertices[76 * kAround + around];
    }
  const auto pattern = control_mesh::load_template(kBust);
  const auto nodes = control_mesh::place_nodes(pattern, trunk.measures, control_mesh::Skin(trunk.mesh));
  EXPECT_LT(out_of_trunk(left_node(nodes, pattern, 5, 4)), 0.2);
  EXPECT_EQ(turned_triangles(fit(trunk), trunk.mesh), 0);
}

TEST(FitTemplate, NodesAboveTheFoldLieOnTheBreast) {
  const Trunk trunk = make_trunk({0.08, 0});  // the fold is at bust level
  const auto pattern = control_mesh::load_template(kBust);
  const control_mesh::Skin skin(trunk.mesh);
  const auto nodes =
      control_mesh::place_nodes(pattern, trunk.measures, skin, control_mesh::Layout::over_folds);
  EXPECT_GT(out_of_trunk(left_node(nodes, pattern, 3, 2)), 0.2);
}

TEST(FitTemplate, WithoutAFoldNodesLieAtTheirLevels) {
  const auto pattern = control_mesh::load_template(kBust);
  for (const Breast& shape : {Breast{0, 0}, Breast{0, 0.15}, Breast{0, -0.15}}) {
    const Trunk trunk = make_trunk(shape);
    const control_mesh::Skin skin(trunk.mesh);
    const auto nodes = control_mesh::place_nodes(pattern, trunk.measures, skin);
    EXPECT_EQ(nodes,
              control_mesh::place_nodes(pattern, trunk.measures, skin, control_mesh::Layout::over_folds));
    const double bust = trunk.measures.landmark("bust_point_L").z(),
                 underbust = trunk.measures.landmark("underbust_L").z();
    for (const int column : {1, 2, 4}) EXPECT_NEAR(left_node(nodes, pattern, 3, column).z(), bust, 1e-9);
    EXPECT_NEAR(left_node(nodes, pattern, 5, 4).z(), underbust - 0.012,
                1e-9);  // as the template says
  }
}

TEST(FitTemplate, SubdivisionKeepsWhatTheTemplateSays) {
  const Trunk trunk = make_trunk();
  const auto coarse = fit(trunk);
  for (const int triangles : {480, 1920}) {
    const auto fine = fit(trunk, triangles - 1);  // "at least": the next size that is there
    ASSERT_EQ(static_cast<int>(fine.triangles.size()), triangles);
    const int steps = triangles == 480 ? 2 : 4;  // an edge of the template becomes so many
    const std::vector<char> rim = on_rim(fine);
    EXPECT_EQ(std::count(rim.begin(), rim.end(), 1), 32 * steps);
    int on_breastbone = 0;
    for (std::size_t v = 0; v < fine.outer.size(); ++v) {
      if (rim[v]) {
        EXPECT_TRUE(fine.outer_fixed[v]);
      } else if (std::abs(fine.outer[v].y()) < 1e-9) {
        EXPECT_FALSE(fine.outer_fixed[v]);
        EXPECT_TRUE(fine.inner_fixed[v]);
        ++on_breastbone;
      }
    }
    EXPECT_EQ(on_breastbone, 6 * steps - 1);
    EXPECT_EQ(fine.regions[0].triangles.size(), fine.triangles.size());
    EXPECT_EQ(fine.lines[0].nodes.size(), (coarse.lines[0].nodes.size() - 1) * steps + 1);
    for (std::size_t i = 0; i < coarse.lines[0].nodes.size(); ++i)
      EXPECT_EQ(fine.lines[0].nodes[i * steps], coarse.lines[0].nodes[i]);
    for (std::size_t v = 0; v < coarse.names.size(); ++v) EXPECT_EQ(fine.names[v], coarse.names[v]);
    const Vector3d apex = geometry::region_apex(coarse, coarse.regions[0]);
    EXPECT_NEAR(geometry::cone_volume(fine.outer, fine.triangles, apex) /
                    geometry::cone_volume(coarse.outer, coarse.triangles, apex),
                1, 0.02);
  }
}

TEST(FitTemplate, CoarseAndFineOfOneBodyAreWhatEachIsAlone) {
  const Trunk trunk = make_trunk();
  const control_mesh::Template bust = control_mesh::load_template(kBust);
  const std::vector<control_mesh::Options> both{{480, 1.2}, {120, 1}};
  const control_mesh::BodySkin skin(trunk.mesh, trunk.measures, nullptr);
  const auto laid = control_mesh::fit_template_for_each(bust, skin, both),
             again = control_mesh::fit_template_for_each(bust, skin, both);  // a skin is for many templates
  ASSERT_EQ(laid.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto alone = control_mesh::fit_template(bust, trunk.mesh, trunk.measures, both[i]);
    EXPECT_EQ(laid[i].outer, alone.outer);  // to the bit
    EXPECT_EQ(laid[i].inner, alone.inner);
    EXPECT_EQ(laid[i].triangles, alone.triangles);
    EXPECT_EQ(laid[i].outer, again[i].outer);
  }
}

TEST(FitTemplate, ArmsThatTouchTheTrunkAreNotClimbed) {
  Trunk trunk = make_trunk();
  const double side = trunk.measures.landmark("axilla_L").y();
  // Both flanks run out into something 0.15 m wide, as where an arm has grown to the trunk.
  for (Vector3d& p : trunk.mesh.vertices) {
    if (std::abs(p.y()) < 0.1) continue;
    const double fore = (p.x() - 0.01) / 0.02, rise = (p.z() - kBustLevel) / 0.02;
    p.y() += std::copysign(0.15 * std::exp(-0.5 * (fore * fore + rise * rise)), p.y());
  }
  const auto control = fit(trunk);
  for (const Vector3d& p : control.outer) EXPECT_LT(std::abs(p.y()), 1.35 * side);
}

TEST(FitTemplate, ChestLineVisitsItsStops) {
  const auto control = fit(make_trunk());
  ASSERT_EQ(control.lines.size(), 1u);
  EXPECT_EQ(control.lines[0].name, "chest");
  auto at = control.lines[0].nodes.begin();
  for (const char* stop : {"axilla_L", "bust_point_L", "sternum", "bust_point_R", "axilla_R"}) {
    at = std::find(at, control.lines[0].nodes.end(), control.node(stop));
    EXPECT_NE(at, control.lines[0].nodes.end()) << stop;
  }
  EXPECT_EQ(control.lines[0].nodes.size(), 11u);  // straight along the row: no zigzag
}

TEST(FitTemplate, ScanMayStandInAnyFrame) {
  const Trunk trunk = make_trunk();
  Eigen::Isometry3d scan_from_body = Eigen::Isometry3d::Identity();
  scan_from_body.rotate(Eigen::AngleAxisd(2.1, Vector3d(0.1, -0.2, 0.97).normalized()));
  scan_from_body.pretranslate(Vector3d(3, -2, 0.5));
  Trunk moved = trunk;
  moved.measures.body_from_scan = scan_from_body.inverse();
  for (Vector3d& p : moved.mesh.vertices) p = scan_from_body * p;
  for (geometry::Landmark& landmark : moved.measures.landmarks)
    landmark.position = scan_from_body * landmark.position;
  const auto here = fit(trunk), there = fit(moved);
  for (std::size_t v = 0; v < here.outer.size();
       ++v) {  // 1e-9: rounding of coordinates of a few metres, amplified by projections
    EXPECT_LE((scan_from_body * here.outer[v] - there.outer[v]).norm(), 1e-9);
    EXPECT_LE((scan_from_body * here.inner[v] - there.inner[v]).norm(), 1e-9);
  }
}

TEST(FitTemplate, MissingLandmarkIsNamed) {
  for (const std::string gone : {"underbust_L", "axilla_R", "neck_front", "bust_point_R"}) {
    Trunk trunk = make_trunk();
    auto& landmarks = trunk.measures.landmarks;
    landmarks.erase(
        std::find_if(landmarks.begin(), landmarks.end(), [&gone](const auto& l) { return l.name == gone; }));
    try {
      fit(trunk);
      ADD_FAILURE() << "accepted without " << gone;
    } catch (const geometry::Refusal& refusal) {
      EXPECT_EQ(refusal.code(), "missing_part:" + gone);
    }
  }
}

TEST(FitTemplate, ThicknessIsScaled) {
  const Trunk trunk = make_trunk();
  const auto mean_thickness = [&trunk](double thickness) {
    control_mesh::Options options;
    options.thickness = thickness;
    const auto control =
        control_mesh::fit_template(control_mesh::load_template(kBust), trunk.mesh, trunk.measures, options);
    double sum = 0;
    for (std::size_t v = 0; v < control.outer.size(); ++v)
      sum += (control.outer[v] - control.inner[v]).norm() / static_cast<double>(control.outer.size());
    return sum;
  };
  // Not exactly half: outer nodes are lifted by up to 3 mm, and thick units are kept from folding.
  EXPECT_NEAR(mean_thickness(0.5) / mean_thickness(1), 0.5, 0.05);
}

TEST(FitTemplate, RefusesBadInput) {
  const Trunk trunk = make_trunk();
  const auto code_of = [&trunk](const geometry::TriangleMesh& mesh, int triangles) -> std::string {
    try {
      control_mesh::fit_template(control_mesh::load_template(kBust), mesh, trunk.measures, finer(triangles));
    } catch (const geometry::Refusal& refusal) {
      return refusal.code();
    }
    return "accepted";
  };
  EXPECT_EQ(code_of(trunk.mesh, 0), "bad_option");
  EXPECT_EQ(code_of(trunk.mesh, 1 << 30), "bad_option");
  EXPECT_EQ(code_of({}, 120), "not_a_body");
  control_mesh::Options options;
  options.thickness = 0;
  EXPECT_THROW(
      control_mesh::fit_template(control_mesh::load_template(kBust), trunk.mesh, trunk.measures, options),
      geometry::Refusal);
  geometry::TriangleMesh elsewhere = trunk.mesh;
  for (Vector3d& p : elsewhere.vertices) p.z() += 5;
  EXPECT_EQ(code_of(elsewhere, 120), "not_a_body");
}

}  // namespace
}  // namespace tensegric_fit
