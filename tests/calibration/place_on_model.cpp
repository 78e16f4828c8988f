/// Where the body model's skin has the nodes of a template that its levels and angles place: `or_on_model`.
/// place_on_model TEMPLATE BODY.ply... > NEW_TEMPLATE
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>

#include "control_mesh/fit_template.hpp"
#include "control_mesh/grid.hpp"
#include "fit/chain.hpp"
#include "geometry/percentile.hpp"
#include "geometry/ply.hpp"
#include "geometry/status.hpp"
#include "geometry/surface_tree.hpp"

namespace {

using namespace tensegric_fit;
using control_mesh::Side;
using Eigen::Vector3d;

constexpr char kKey[] = "or_on_model: ";

/// Places of a node on the mean woman at rest, on her left, from both sides of each body.
using Places = std::vector<Vector3d>;

/// The same point of the skin of the mean shape.
Vector3d at_rest(const body_model::Model& model, const geometry::SurfacePoint& foot) {
  Vector3d point = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) point += foot.barycentric[k] * model.mean[model.triangles[foot.triangle][k]];
  return point;
}

Vector3d median_of(const Places& places) {
  Vector3d median;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Vector3d& p : places) values.push_back(p[axis]);
    median[axis] = geometry::median(values);
  }
  return median;
}

/// Pairs of a vertex and its share, as templates have them.
std::string text_of(const body_model::Model& model, const geometry::SurfacePoint& foot) {
  const Eigen::Vector3i& corners = model.triangles[foot.triangle];
  std::vector<std::string> pairs;
  int left = 100;  // hundredths
  for (int k = 0; k < 3; ++k) {
    const int share =
        k == 2 ? left : std::clamp(static_cast<int>(std::lround(100 * foot.barycentric[k])), 0, left);
    left -= share;
    if (share > 0) pairs.push_back(fmt::format("[{}, {:.2f}]", corners[k], share / 100.0));
  }
  return fmt::format("[{}]", fmt::join(pairs, ", "));
}

/// Adds where a body that the template fits as it is drawn has each node. False: it is laid otherwise there.
bool add_places(const control_mesh::Template& pattern, const std::string& path, std::vector<Places>& places,
                std::shared_ptr<const body_model::Model>& model) {
  fit::StageTimes times;
  const fit::Body body = fit::measure_mesh(geometry::read_ply_mesh(path), {}, times);
  control_mesh::Template as_drawn = pattern;
  for (control_mesh::TemplateNode& node : as_drawn.nodes) node.or_on_model.clear();
  const control_mesh::Options coarse{1, 1};
  const auto lay = [&](const control_mesh::Template& one) {
    return control_mesh::fit_template(one, body.mesh.mesh, body.measures, coarse, &*body.model).outer;
  };
  const std::vector<Vector3d> outer = lay(as_drawn);
  if (outer != lay(pattern)) return false;
  model = body.model->model;
  const geometry::TriangleMesh skin{body.model->skin, model->triangles};
  const geometry::SurfaceTree tree(skin);
  for (std::size_t n = 0; n < pattern.nodes.size(); ++n)
    for (const Side side : {Side::left, Side::right}) {
      const control_mesh::TemplateNode& node = pattern.nodes[n];
      Vector3d place =
          at_rest(*model, tree.nearest(outer[control_mesh::node_at(pattern, node.row, node.column, side)]));
      if (side == Side::right) place.x() = -place.x();
      places[n].push_back(place);
    }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "place_on_model TEMPLATE BODY.ply... > NEW_TEMPLATE\n";
    return 2;
  }
  try {
    const control_mesh::Template pattern = control_mesh::load_template(argv[1]);
    std::vector<Places> places(pattern.nodes.size());
    std::shared_ptr<const body_model::Model> model;
    int bodies = 0;
    for (int i = 2; i < argc; ++i) {
      try {
        bodies += add_places(pattern, argv[i], places, model);
      } catch (const geometry::Refusal& refusal) {
        std::cerr << argv[i] << ": " << refusal.what() << '\n';
      }
    }
    if (bodies == 0) throw std::runtime_error("none of the bodies can be laid as the template draws it");
    const geometry::TriangleMesh mean{model->mean, model->triangles};
    const geometry::SurfaceTree tree(mean);
    std::stringstream file;
    file << std::ifstream(argv[1]).rdbuf();
    std::string text = file.str();
    std::size_t at = text.find("nodes:");
    for (std::size_t n = 0; n < pattern.nodes.size(); ++n) {
      if (pattern.nodes[n].or_on_model.empty()) continue;
      at = text.find(kKey, at) + sizeof kKey - 1;
      const std::string place = text_of(*model, tree.nearest(median_of(places[n])));
      text.replace(at, text.find("]]", at) + 2 - at, place);
    }
    std::cout << text;
    std::cerr << bodies << " of " << argc - 2 << " bodies\n";
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "place_on_model: " << error.what() << '\n';
    return 1;
  }
}
