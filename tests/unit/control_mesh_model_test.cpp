// Nodes on the body model's skin: where they lie, on either side, and what is refused.
#include <gtest/gtest.h>

#include <fstream>

#include "body_model/registration.hpp"
#include "control_mesh/fit_template.hpp"
#include "control_mesh/placing.hpp"
#include "control_mesh_templates.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit {
namespace {

using Eigen::Vector3d;

/// Two rows of three nodes over the left bust point and the middle.
control_mesh::Template small_template(const std::string& point,
                                      const std::string& below = "on_model: [[underbust_L, 1]]") {
  const std::string path = testing::TempDir() + "on_model.yaml";
  std::ofstream(path) << "name: small\naxis: [axilla_L, axilla_R]\nrows: 2\ncolumns: 3\nnodes:\n"
                         "  - {row: 0, column: 0, name: tip_L, on_model: [["
                      << point
                      << ", 1]]}\n"
                         "  - {row: 0, column: 1, on_model: [[bust_point_L, 0.5], [neck_front, 0.5]]}\n"
                         "  - {row: 1, column: 0, name: below_L, "
                      << below
                      << "}\n"
                         "  - {row: 1, column: 1, name: middle, on_model: [[navel, 0.7], [crotch, 0.3]]}\n"
                         "diagonals: ['\\']\nfixed: ['..', '..']\ninner_fixed: false\n"
                         "thickness: [[0.01, 0.01], [0.01, 0.01]]\n"
                         "regions: [{name: small, rows: [0, 1], columns: [0, 2]}]\n"
                         "lines: [{name: down, through: [tip_L, below_L]}]\n";
  return control_mesh::load_template(path);
}

/// The mean woman in a pose, and her own skin as the mesh.
struct Posed {
  explicit Posed(double yaw) {
    body.model = body_model::shipped_registrar().shared_model();
    body.parameters = body_model::Parameters(*body.model);
    body.parameters.rotation = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
    const body_model::PosedModel posed(*body.model, body.parameters);
    body.posed = body.skin = posed.vertices();
    for (std::size_t bone = 0; bone < body.model->bones.size(); ++bone)
      body.joints.push_back(posed.joint(static_cast<int>(bone)));
    body.off.assign(body.skin.size(), 0);
    body.support = body.off;  // all of her is there
    mesh = {body.skin, body.model->triangles};
    Eigen::Matrix3d axes;  // the model faces -y, the body frame's x
    axes << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    measures.body_from_scan = Eigen::Isometry3d(axes * body.parameters.rotation.transpose());
    for (const char side : {'L', 'R'})
      measures.landmarks.push_back(
          {std::string("axilla_") + side,
           body.skin_point(std::string("bust_point_") + side) + 0.15 * body.parameters.rotation.col(1), 1, "",
           0});
  }

  geometry::TriangleMesh in_body_frame(geometry::TriangleMesh moved) const {
    for (Vector3d& p : moved.vertices) p = measures.body_from_scan * p;
    return moved;
  }

  body_model::RegisteredBody body;
  geometry::TriangleMesh mesh;
  geometry::BodyMeasures measures;
};

std::string why_refused(const control_mesh::Template& pattern, const Posed& posed, bool with_model) {
  try {
    control_mesh::fit_template(pattern, posed.mesh, posed.measures, {}, with_model ? &posed.body : nullptr);
  } catch (const geometry::Refusal& refusal) {
    return refusal.code() + ": " + refusal.what();
  }
  return "";
}

TEST(NodesOnTheModel, LieOnTheSkinAtTheirPlaceOnBothSides) {
  const Posed posed(0.8);
  control_mesh::Options coarse;
  coarse.control_triangles = 4;
  const auto control = control_mesh::fit_template(small_template("bust_point_L"), posed.mesh, posed.measures,
                                                  coarse, &posed.body);
  const double tessellation =
      0.001;  // m; a mean of vertices lies that far inside the skin where it is curved
  for (const char* side : {"L", "R"}) {
    const auto at = [&](const std::string& name) { return control.outer[control.node(name + side)]; };
    EXPECT_LT((at("tip_") - posed.body.skin_point(std::string("bust_point_") + side)).norm(),
              3 * tessellation);
    EXPECT_LT((at("below_") - posed.body.skin_point(std::string("underbust_") + side)).norm(),
              3 * tessellation);
  }
  for (std::size_t v = 0; v < control.outer.size(); ++v)
    EXPECT_NEAR((control.outer[v] - control.inner[v]).norm(), 0.01, 0.003 + 1e-9)
        << v;  // outer ones are lifted
  // The mean woman is her own mirror image, whatever way she faces.
  const Vector3d left = posed.body.left();
  const auto across = [&](const std::string& name) {
    return left.dot(control.outer[control.node(name + "_L")] + control.outer[control.node(name + "_R")]);
  };
  EXPECT_NEAR(across("tip"), 0, tessellation);
  EXPECT_NEAR(across("below"), 0, tessellation);
  EXPECT_NEAR(left.dot(control.outer[control.node("middle")]), 0,
              3 * tessellation);  // places of asymmetric women
}

TEST(NodesOnTheModel, VerticesAreThoseOfTheModelAndMirrored) {
  const Posed posed(0);
  const int tip = posed.body.model->skin_points.front().vertices.front().first;
  control_mesh::Options coarse;
  coarse.control_triangles = 4;
  const auto control = control_mesh::fit_template(small_template(std::to_string(tip)), posed.mesh,
                                                  posed.measures, coarse, &posed.body);
  EXPECT_LT((control.outer[control.node("tip_L")] - posed.body.skin[tip]).norm(), 1e-6);
  EXPECT_LT(
      (control.outer[control.node("tip_R")] - posed.body.skin[tip].cwiseProduct(Vector3d(-1, 1, 1))).norm(),
      1e-4);  // m; components are kept as bytes
}

TEST(NodesOnTheModel, OneSkinLaysEachTemplateAsItWouldBeAlone) {
  const Posed posed(0.8);
  const int tip = posed.body.model->skin_points.front().vertices.front().first;
  control_mesh::Options coarse;
  coarse.control_triangles = 4;
  const control_mesh::BodySkin skin(posed.mesh, posed.measures, &posed.body);
  for (const std::string& point : {std::string("bust_point_L"), std::to_string(tip)}) {
    const auto pattern = small_template(point);
    const auto laid = control_mesh::fit_template_for_each(pattern, skin, {coarse}).front();
    const auto alone = control_mesh::fit_template(pattern, posed.mesh, posed.measures, coarse, &posed.body);
    EXPECT_EQ(laid.outer, alone.outer) << point;  // to the bit
    EXPECT_EQ(laid.inner, alone.inner) << point;
  }
}

TEST(NodesOnTheModel, StandInForLandmarksThatAreMissing) {
  Posed posed(0);
  const auto pattern =
      small_template("bust_point_L", "landmark: underbust_L, or_on_model: [[underbust_L, 1]]");
  control_mesh::Options coarse;
  coarse.control_triangles = 4;
  const auto below = [&] {
    const auto control = control_mesh::fit_template(pattern, posed.mesh, posed.measures, coarse, &posed.body);
    return Vector3d(control.outer[control.node("below_L")]);
  };
  EXPECT_LT((below() - posed.body.skin_point("underbust_L")).norm(), 0.003);
  const Vector3d left = posed.body.skin_point("underbust_L") + Vector3d(0.02, 0, 0);
  const Vector3d right = posed.body.skin_point("underbust_R") - Vector3d(0.02, 0, 0);
  posed.measures.landmarks.push_back({"underbust_L", left, 1, "", 0});
  posed.measures.landmarks.push_back({"underbust_R", right, 1, "", 0});
  EXPECT_GT((below() - posed.body.skin_point("underbust_L")).norm(), 0.01) << "the landmark comes first";
}

// Of skin that is farther off than the nearest: a fold's other side, an edge of a strap.
TEST(NodesOnTheModel, GoAlongTheModelsNormalNotToTheNearestSkin) {
  const Posed posed(0);
  constexpr double kOff = 0.010, kAside = 0.003;  // m
  geometry::TriangleMesh mesh = posed.mesh;
  const std::vector<Vector3d> normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
  for (std::size_t v = 0; v < normals.size(); ++v) mesh.vertices[v] += kOff * normals[v];
  const int tip = posed.body.model->skin_points.front().vertices.front().first;
  const Vector3d there = posed.body.skin[tip], outward = normals[tip],
                 aside = outward.cross(Vector3d::UnitZ()).normalized(), along = outward.cross(aside);
  const int first = static_cast<int>(mesh.vertices.size());
  for (const double up : {-0.008, 0.008})
    for (const double far : {-0.008, 0.008})
      mesh.vertices.push_back(there + kAside * aside + far * outward + up * along);
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  mesh.triangles.emplace_back(first + 1, first + 3, first + 2);
  const Eigen::Isometry3d& frame = posed.measures.body_from_scan;
  const control_mesh::Skin skin(posed.in_body_frame(mesh));
  ASSERT_LT((skin.nearest(frame * there) - frame * there).norm(), kAside + 1e-9);
  const control_mesh::ModelSurface surface(posed.body, frame);
  const auto pattern = small_template(std::to_string(tip));
  const auto nodes =
      control_mesh::place_nodes(pattern, posed.measures, skin, control_mesh::Layout::as_drawn, &surface);
  const Vector3d node = nodes[control_mesh::node_at(pattern, 0, 0, control_mesh::Side::left)];
  EXPECT_LT((node - frame * (there + kOff * outward)).norm(), 0.001);
}

TEST(NodesOnTheModel, WhereTheFramesOriginLiesDoesNotMatter) {
  Posed posed(0.4);
  control_mesh::Options coarse;
  coarse.control_triangles = 4;
  const auto pattern = small_template("bust_point_L");
  const auto fit = [&] {
    return control_mesh::fit_template(pattern, posed.mesh, posed.measures, coarse, &posed.body);
  };
  const auto here = fit();
  for (const Vector3d& off : {Vector3d(1, 0, 0), Vector3d(-2, 3, 0)}) {
    Posed other = posed;
    posed.measures.body_from_scan.pretranslate(off);
    const auto there = fit();
    posed = other;
    EXPECT_EQ(there.triangles, here.triangles);  // they face the same way, too
    for (std::size_t v = 0; v < here.outer.size(); ++v)
      EXPECT_LT((there.outer[v] - here.outer[v]).norm(), 1e-9);  // rounding
  }
}

// Arms are left out where they hang beside the trunk; what is above the armpits is the shoulder's skin.
TEST(NodesOnTheModel, ArmsAreThereAboveTheArmpitsOnly) {
  const Posed posed(0);
  const body_model::Model& model = *posed.body.model;
  const double armpits = posed.measures.landmark("axilla_L").z();
  int above = -1, below = -1;  // vertices of the arm, the highest, and the highest below the armpits
  for (int v = 0; v < static_cast<int>(model.part.size()); ++v) {
    if (model.parts[model.part[v]].rfind("upper_arm", 0) != 0 || posed.body.skin[v].x() < 0) continue;
    const double z = posed.body.skin[v].z();
    if (above < 0 || z > posed.body.skin[above].z()) above = v;
    if (z < armpits - 0.03 && (below < 0 || z > posed.body.skin[below].z())) below = v;
  }
  ASSERT_GE(below, 0);
  ASSERT_GT(posed.body.skin[above].z(), armpits + 0.03);
  control_mesh::Options coarse;
  coarse.control_triangles = 4;
  const auto off_skin = [&](int vertex) {
    const auto control = control_mesh::fit_template(small_template(std::to_string(vertex)), posed.mesh,
                                                    posed.measures, coarse, &posed.body);
    return (control.outer[control.node("tip_L")] - posed.body.skin[vertex]).norm();
  };
  EXPECT_LT(off_skin(above), 0.001);
  EXPECT_GT(off_skin(below), 0.010);
}

// A level that is on a breast by the landmarks, whose own fold is lower: the node goes on down to the chest.
TEST(NodesOnTheModel, BelowAFoldTheyAreOffTheBreast) {
  Posed posed(0);
  for (const char side : {'L', 'R'})
    for (const auto& [name, higher] :
         {std::pair<std::string, double>("bust_point_", 0.02), {"underbust_", 0.06}})
      posed.measures.landmarks.push_back(
          {name + side, posed.body.skin_point(name + side) + Vector3d(0, 0, higher), 1, "", 0});
  posed.measures.landmarks.push_back({"neck_front", posed.body.skin_point("neck_front"), 1, "", 0});
  const auto pattern = control_mesh::load_template(kBust);
  const control_mesh::Skin skin(posed.in_body_frame(posed.mesh));
  const control_mesh::ModelSurface surface(posed.body, posed.measures.body_from_scan);
  const auto node = [&](control_mesh::Layout layout) {
    return control_mesh::place_nodes(
        pattern, posed.measures, skin, layout,
        &surface)[control_mesh::node_at(pattern, 5, 4, control_mesh::Side::left)];
  };
  const auto on_breast = [&](const Vector3d& p) { return surface.on_breast(p, skin.normal_near(p)); };
  const Vector3d drawn = node(control_mesh::Layout::as_drawn), over = node(control_mesh::Layout::over_folds);
  ASSERT_TRUE(on_breast(drawn));
  EXPECT_FALSE(on_breast(over));
  EXPECT_LT(over.z(), drawn.z());
}

TEST(NodesOnTheModel, NeedAModelThatHasThem) {
  const Posed posed(0);
  EXPECT_NE(why_refused(small_template("bust_point_L"), posed, false)
                .find("missing_part:body_model: the template small"),
            std::string::npos);
  EXPECT_NE(why_refused(small_template("65000"), posed, true)
                .find("bad_template: the template small, row 0, column 0: "
                      "the body model has no vertex 65000"),
            std::string::npos);
  EXPECT_NE(why_refused(small_template("elbow_L"), posed, true).find("no skin point 'elbow_L'"),
            std::string::npos);
  EXPECT_EQ(why_refused(small_template("bust_point_L"), posed, true), "");
}

TEST(NodesOnTheModel, SecondPlacesThatItDoesNotHaveAreRefusedThoughNoneIsNeeded) {
  Posed posed(0);
  for (const std::string name : {"underbust_L", "underbust_R"})
    posed.measures.landmarks.push_back({name, posed.body.skin_point(name), 1, "", 0});
  const auto refused = [&](const std::string& point) {
    return why_refused(
        small_template("bust_point_L", "landmark: underbust_L, or_on_model: [[" + point + ", 1]]"), posed,
        true);
  };
  EXPECT_EQ(refused("underbust_L"), "");
  EXPECT_NE(refused("65000").find("bad_template: the template small, row 1, column 0: "
                                  "the body model has no vertex 65000"),
            std::string::npos);
  EXPECT_NE(refused("underbst_L").find("no skin point 'underbst_L'"), std::string::npos);
}

}  // namespace
}  // namespace tensegric_fit
