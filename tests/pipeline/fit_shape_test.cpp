// `fit` on shapes that are no bodies, bent by gravity (P1 §3.2, Fig. 3).
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "fit_program.hpp"
#include "geometry/ply.hpp"

namespace {

using Eigen::Vector3d;
using tensegric_fit::geometry::TriangleMesh;

constexpr double kHeld = -0.36;  // what virtual_booth says to hold lies behind it

class FitShape : public FitProgram {
 protected:
  TriangleMesh mesh(const std::string& name) const {
    return tensegric_fit::geometry::read_ply_mesh(file("out/" + name));
  }

  void make(const std::string& shape) const {
    ASSERT_EQ(run("virtual_booth --shape " + shape + " --out " + folder_.string()), 0) << log();
  }
  int bend(const std::string& more) const {
    return fit("--mesh " + file("shape.ply") + " --fixed " + file("fixed.yaml") + " " + more);
  }

  // What must hold of any shape under any load that it can bear.
  void expect_sound() const {
    const json r = report();
    EXPECT_EQ(r["solver"]["status"], "converged") << r["solver"]["note"];
    EXPECT_LE(r["solver"]["residual"], 1e-8);  // nodes/tensegric/README.md, Exactness
    for (const json& region : r["regions"]) {
      const json& volume = region["control_volume"];
      EXPECT_NEAR(volume[1].get<double>() / volume[0].get<double>(), 1,
                  1e-9);  // nodes/tensegric/README.md, Exactness
    }
    const TriangleMesh before = mesh("body.ply"), after = mesh("deformed.ply");
    ASSERT_EQ(before.triangles, after.triangles);
    EXPECT_EQ(turned_over(before, after), 0);
    const TriangleMesh control = mesh("control.ply"), bent = mesh("control_deformed.ply");
    EXPECT_EQ(turned_over(control, bent), 0);
    for (std::size_t v = 0; v < control.vertices.size(); ++v)
      if (control.vertices[v].x() <= kHeld) {
        EXPECT_EQ(control.vertices[v], bent.vertices[v]);
      }
  }

  // Triangles against the turn of their neighbourhood: a bent shape turns as a whole, so each edge is asked
  // whether its two triangles came to face each other.
  static int turned_over(const TriangleMesh& before, const TriangleMesh& after) {
    int count = 0;
    const auto facing = [](const TriangleMesh& m, const tensegric_fit::geometry::Edge& e) {
      const auto normal = [&m](int t) {
        const Eigen::Vector3i& k = m.triangles[t];
        return tensegric_fit::geometry::area_vector(m.vertices[k[0]], m.vertices[k[1]], m.vertices[k[2]])
            .normalized();
      };
      return normal(e.left).dot(normal(e.right));
    };
    for (const auto& edge : tensegric_fit::geometry::edges_of(before))
      if (edge.right >= 0 && facing(before, edge) > 0 && facing(after, edge) < -0.5) ++count;
    return count;
  }
};

double lowest_near(const TriangleMesh& mesh, const TriangleMesh& where, double from_x) {
  double lowest = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (where.vertices[v].x() > from_x)
      lowest = std::min(lowest, mesh.vertices[v].z() - where.vertices[v].z());
  return lowest;
}

TEST_F(FitShape, ADolphinHeldByItsTailHangsDown) {
  make("dolphin");
  ASSERT_EQ(bend("--gravity 0,0,-3"), 0) << log();
  expect_sound();
  EXPECT_NEAR(report()["control"]["triangles"].get<double>(), 400, 1);
  const TriangleMesh before = mesh("body.ply"), after = mesh("deformed.ply");
  EXPECT_LT(lowest_near(after, before, 0.45), -0.2);  // the snout, by a quarter of its length
  for (std::size_t v = 0; v < before.vertices.size(); ++v)
    if (before.vertices[v].x() < -0.50) {
      EXPECT_EQ(before.vertices[v], after.vertices[v]);  // the flukes' ends
    }
}

// The unit of force is what would move the shape by a tenth of its size: in any direction, and of any shape.
TEST_F(FitShape, ForceIsAShareOfWhatMovesTheShapeByATenth) {
  const std::map<std::string, std::vector<std::string>> forces = {
      {"dolphin", {"0,0,-0.05", "0,0.05,0", "0.03,0,-0.04"}}, {"torus", {"0.03,0,-0.04"}}};
  for (const auto& [shape, of_shape] : forces) {
    make(shape);
    for (const std::string& force : of_shape) {
      ASSERT_EQ(bend("--gravity " + force), 0) << log();
      expect_sound();
      const TriangleMesh before = mesh("control.ply"), after = mesh("control_deformed.ply");
      const auto box = tensegric_fit::geometry::bounding_box(before.vertices);
      double farthest = 0;
      for (std::size_t v = 0; v < before.vertices.size(); ++v)
        farthest = std::max(farthest, (after.vertices[v] - before.vertices[v]).norm());
      EXPECT_NEAR(farthest / (box[1] - box[0]).norm(), 0.005, 0.0005) << shape << " " << force;
    }
  }
}

// Strong loads come to rest, too, by way of buckling where the shape stands on what is held; and where the
// shape folds the report says so.
TEST_F(FitShape, StrongForcesBendItFar) {
  make("dolphin");
  for (const auto& [force, way] : {std::pair("0,0,-10", 0.5), {"0,0,-100", 0.8}, {"-1,0,0", 1.0}}) {
    ASSERT_EQ(bend(std::string("--gravity=") + force), 0) << log();
    const json solver = report()["solver"];
    EXPECT_NE(solver["status"], "capped") << solver["note"];
    EXPECT_LE(solver["residual"], 1e-8);
    if (solver["status"] == "infeasible") {
      EXPECT_NE(solver["note"].get<std::string>().find("turned over"), std::string::npos) << solver["note"];
    }
    const TriangleMesh before = mesh("body.ply"), after = mesh("deformed.ply");
    double farthest = 0;
    for (std::size_t v = 0; v < before.vertices.size(); ++v)
      farthest = std::max(farthest, (after.vertices[v] - before.vertices[v]).norm());
    EXPECT_GT(farthest, way) << force;
  }
}

TEST_F(FitShape, GravityThatPointsElsewhereBendsThere) {
  make("dolphin");
  ASSERT_EQ(bend("--gravity 0,0.5,0 --control-triangles 300"), 0) << log();
  expect_sound();
  const TriangleMesh before = mesh("body.ply"), after = mesh("deformed.ply");
  double farthest = 0;
  for (std::size_t v = 0; v < before.vertices.size(); ++v)
    farthest = std::max(farthest, after.vertices[v].y() - before.vertices[v].y());
  EXPECT_GT(farthest, 0.005);
}

TEST_F(FitShape, ATorusBendsAndKeepsItsHole) {
  make("torus");
  ASSERT_EQ(bend("--gravity 0,0,-0.5"), 0) << log();
  expect_sound();
  const TriangleMesh control = mesh("control.ply");
  EXPECT_TRUE(tensegric_fit::geometry::is_closed(control));
  EXPECT_EQ(2 * control.vertices.size(), control.triangles.size());  // V - E + F = 0
  EXPECT_LT(lowest_near(mesh("deformed.ply"), mesh("body.ply"), 0.4), -0.01);
}

// A torus that is its own mirror image at y = 0, triangles and all.
TriangleMesh mirrored_torus(int around, int across) {
  TriangleMesh torus;
  for (int i = 0; i < around; ++i)
    for (int k = 0; k < across; ++k) {
      const double u = 2 * M_PI * i / around, v = 2 * M_PI * k / across, ring = 0.35 + 0.11 * std::cos(v);
      torus.vertices.emplace_back(ring * std::cos(u), ring * std::sin(u), 0.11 * std::sin(v));
      const int right = (i + 1) % around, up = (k + 1) % across;
      const int a = across * i + k, b = across * right + k, c = across * right + up, d = across * i + up;
      if (2 * i < around) {
        torus.triangles.insert(torus.triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        torus.triangles.insert(torus.triangles.end(), {{a, b, d}, {b, c, d}});
      }
    }
  for (int i = around / 2 + 1; i < around; ++i)  // to the last bit
    for (int k = 0; k < across; ++k) {
      const Vector3d& twin = torus.vertices[across * (around - i) + k];
      torus.vertices[across * i + k] = {twin.x(), -twin.y(), twin.z()};
    }
  for (int i : {0, around / 2})
    for (int k = 0; k < across; ++k) torus.vertices[across * i + k].y() = 0;
  return torus;
}

TEST_F(FitShape, ASymmetricLoadOnASymmetricControlMeshBendsSymmetrically) {
  constexpr int kAround = 20, kAcross = 8;
  make("torus");
  tensegric_fit::geometry::write_ply_mesh(file("control.ply"), mirrored_torus(kAround, kAcross));
  ASSERT_EQ(bend("--control " + file("control.ply") + " --gravity 0,0,-0.5"), 0) << log();
  expect_sound();
  const TriangleMesh bent = mesh("control_deformed.ply");
  for (int i = 0; i < kAround; ++i)
    for (int k = 0; k < kAcross; ++k) {
      const Vector3d& p = bent.vertices[kAcross * i + k];
      const Vector3d& q = bent.vertices[kAcross * ((kAround - i) % kAround) + k];
      EXPECT_LT((p - Vector3d(q.x(), -q.y(), q.z())).norm(), 1e-9);  // nodes/tensegric/README.md, Exactness
    }
}

TEST_F(FitShape, AnOpenShapeBends) {
  make("torus");
  TriangleMesh whole = tensegric_fit::geometry::read_ply_mesh(file("shape.ply"));
  std::vector<char> keep;
  for (const Eigen::Vector3i& t : whole.triangles) keep.push_back(whole.vertices[t[0]].x() < 0.2);
  tensegric_fit::geometry::write_ply_mesh(file("shape.ply"), tensegric_fit::geometry::submesh(whole, keep));
  ASSERT_EQ(bend("--gravity 0,0,-0.5 --control-triangles 300"), 0) << log();
  EXPECT_FALSE(report()["body"]["closed"]);
  expect_sound();
  EXPECT_LT(lowest_near(mesh("deformed.ply"), mesh("body.ply"), 0.1), -0.001);
}

TEST_F(FitShape, PiecesBendEachForItself) {
  make("torus");
  TriangleMesh two = tensegric_fit::geometry::read_ply_mesh(file("shape.ply"));
  const int count = static_cast<int>(two.vertices.size()), triangles = static_cast<int>(two.triangles.size());
  for (int v = 0; v < count; ++v) two.vertices.push_back(two.vertices[v] + Vector3d(0, 0, 0.4));
  for (int t = 0; t < triangles; ++t)
    two.triangles.push_back(two.triangles[t] + Eigen::Vector3i::Constant(count));
  tensegric_fit::geometry::write_ply_mesh(file("shape.ply"), two);
  ASSERT_EQ(bend("--gravity 0,0,-0.5 --control-triangles 600"), 0) << log();
  ASSERT_EQ(report()["regions"].size(), 2u);
  expect_sound();
}

TEST_F(FitShape, RefusalsAndUsage) {
  make("torus");
  std::ofstream(file("fixed.yaml")) << "nodes: [0, 1, 2]\n";  // of which control mesh?
  EXPECT_EQ(bend("--gravity 0,0,-0.5"), 3);
  EXPECT_EQ(report()["reason"]["code"], "bad_template");
  std::ofstream(file("fixed.yaml")) << "boxes: [{min: [5, 5, 5], max: [6, 6, 6]}]\n";  // holds nothing
  EXPECT_EQ(bend("--gravity 0,0,-0.5"), 3);
  EXPECT_EQ(report()["reason"]["code"], "bad_template");
  EXPECT_EQ(bend("--garment B1"), 2);
  EXPECT_EQ(bend("--twist 10"), 2);
  EXPECT_EQ(run("fit --mesh " + file("shape.ply") + " --control " + file("shape.ply")), 2);
}

}  // namespace
