// The bust template on bodies with their true landmarks.
#include <gtest/gtest.h>

#include <cmath>

#include "control_mesh/fit_template.hpp"
#include "geometry/surface_tree.hpp"
#include "known_bodies.hpp"

namespace tensegric_fit {
namespace {

using Eigen::Vector3d;

const std::string kRoot = TENSEGRIC_FIT_SOURCE_DIR;

class OnBody : public testing::TestWithParam<test::KnownBody> {};
INSTANTIATE_TEST_SUITE_P(Bodies, OnBody, testing::ValuesIn(test::known_bodies()), test::name_of);

TEST_P(OnBody, ControlMeshIsAsACarefulEngineerWouldDrawIt) {
  const population::Subject subject = GetParam().surface();
  const geometry::TriangleMesh& body = subject.surface;
  geometry::BodyMeasures measures = subject.truth.measures;
  if (GetParam().name[0] == 'F')  // facing -y with z up: a quarter turn takes them to the body frame
    measures.body_from_scan.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const auto pattern = control_mesh::load_template(kRoot + "/launch/templates/bust.yaml");
  const auto control = control_mesh::fit_template(pattern, body, measures, {});

  // Nodes lie on the mesh, true points up to 0.8 mm off it.
  const geometry::SurfaceTree skin(body);
  const auto miss = [&](const std::string& name) {
    const Vector3d& truth = measures.landmark(name);
    return (control.outer[control.node(name)] - truth).norm() - (skin.nearest(truth).position - truth).norm();
  };
  for (const char* name : {"bust_point_L", "bust_point_R"}) EXPECT_LE(miss(name), 1e-4) << name;
  for (const char* name : {"underbust_L", "underbust_R"}) EXPECT_LE(miss(name), 5e-4) << name;

  double smallest = 1e9, largest = 0, sharpest = 180;
  for (const auto& t : control.triangles) {
    const Vector3d &a = control.outer[t[0]], &b = control.outer[t[1]], &c = control.outer[t[2]];
    const Vector3d area = geometry::area_vector(a, b, c);
    smallest = std::min(smallest, area.norm());
    largest = std::max(largest, area.norm());
    for (int k = 0; k < 3; ++k) {
      const Vector3d u = control.outer[t[(k + 1) % 3]] - control.outer[t[k]];
      const Vector3d v = control.outer[t[(k + 2) % 3]] - control.outer[t[k]];
      sharpest = std::min(sharpest, std::atan2(u.cross(v).norm(), u.dot(v)) * 180 / M_PI);
    }
    EXPECT_GT(area.dot(geometry::area_vector(control.inner[t[0]], control.inner[t[1]], control.inner[t[2]])),
              0)
        << "an inner triangle is turned over";
  }
  EXPECT_GT(sharpest, 12);  // degrees
  EXPECT_LT(largest / smallest,
            18);  // measured 6 to 15: armpits and folds need small triangles, sternums large ones
  for (const geometry::Edge& edge : geometry::edges_of({control.outer, control.triangles})) {
    if (edge.right < 0) continue;
    const auto normal = [&control](int triangle) {
      const auto& t = control.triangles[triangle];
      return geometry::area_vector(control.outer[t[0]], control.outer[t[1]], control.outer[t[2]])
          .normalized();
    };
    EXPECT_GT(normal(edge.left).dot(normal(edge.right)),
              -0.5);  // F2's own fold is 116 degrees sharp; folded over is 180
  }

  control_mesh::Options options;
  options.control_triangles = 1920;  // stands for the skin: 10 mm wide triangles
  const auto fine = control_mesh::fit_template(pattern, body, measures, options);
  const Vector3d apex = geometry::region_apex(control, control.regions[0]);
  EXPECT_NEAR(geometry::cone_volume(control.outer, control.triangles, apex) /
                  geometry::cone_volume(fine.outer, fine.triangles, apex),
              1, 0.02);
}

}  // namespace
}  // namespace tensegric_fit
