#include "control_mesh/fit_template.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "body_model/parts.hpp"
#include "control_mesh/grid.hpp"
#include "control_mesh/inner_nodes.hpp"
#include "control_mesh/match_skin.hpp"
#include "control_mesh/placing.hpp"
#include "control_mesh/relax.hpp"
#include "control_mesh/skin.hpp"
#include "control_mesh/subdivide.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;
using geometry::Refusal;
namespace refusal = geometry::refusal;

geometry::TriangleMesh in_body_frame(const geometry::TriangleMesh& body,
                                     const Eigen::Isometry3d& body_from_scan) {
  geometry::TriangleMesh moved = body;
  for (Vector3d& p : moved.vertices) p = body_from_scan * p;
  return moved;
}

std::vector<double> thickness_of(const Template& pattern, std::size_t nodes) {
  std::vector<double> thickness(nodes);
  for (const Side side : {Side::left, Side::right})
    for (int row = 0; row < pattern.rows; ++row)
      for (int column = 0; column <= pattern.middle(); ++column)
        if (const int node = node_at(pattern, row, column, side); node >= 0)
          thickness[node] = pattern.thickness[row][column];
  return thickness;
}

/// The nodes off the rim.
std::vector<char> inside_rim(const geometry::ControlMesh& control) {
  std::vector<char> inside(control.outer.size(), 1);
  for (const geometry::Edge& edge : geometry::edges_of({control.outer, control.triangles}))
    if (edge.right < 0) inside[edge.first] = inside[edge.second] = 0;
  return inside;
}

/// Nodes that the template leaves to be spread between others.
std::vector<char> spreadable(const Template& pattern, const geometry::ControlMesh& control, Layout layout) {
  std::vector<char> may_move = inside_rim(control);
  for (const Side side : {Side::left, Side::right})
    for (const TemplateNode& node : pattern.nodes)
      if (!node.spread || (layout == Layout::on_model && !node.or_on_model.empty()))
        may_move[node_at(pattern, node.row, node.column, side)] = 0;
  return may_move;
}

/// Nodes that need not lie exactly on the skin.
std::vector<char> liftable(const Template& pattern, const geometry::ControlMesh& control) {
  std::vector<char> may_move = inside_rim(control);
  for (const Side side : {Side::left, Side::right})
    for (const TemplateNode& node : pattern.nodes)
      if (node.placing == TemplateNode::Placing::at_landmark)
        may_move[node_at(pattern, node.row, node.column, side)] = 0;
  return may_move;
}

std::vector<GridNeighbours> grid_neighbours(const Template& pattern) {
  std::vector<GridNeighbours> around;
  for (int row = 0; row < pattern.rows; ++row)
    for (int column = 0; column < pattern.columns; ++column) {
      const int place = row * pattern.columns + column;
      if (pattern.numbers[place] < 0) continue;
      const auto at = [&](bool inside, int neighbour) { return inside ? pattern.numbers[neighbour] : -1; };
      around.push_back({at(row > 0, place - pattern.columns),
                        at(row + 1 < pattern.rows, place + pattern.columns), at(column > 0, place - 1),
                        at(column + 1 < pattern.columns, place + 1)});
    }
  return around;
}

/// All nodes but those at landmarks, each for itself.
Slides slidable(const Template& pattern, const geometry::ControlMesh& control) {
  std::vector<Slide> slides(control.outer.size(), Slide::either_way);
  for (int row = 0; row < pattern.rows; ++row)
    if (const int node = node_at(pattern, row, pattern.middle(), Side::left); node >= 0)
      slides[node] = Slide::along_column;
  for (const Side side : {Side::left, Side::right})
    for (const TemplateNode& node : pattern.nodes)
      if (node.placing == TemplateNode::Placing::at_landmark)
        slides[node_at(pattern, node.row, node.column, side)] = Slide::none;
  return {slides, grid_neighbours(pattern)};
}

std::vector<int> mirrored_nodes(const Template& pattern, std::size_t nodes) {
  std::vector<int> mirrored(nodes);
  for (auto row = pattern.numbers.begin(); row != pattern.numbers.end(); row += pattern.columns)
    for (int column = 0; column < pattern.columns; ++column)
      if (row[column] >= 0) mirrored[row[column]] = row[pattern.columns - 1 - column];
  return mirrored;
}

/// Columns may go round the trunk either way (over the front or over the back): triangles face away from the
/// axis.
void face_outward(geometry::ControlMesh& control, const Vector3d& axis) {
  double outward = 0;
  for (const Eigen::Vector3i& k : control.triangles) {
    const Vector3d &a = control.outer[k[0]], &b = control.outer[k[1]], &c = control.outer[k[2]];
    Vector3d radial = (a + b + c) / 3 - axis;
    radial.z() = 0;
    outward += radial.dot(geometry::area_vector(a, b, c));
  }
  if (outward < 0)
    for (Eigen::Vector3i& k : control.triangles) std::swap(k[1], k[2]);
}

void add_lines(const Template& pattern, geometry::ControlMesh& control) {
  for (const TemplateLine& line : pattern.lines) {
    std::vector<int> stops;
    for (const std::string& stop : line.through) stops.push_back(control.node(stop));
    control.lines.push_back({line.name, geometry::route_over_edges(control, stops, line.name)});
  }
}

/// Arms hide the trunk from rays and lie against its skin: what of them hangs below the armpits is left out.
geometry::TriangleMesh without_arms(const geometry::TriangleMesh& body,
                                    const body_model::RegisteredBody& model,
                                    const geometry::BodyMeasures& measures) {
  double armpits = std::numeric_limits<double>::infinity();
  for (const char* name : {"axilla_L", "axilla_R"})
    if (const geometry::Landmark* axilla = measures.find_landmark(name))
      armpits = std::min(armpits, (measures.body_from_scan * axilla->position).z());
  const std::vector<unsigned char> parts = body_model::parts_of(body, model);
  const std::vector<std::string>& names = model.model->parts;
  const auto is_arm = [&](int v) {
    if (parts[v] == body_model::kUnknownPart || (measures.body_from_scan * body.vertices[v]).z() > armpits)
      return false;
    const std::string& name = names[parts[v]];
    return name.rfind("upper_arm", 0) == 0 || name.rfind("forearm", 0) == 0 || name.rfind("hand", 0) == 0;
  };
  std::vector<char> keep;
  for (const Eigen::Vector3i& t : body.triangles)
    keep.push_back(!is_arm(t[0]) && !is_arm(t[1]) && !is_arm(t[2]));
  const bool any = std::find(keep.begin(), keep.end(), 1) != keep.end();
  return any ? geometry::submesh(body, keep) : body;
}

geometry::ControlMesh lay(const Template& pattern, const geometry::BodyMeasures& measures, const Skin& skin,
                          const ModelSurface* model, Layout layout) {
  geometry::ControlMesh laid = grid_of(pattern);
  laid.outer = place_nodes(pattern, measures, skin, layout, model);
  face_outward(laid, trunk_axis(pattern, measures));
  relax_on_skin(laid, spreadable(pattern, laid, layout), grid_neighbours(pattern), skin);
  // Both sides alike, so that a body whose sides are has a control mesh whose sides are; then each for
  // itself.
  Slides slides = slidable(pattern, laid);
  slides.mirrored = mirrored_nodes(pattern, laid.outer.size());
  turn_back(laid, slides, skin);
  slides.mirrored.clear();
  turn_back(laid, slides, skin);
  return laid;
}

/// As the template draws it, unless a triangle lies badly or a landmark is missing and another layout does
/// better. Where none does well, nodes of the best may lie where the others have them.
geometry::ControlMesh laid_best(const Template& pattern, const geometry::BodyMeasures& measures,
                                const Skin& skin, const ModelSurface* model) {
  std::vector<geometry::ControlMesh> laid;
  std::size_t best = 0;
  Badly least;
  std::optional<Refusal> refused;
  for (const Layout layout : {Layout::as_drawn, Layout::over_folds, Layout::on_model}) {
    // A valley between breasts is no fold to be stepped over; without its landmarks neither way goes.
    if (layout == Layout::over_folds && laid.empty()) continue;
    if (layout == Layout::on_model && !(model && pattern.may_use_model())) continue;
    try {
      laid.push_back(lay(pattern, measures, skin, model, layout));
    } catch (const Refusal& refusal) {
      if (refusal.code() == geometry::refusal::kBadTemplate) throw;  // no layout mends that
      if (!refused) refused = refusal;
      continue;
    }
    const Badly badly = count_badly_laid(laid.back(), skin);
    if (laid.size() > 1 && !(badly < least)) continue;
    best = laid.size() - 1;
    least = badly;
    if (least.none()) return laid[best];
  }
  if (laid.empty()) throw *refused;
  std::vector<std::vector<Vector3d>> elsewhere;
  for (const geometry::ControlMesh& other : laid) elsewhere.push_back(other.outer);
  geometry::ControlMesh repaired = laid[best];
  turn_back(repaired, slidable(pattern, repaired), skin, elsewhere);
  return count_badly_laid(repaired, skin) < least ? repaired : laid[best];
}

/// The template laid on the skin as finely as asked for, with its lines and inner nodes.
geometry::ControlMesh refined(const Template& pattern, geometry::ControlMesh control, const Options& options,
                              const Skin& skin) {
  // 1. Inner nodes of a table below the outer ones, and constraining lines over them.
  const auto place_at = [&](std::vector<double> thickness) {
    for (double& t : thickness) t *= options.thickness;
    place_inner_nodes(control, thickness, skin);
  };
  if (!pattern.thickness.empty()) place_at(thickness_of(pattern, control.outer.size()));
  add_lines(pattern, control);

  // 2. Finer triangles where they are asked for; what is left between triangles and skin is evened out.
  // Inner nodes over bone or under a cushion follow.
  while (control.triangles.size() < static_cast<std::size_t>(options.control_triangles))
    control = subdivide(control, skin);
  match_skin(control, liftable(pattern, control), skin);
  if (pattern.bone)
    place_on_bone(control, *pattern.bone, options.thickness);
  else if (pattern.cushion)
    place_at(thickness_of(*pattern.cushion, control));
  else
    thin_folded_units(control);
  return control;
}

/// \throw Refusal as BodySkin: nothing that a template could be laid on
void check_body(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures) {
  geometry::check_mesh(body);
  if (body.triangles.empty()) throw Refusal(refusal::kNotABody, "the body mesh has no triangles");
  for (const geometry::Missing& missing :
       measures.missing)  // its landmarks are guesses then, with no skin there
    if (missing.name == "trunk")
      throw Refusal(std::string(refusal::kMissingPart) + ":trunk",
                    "a control mesh lies on the trunk: " + missing.reason);
}

geometry::TriangleMesh skin_of(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures,
                               const body_model::RegisteredBody* model) {
  check_body(body, measures);
  return in_body_frame(model ? without_arms(body, *model, measures) : body, measures.body_from_scan);
}

void check_options(const std::vector<Options>& options) {
  for (const Options& one : options) {
    geometry::check_option("control_triangles", one.control_triangles, kControlTriangles);
    geometry::check_option("thickness", one.thickness, kThickness);
  }
}

}  // namespace

BodySkin::BodySkin(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures,
                   const body_model::RegisteredBody* model)
    : measures_(measures), skin_(skin_of(body, measures, model)), registered_(model) {}

const ModelSurface* BodySkin::model() const {
  if (registered_ && !model_) model_.emplace(*registered_, measures_.body_from_scan);
  return model_ ? &*model_ : nullptr;
}

std::vector<geometry::ControlMesh> fit_template_for_each(const Template& pattern, const BodySkin& body,
                                                         const std::vector<Options>& options) {
  check_options(options);
  const ModelSurface* model = pattern.needs_model() || pattern.may_use_model() ? body.model() : nullptr;
  if (pattern.needs_model() && !model)
    throw Refusal(std::string(refusal::kMissingPart) + ":body_model",
                  "the template " + pattern.name +
                      " has nodes on the body model, and this body comes without one: register one to it, "
                      "or use a template that places its nodes by level and angle");
  if (model)  // of all layouts, the first of which may do without
    for (const TemplateNode& node : pattern.nodes)
      for (const auto* points : {&node.on_model, &node.or_on_model})
        model->check(*points, where_of(pattern, node));

  // 1. Outer nodes on the skin, evenly spread between those that the template places.
  const geometry::ControlMesh laid = laid_best(pattern, body.measures(), body.skin(), model);

  // 2. As fine as each is to be, back in the scan's frame.
  const Eigen::Isometry3d scan_from_body = body.measures().body_from_scan.inverse();
  std::vector<geometry::ControlMesh> controls;
  for (const Options& one : options) {
    controls.push_back(refined(pattern, laid, one, body.skin()));
    for (Vector3d& p : controls.back().outer) p = scan_from_body * p;
    for (Vector3d& p : controls.back().inner) p = scan_from_body * p;
    geometry::check_control_mesh(controls.back());
  }
  return controls;
}

geometry::ControlMesh fit_template(const Template& pattern, const geometry::TriangleMesh& body,
                                   const geometry::BodyMeasures& measures, const Options& options,
                                   const body_model::RegisteredBody* model) {
  check_options({options});
  return fit_template_for_each(pattern, BodySkin(body, measures, model), {options}).front();
}

}  // namespace tensegric_fit::control_mesh
