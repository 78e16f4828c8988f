#include "tensegric/model.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/status.hpp"
#include "tensegric/prestress.hpp"

namespace tensegric_fit::tensegric {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

constexpr double kShortestMember = 1e-8;  // of the model's size; below it a direction is noise
constexpr double kHighestPull =
    0.8;  // tension / k at rest: a natural length stays above a fifth of the rest length

void check_option(double value, double low, double high, const char* name) {
  if (!(value >= low && value <= high))
    throw Refusal(refusal::kBadOption, std::string(name) + " is " + std::to_string(value) + ", outside [" +
                                           std::to_string(low) + ", " + std::to_string(high) + "]");
}

// Fewer than three fixed nodes, or all in one line, leave a piece free to move as a whole.
void check_held(const Model& model, const Positions& rest) {
  const geometry::ControlMesh& control = model.control;
  const int count = static_cast<int>(control.outer.size());
  std::vector<std::vector<Eigen::Vector3d>> held;  // of each piece
  std::vector<char> counted(count, 0);
  const std::vector<int> pieces = geometry::components_of({control.outer, control.triangles});
  for (std::size_t t = 0; t < pieces.size(); ++t) {
    held.resize(std::max<std::size_t>(held.size(), pieces[t] + 1));
    for (int k = 0; k < 3; ++k) {
      const int node = control.triangles[t][k];
      for (int layer : {node, node + count})
        if (!counted[node] && model.is_fixed(layer)) held[pieces[t]].push_back(rest[layer]);
      counted[node] = 1;
    }
  }
  for (const auto& points : held) {
    Eigen::Vector3d far = Eigen::Vector3d::Zero();  // from the first one to the farthest from it
    for (const Eigen::Vector3d& p : points)
      if ((p - points.front()).norm() > far.norm()) far = p - points.front();
    double largest = 0;
    for (const Eigen::Vector3d& p : points) largest = std::max(largest, far.cross(p - points.front()).norm());
    if (!(largest > 1e-6 * far.squaredNorm()))
      throw Refusal(refusal::kBadMesh,
                    "each piece of the control mesh needs three fixed nodes or more, not in one line");
  }
}

// Members at their rest lengths, and the number of units that share each.
std::vector<int> place_members(Model& model, const Positions& rest) {
  const int count = static_cast<int>(model.control.outer.size());
  const auto box = geometry::bounding_box(rest);
  const double shortest = kShortestMember * (box[1] - box[0]).norm();
  std::vector<int> units;
  const auto place = [&](int a, int b, bool strut, int sharing) {
    const double length = (rest[a] - rest[b]).norm();
    if (!(length > shortest && std::isfinite(length)))
      throw Refusal(refusal::kBadMesh,
                    "two nodes of the tensegric model that a part joins lie on one point, or as good as");
    model.members.push_back({a, b, strut, length, length});
    units.push_back(sharing);
  };
  for (const Eigen::Vector3i& t : model.control.triangles)
    for (int k = 0; k < 3; ++k) place(t[k], count + t[(k + 1) % 3], true, 1);
  const auto edges = geometry::edges_of({model.control.outer, model.control.triangles});
  for (int layer : {0, count})
    for (const geometry::Edge& e : edges)
      place(layer + e.first, layer + e.second, false, e.right < 0 ? 1 : 2);
  std::vector<int> valence(count, 0);
  for (const Eigen::Vector3i& t : model.control.triangles)
    for (int k = 0; k < 3; ++k) ++valence[t[k]];
  for (int i = 0; i < count; ++i) {
    if (valence[i] == 0)
      throw Refusal(refusal::kBadMesh, "a node of the control mesh belongs to no triangle");
    place(i, count + i, false, valence[i]);
  }
  return units;
}

}  // namespace

int Model::struts() const {
  return 3 * static_cast<int>(control.triangles.size());
}
int Model::tensile_parts() const {
  return static_cast<int>(members.size()) - struts();
}

bool Model::is_fixed(int node) const {
  const int count = static_cast<int>(control.outer.size());
  return node < count ? control.outer_fixed[node] != 0 : control.inner_fixed[node - count] != 0;
}

std::vector<int> Model::free_index() const {
  std::vector<int> index(2 * control.outer.size(), -1);
  int next = 0;
  for (std::size_t i = 0; i < index.size(); ++i)
    if (!is_fixed(static_cast<int>(i))) index[i] = next++;
  return index;
}

int Model::free_nodes() const {
  const std::vector<int> index = free_index();
  return static_cast<int>(std::count_if(index.begin(), index.end(), [](int i) { return i >= 0; }));
}

Positions Model::rest_positions() const {
  Positions rest = control.outer;
  rest.insert(rest.end(), control.inner.begin(), control.inner.end());
  return rest;
}

double Model::mean_tension() const {
  double sum = 0;
  for (const Member& m : members)
    if (!m.strut) sum += 1 - m.natural / m.rest;
  return sum / tensile_parts();
}

Model build_model(const geometry::ControlMesh& control, const ModelOptions& options) {
  geometry::check_control_mesh(control);
  check_option(options.strut_stiffness, kSoftestStrut, kStiffestStrut, "strut_stiffness");
  check_option(options.prestress, kLowestPrestress, kHighestPrestress, "prestress");
  Model model;
  model.control = control;
  model.options = options;
  const Positions rest = model.rest_positions();
  check_held(model, rest);
  const std::vector<int> units = place_members(model, rest);
  const Eigen::VectorXd density = force_densities(model, units);

  double mean = 0, highest = 0;
  for (std::size_t i = 0; i < model.members.size(); ++i) {
    if (model.members[i].strut) continue;
    const double tension = density[i] * model.members[i].rest;
    mean += tension / model.tensile_parts();
    highest = std::max(highest, tension);
  }
  if (!(mean > 0)) throw Refusal(refusal::kBadMesh, "the control mesh has no prestress at all");
  const double scale = std::min(options.prestress / mean, kHighestPull / highest);
  for (std::size_t i = 0; i < model.members.size(); ++i) {
    Member& m = model.members[i];
    const double force = scale * density[i] * m.rest;
    m.natural = m.rest * (1 - force / (m.strut ? options.strut_stiffness : 1));
  }
  return model;
}

}  // namespace tensegric_fit::tensegric
