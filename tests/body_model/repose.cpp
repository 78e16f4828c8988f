// A mesh of a person with her arms elsewhere, or with fewer triangles: the registered model's own skinning
// moves it. For bodies of which only one surface is known.
#include <CLI/CLI.hpp>
#include <iostream>
#include <string>
#include <vector>

#include "body_model/registration.hpp"
#include "geometry/decimate.hpp"
#include "geometry/ply.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/status.hpp"

namespace {

using namespace tensegric_fit;
using body_model::Parameters;
using body_model::PosedModel;
using Eigen::Vector3d;

constexpr double kRestingArm = 45;  // degrees from hanging, of the model at rest
constexpr int kShared = 8;          // vertices of the model that carry a vertex of the mesh

/// Upper arms straight to the sides, by so many degrees from hanging.
Parameters with_arms(const body_model::RegisteredBody& body, double degrees) {
  Parameters p = body.parameters;
  const double raised = (degrees - kRestingArm) * M_PI / 180;
  p.turns[body.model->group_named("arm_L")] = {0, -raised, 0};
  p.turns[body.model->group_named("arm_R")] = {0, raised, 0};
  return p;
}

geometry::TriangleMesh reposed(geometry::TriangleMesh mesh, const body_model::RegisteredBody& body,
                               const Parameters& to) {
  const PosedModel before(*body.model, body.parameters), after(*body.model, to);
  const geometry::PointTree tree(body.skin);
  std::vector<int> near;
  for (Vector3d& vertex : mesh.vertices) {
    tree.nearest(vertex, kShared, near);
    Vector3d sum = Vector3d::Zero();
    double weight = 0;
    for (const int v : near) {
      const double w = 1 / ((vertex - body.skin[v]).squaredNorm() + 1e-6);
      sum += w * (after.vertex(v) + after.blend(v) * before.blend(v).inverse() * (vertex - before.vertex(v)));
      weight += w;
    }
    vertex = sum / weight;
  }
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  std::string in, out;
  double arms = -1;
  int triangles = 0;
  CLI::App app("A person's mesh, reposed by the body model or simplified");
  app.add_option("mesh", in, "PLY")->required()->check(CLI::ExistingFile);
  app.add_option("--out", out, "PLY")->required();
  app.add_option("--arms", arms, "degrees from hanging, of both upper arms")->check(CLI::Range(0, 120));
  app.add_option("--triangles", triangles, "as many")->check(CLI::Range(1000, 1000000));
  CLI11_PARSE(app, argc, argv);
  try {
    geometry::TriangleMesh mesh = geometry::read_ply_mesh(in);
    if (arms >= 0) {
      const body_model::RegisteredBody body = register_mesh(body_model::shipped_registrar(), mesh);
      mesh = reposed(std::move(mesh), body, with_arms(body, arms));
    }
    if (triangles > 0) mesh = geometry::with_triangles(mesh, triangles);
    geometry::write_ply_mesh(out, mesh);
  } catch (const geometry::Refusal& refusal) {
    std::cerr << refusal.code() << ": " << refusal.what() << "\n";
    return 1;
  }
}
