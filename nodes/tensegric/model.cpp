#include "tensegric/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <locale>
#include <map>
#include <sstream>
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

double area_of(const Positions& x, const std::array<int, 6>& unit, int first) {
  return geometry::area_vector(x[unit[first]], x[unit[first + 1]], x[unit[first + 2]]).norm() / 2;
}

// The tissue of a unit, m^3: mean area of its triangles times its mean depth, which no fold makes negative.
double tissue_of(const Positions& x, const std::array<int, 6>& unit) {
  double depth = 0;
  for (int k = 0; k < 3; ++k) depth += (x[unit[k]] - x[unit[k + 3]]).norm() / 3;
  return depth * (area_of(x, unit, 0) + area_of(x, unit, 3)) / 2;
}

// Per triangle of the control mesh.
std::vector<double> times_of(const geometry::ControlMesh& control, const ModelOptions& options) {
  std::vector<double> times(control.triangles.size(), 1);
  if (options.uniform && !options.stiff_parts.empty())
    throw Refusal(refusal::kBadOption,
                  "stiff_parts: where uniform_stiffness is true all parts of a kind are alike");
  for (const StiffPart& part : options.stiff_parts) {
    geometry::check_option("radius of stiff_parts", part.radius, kStiffRadius);
    geometry::check_option("times of stiff_parts", part.times, kStiffTimes);
    const int node = control.node(part.around);
    if (node < 0)
      throw Refusal(refusal::kBadOption, "stiff_parts: the control mesh has no node '" + part.around + "'");
    for (std::size_t t = 0; t < times.size(); ++t) {
      const Eigen::Vector3i& corners = control.triangles[t];
      const Eigen::Vector3d middle =
          (control.outer[corners[0]] + control.outer[corners[1]] + control.outer[corners[2]]) / 3;
      if ((middle - control.outer[node]).norm() < part.radius) times[t] *= part.times;
    }
  }
  return times;
}

// Adds members at their rest lengths, each as stiff as the tissue that it stands for: a third of each unit
// that it belongs to.
class MemberPlacer {
 public:
  MemberPlacer(Model& model, const Positions& rest) : model_(model), rest_(rest) {
    const auto box = geometry::bounding_box(rest);
    shortest_ = kShortestMember * (box[1] - box[0]).norm();
    std::size_t index = 0;
    for (const std::array<int, 6>& unit : model.units()) {
      const double tissue = model.times[index++ % model.times.size()] * tissue_of(rest, unit);
      for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        for (Share* share :
             {&faces_[std::minmax(unit[k], unit[next])], &edges_[std::minmax(unit[k], unit[next])],
              &edges_[std::minmax(unit[k + 3], unit[next + 3])], &laterals_[{unit[k], unit[k + 3]}]})
          *share += {1, tissue / 3};
      }
    }
  }

  // Densities of the ideal prism's parts, summed over the units that share them.
  std::vector<double> place_all() {
    const ModelOptions& options = model_.options;
    const int count = static_cast<int>(model_.control.outer.size());
    for (const std::array<int, 6>& unit : model_.units())
      for (int k = 0; k < 3; ++k) {
        const Share& face = faces_[std::minmax(unit[k], unit[(k + 1) % 3])];
        place(unit[k], unit[(k + 1) % 3 + 3], true, options.strut_stiffness, face.tissue, 1);
      }
    for (int level = 0; level <= options.layers; ++level)
      for (auto edge = edges_.lower_bound({model_.first_node(level), 0});
           edge != edges_.end() && edge->first.first < model_.first_node(level) + count; ++edge) {
        const auto& [ends, share] = *edge;
        place(ends.first, ends.second, false, 1, share.tissue, share.units / std::sqrt(3.0));
      }
    for (int level = 0; level < options.layers; ++level)
      for (int i = 0; i < count; ++i) {
        const int below = model_.first_node(level + 1) + i;
        const Share& share = laterals_[{model_.first_node(level) + i, below}];
        if (share.units == 0)
          throw Refusal(refusal::kBadMesh, "a node of the control mesh belongs to no triangle");
        place(model_.first_node(level) + i, below, false, options.lateral_stiffness, share.tissue,
              share.units);
      }
    double mean = 0;
    for (const Member& m : model_.members)
      if (!m.strut) mean += m.stiffness / model_.tensile_parts();
    for (Member& m : model_.members) m.stiffness /= mean;
    model_.tissue = 1 / mean;
    return densities_;
  }

 private:
  struct Share {
    int units = 0;
    double tissue = 0;  // m^3
    Share& operator+=(const Share& other) {
      units += other.units;
      tissue += other.tissue;
      return *this;
    }
  };
  using Shares = std::map<std::pair<int, int>, Share>;

  // `kind`: share of the stiffness of the tissue (m^3) that it stands for.
  void place(int a, int b, bool strut, double kind, double tissue, double density) {
    const double length = (rest_[a] - rest_[b]).norm();
    if (!(length > shortest_ && std::isfinite(length)))
      throw Refusal(refusal::kBadMesh,
                    "two nodes of the tensegric model that a part joins lie on one point, or nearly");
    const double stiffness = model_.options.uniform ? kind : kind * tissue / length;
    model_.members.push_back({a, b, strut, stiffness, length, length, model_.options.stiffening});
    densities_.push_back(density);
  }

  Model& model_;
  const Positions& rest_;
  double shortest_;
  Shares faces_, edges_, laterals_;  // faces by their upper edge
  std::vector<double> densities_;
};

}  // namespace

std::string to_string(InnerNodes inner) {
  return kInnerWords.of(inner);
}

StiffPart stiff_part_from(const std::string& text) {
  std::istringstream words(text);
  words.imbue(std::locale::classic());
  StiffPart part;
  std::string rest;
  if (!(words >> part.around >> part.radius >> part.times) || words >> rest)
    throw Refusal(refusal::kBadOption, "stiff_parts: '" + text + "' is not 'NODE RADIUS TIMES'");
  return part;
}

std::string to_string(const StiffPart& part) {
  return fmt::format("{} {:.4g} {:.4g}", part.around, part.radius, part.times);
}

ModelOptions papers_model() {
  ModelOptions options;
  options.inner = InnerNodes::free;
  options.uniform = true;
  options.strut_stiffness = 0.3;
  options.lateral_stiffness = 1;
  options.skin = 0;
  options.volume_stiffness = 0;
  options.shear_stiffness = 0;
  options.stiffening = 0;
  options.prestress = 0.05;
  return options;
}

InnerNodes inner_nodes_from(const std::string& word) {
  if (const auto inner = kInnerWords.find(word)) return *inner;
  throw Refusal(refusal::kBadOption, "inner nodes are '" + word + "', neither free nor bound");
}

int Model::struts() const {
  return 3 * options.layers * static_cast<int>(control.triangles.size());
}
int Model::tensile_parts() const {
  return static_cast<int>(members.size()) - struts();
}

int Model::nodes() const {
  return (options.layers + 1) * static_cast<int>(control.outer.size());
}

int Model::first_node(int level) const {
  const int count = static_cast<int>(control.outer.size());
  return level == 0 ? 0 : level == options.layers ? count : (level + 1) * count;
}

std::vector<std::array<int, 6>> Model::units() const {
  std::vector<std::array<int, 6>> units;
  for (int layer = 0; layer < options.layers; ++layer) {
    const int upper = first_node(layer), lower = first_node(layer + 1);
    for (const Eigen::Vector3i& t : control.triangles)
      units.push_back({t[0] + upper, t[1] + upper, t[2] + upper, t[0] + lower, t[1] + lower, t[2] + lower});
  }
  return units;
}

// Between two that are fixed a node is fixed.
bool Model::is_fixed(int node) const {
  const int count = static_cast<int>(control.outer.size());
  const bool outer = control.outer_fixed[node % count] != 0, inner = control.inner_fixed[node % count] != 0;
  return node < count ? outer : node < 2 * count ? inner : outer && inner;
}

std::vector<int> Model::free_index() const {
  std::vector<int> index(nodes(), -1);
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
  for (int level = 1; level < options.layers; ++level)
    for (std::size_t i = 0; i < control.outer.size(); ++i)
      rest.push_back(control.outer[i] + level * (control.inner[i] - control.outer[i]) / options.layers);
  return rest;
}

std::vector<int> Model::piece_of_nodes() const {
  const std::vector<int> of_triangle = geometry::components_of({control.outer, control.triangles});
  std::vector<int> pieces(control.outer.size(), 0);
  for (std::size_t t = 0; t < of_triangle.size(); ++t)
    for (int k = 0; k < 3; ++k) pieces[control.triangles[t][k]] = of_triangle[t];
  return pieces;
}

std::vector<int> Model::piece_of_members() const {
  const std::vector<int> of_node = piece_of_nodes();
  std::vector<int> pieces;
  for (const Member& m : members) pieces.push_back(of_node[static_cast<std::size_t>(m.a) % of_node.size()]);
  return pieces;
}

double Model::mean_tension() const {
  double sum = 0;
  for (const Member& m : members)
    if (!m.strut) sum += m.stiffness * (1 - m.natural / m.rest);
  return sum / tensile_parts();
}

Model build_model(const geometry::ControlMesh& control, const ModelOptions& options) {
  geometry::check_control_mesh(control);
  for (const ModelNumber& number : kModelNumbers)
    geometry::check_option(number.name, options.*number.field, number.range);
  geometry::check_option("layers", options.layers, kLayers);
  Model model;
  model.control = control;
  model.options = options;
  model.times = times_of(control, options);
  if (options.inner == InnerNodes::bound)
    std::fill(model.control.inner_fixed.begin(), model.control.inner_fixed.end(), 1);
  const Positions rest = model.rest_positions();
  check_held(model, rest);
  const Eigen::VectorXd density = force_densities(model, MemberPlacer(model, rest).place_all());

  // Pieces are prestressed each by itself: what is worn on one must not depend on whether another is laid.
  struct Sums {
    double tension = 0, stiffness = 0, highest = 0;  // of tensile parts
  };
  const std::vector<int> pieces = model.piece_of_members();
  std::vector<Sums> sums(1 + *std::max_element(pieces.begin(), pieces.end()));
  for (std::size_t i = 0; i < model.members.size(); ++i) {
    const Member& m = model.members[i];
    if (m.strut) continue;
    const double tension = density[i] * m.rest;
    Sums& piece = sums[pieces[i]];
    piece.tension += tension;
    piece.stiffness += m.stiffness;
    piece.highest = std::max(piece.highest, tension / m.stiffness);
  }
  for (std::size_t i = 0; i < model.members.size(); ++i) {
    const Sums& piece = sums[pieces[i]];
    if (!(piece.tension > 0)) throw Refusal(refusal::kBadMesh, "the control mesh has no prestress at all");
    const double scale =
        std::min(options.prestress * piece.stiffness / piece.tension, kHighestPull / piece.highest);
    Member& m = model.members[i];
    m.natural = m.rest * (1 - scale * density[i] * m.rest / m.stiffness);
  }
  return model;
}

}  // namespace tensegric_fit::tensegric
