#include "inspect/overlays.hpp"

#include <algorithm>
#include <utility>

#include "geometry/status.hpp"
#include "geometry/surface_tree.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr double kDotLift = 0.005;    // metres: most of a dot is seen
constexpr double kModelLift = 0.002;  // metres: over the chords of the body's triangles

// Whether there was something of it.
template <typename Held>
bool forget_in(Held& held, const std::string& scan_id) {
  if (!held || held->scan_id != scan_id) return false;
  held.reset();
  return true;
}

template <typename Held>
bool is_of(const Held& held, const BodyView& body) {
  return held && held->scan_id == body.scan_id();
}

}  // namespace

void Overlays::take_measures(const std::string& scan_id, geometry::BodyMeasures measures) {
  measures_ = {scan_id, std::move(measures)};
  carried_.reset();
}

void Overlays::take_model(const std::string& scan_id, ModelSkin skin) {
  check_model_skin(skin);
  model_ = {scan_id, std::move(skin)};
  carried_model_.reset();
}

void Overlays::take_control(const std::string& scan_id, geometry::ControlMesh control) {
  control_ = {scan_id, std::move(control)};
}

bool Overlays::forget(const std::string& scan_id) {
  const bool had_measures = forget_in(measures_, scan_id), had_model = forget_in(model_, scan_id);
  if (had_measures) carried_.reset();
  if (had_model) carried_model_.reset();
  bool had_others = forget_in(control_, scan_id);
  had_others |= forget_in(fit_, scan_id);
  had_others |= forget_in(bands_, scan_id);
  had_others |= forget_in(members_, scan_id);
  return had_measures || had_model || had_others;
}

void Overlays::take_fit(const std::string& scan_id, std::vector<Eigen::Vector3d> outer,
                        std::vector<TenseLine> lines) {
  if (lines.empty() && fit_ && fit_->scan_id == scan_id) lines = std::move(fit_->value.lines);
  fit_ = {scan_id, {std::move(outer), std::move(lines)}};
}

void Overlays::take_members(const std::string& scan_id, MemberPulls members) {
  if (members.ends.size() != 2 * members.forces.size())
    throw geometry::Refusal(geometry::refusal::kBadMesh, "members and forces do not fit each other");
  for (const int end : members.ends)
    if (end < 0 || end >= static_cast<int>(members.nodes.size()))
      throw geometry::Refusal(geometry::refusal::kBadMesh, "a member ends at a node that is not there");
  members_ = {scan_id, std::move(members)};
}

void Overlays::take_bands(const std::string& scan_id, std::vector<BandOnSkin> bands) {
  for (const BandOnSkin& band : bands) {
    bool fits = band.at_rest.size() > 1 && band.at_rest.size() == band.worn.size();
    for (const auto* fibres : {&band.at_rest, &band.worn})
      for (const auto& fibre : *fibres)
        fits = fits && fibre.size() > 1 && fibre.size() == band.at_rest.front().size();
    if (!fits)
      throw geometry::Refusal(geometry::refusal::kBadMesh, "the fibres of a band do not fit each other");
  }
  bands_ = {scan_id, std::move(bands)};
}

const geometry::BodyMeasures* Overlays::measures(const BodyView& body) const {
  return is_of(measures_, body) ? &measures_->value : nullptr;
}

bool Overlays::carry(const BodyView& body) {
  if (!is_of(measures_, body) || body.empty()) return false;
  if (carried_ && carried_->revision == body.revision()) return true;
  const geometry::SurfaceTree skin(body.mesh());
  const auto bound = [&](const std::vector<Eigen::Vector3d>& points) {
    return geometry::CarriedPoints(body.mesh(), skin, points);
  };
  std::vector<Eigen::Vector3d> landmarks;
  for (const auto& landmark : measures_->value.landmarks) landmarks.push_back(landmark.position);
  carried_ = {body.revision(), bound(landmarks), {}};
  for (const auto& loop : measures_->value.loops) carried_->loops.push_back(bound(loop.points));
  return true;
}

std::vector<NamedDot> Overlays::dots(const BodyView& body, double blend) {
  std::vector<NamedDot> dots;
  if (!carry(body)) return dots;
  const std::vector<Eigen::Vector3d> places = carried_->landmarks.at(body.vertices(blend), kDotLift);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const geometry::Landmark& landmark = measures_->value.landmarks[i];
    dots.push_back(
        {places[i], landmark.name, landmark.confidence < geometry::kUnsure ? kUnsureColour : kSureColour});
  }
  return dots;
}

std::vector<Stroke> Overlays::tapes(const BodyView& body, double blend) {
  std::vector<Stroke> tapes;
  if (!carry(body)) return tapes;
  const std::vector<Eigen::Vector3d> vertices = body.vertices(blend);
  for (const geometry::CarriedPoints& loop : carried_->loops) {
    Stroke tape{loop.at(vertices), kSureColour};
    if (tape.points.empty()) continue;
    tape.points.push_back(tape.points.front());
    tapes.push_back(std::move(tape));
  }
  return tapes;
}

std::vector<Stroke> Overlays::model(const BodyView& body, double blend) {
  if (!is_of(model_, body) || body.empty()) return {};
  if (!carried_model_ || carried_model_->revision != body.revision())
    carried_model_ = {
        body.revision(),
        geometry::CarriedPoints(body.mesh(), geometry::SurfaceTree(body.mesh()), model_->value.vertices)};
  return model_strokes(model_->value, carried_model_->skin.at(body.vertices(blend), kModelLift));
}

std::optional<std::vector<Eigen::Vector3d>> Overlays::outer(const BodyView& body, double blend) const {
  if (!is_of(control_, body)) return std::nullopt;
  const std::vector<Eigen::Vector3d>& rest = control_->value.outer;
  if (!is_of(fit_, body) || fit_->value.outer.size() != rest.size()) return rest;
  return between(rest, fit_->value.outer, blend);
}

std::vector<Stroke> Overlays::edges(const BodyView& body, double blend) const {
  const auto nodes = outer(body, blend);
  return nodes ? edge_strokes(control_->value, *nodes) : std::vector<Stroke>{};
}

std::vector<Stroke> Overlays::lines(const BodyView& body, double blend) const {
  const auto nodes = outer(body, blend);
  if (!nodes || !is_of(fit_, body)) return {};
  std::vector<TenseLine> lines = fit_->value.lines;
  const auto is_ribbon = [&](const TenseLine& line) {
    return is_of(bands_, body) &&
           std::any_of(bands_->value.begin(), bands_->value.end(), [&](const BandOnSkin& band) {
             return band.line == line.name && band.tension == line.tension;
           });
  };
  lines.erase(std::remove_if(lines.begin(), lines.end(), is_ribbon), lines.end());
  for (TenseLine& line : lines)
    if (line.course.size() == line.course_at_rest.size())
      line.course = between(line.course_at_rest, line.course, blend);
  return line_strokes(control_->value, *nodes, lines);
}

std::vector<Ribbon> Overlays::ribbons(const BodyView& body, double blend) const {
  const auto nodes = outer(body, blend);
  if (!nodes || !is_of(bands_, body)) return {};
  return band_ribbons(control_->value, *nodes, bands_->value, blend);
}

std::vector<Stroke> Overlays::members(const BodyView& body, double blend) const {
  std::vector<Stroke> strokes;
  if (!is_of(members_, body) || !is_of(control_, body)) return strokes;
  const MemberPulls& pulls = members_->value;
  const geometry::ControlMesh& control = control_->value;
  const std::size_t count = control.outer.size();
  if (count == 0 || pulls.nodes.size() < 2 * count || pulls.nodes.size() % count != 0) return strokes;
  std::vector<Eigen::Vector3d> nodes = control.outer;
  nodes.insert(nodes.end(), control.inner.begin(), control.inner.end());
  const std::size_t layers = pulls.nodes.size() / count - 1;
  for (std::size_t level = 1; level < layers; ++level)
    for (std::size_t i = 0; i < count; ++i)
      nodes.push_back(control.outer[i] + static_cast<double>(level) / static_cast<double>(layers) *
                                             (control.inner[i] - control.outer[i]));
  nodes = between(nodes, pulls.nodes, blend);
  for (std::size_t m = 0; m < pulls.forces.size(); ++m)
    strokes.push_back(
        {{nodes[pulls.ends[2 * m]], nodes[pulls.ends[2 * m + 1]]}, member_colour(pulls.forces[m])});
  return strokes;
}

}  // namespace tensegric_fit::inspect
