#include "inspect/measured_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "inspect/labels.hpp"
#include "inspect/picture.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr Colour kTape{60, 120, 140}, kLandmark{176, 44, 84};
constexpr double kOnTheSkin = 0.012;   // m
constexpr double kCloseBehind = 0.10;  // m
constexpr double kAround = 1.06;       // size of the picture by that of the body

std::string words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string girth_words(const geometry::BodyMeasures& measures, const std::string& name) {
  const auto girth = std::find_if(measures.girths.begin(), measures.girths.end(),
                                  [&name](const geometry::Measure& measure) { return measure.name == name; });
  if (girth == measures.girths.end()) return words(name);
  char centimetres[32];
  std::snprintf(centimetres, sizeof centimetres, " %.1f cm", 100 * girth->metres);
  return words(name) + centimetres;
}

// The tape's outermost point that can be seen; the right end of one that goes round the middle.
const SeenPoint* end_of_tape(const SeenPoint* first, const SeenPoint* last, double middle) {
  constexpr double kLeft = 0.8;  // what the left end counts
  const auto outward = [&](const SeenPoint& p) {
    return p.pixel.x() > middle ? p.pixel.x() - middle : kLeft * (middle - p.pixel.x());
  };
  const SeenPoint* end = nullptr;
  for (const SeenPoint* p = first; p != last; ++p)
    if (p->behind < kOnTheSkin && (!end || outward(*p) > outward(*end))) end = p;
  return end;
}

/// The model's quads that face a viewer who looks along `forward`.
std::vector<Polyline> facing_quads(const ModelSkin& skin, const Eigen::Vector3d& forward) {
  const std::vector<Colour> colours = part_colours(skin.parts);
  std::vector<Polyline> quads;
  for (const std::array<int, 4>& q : skin.quads) {
    const auto at = [&](int corner) -> const Eigen::Vector3d& { return skin.vertices[q[corner]]; };
    const Eigen::Vector3d outwards = (at(2) - at(0)).cross(at(3) - at(1));
    if (outwards.dot(forward) < 0)
      quads.push_back({{at(0), at(1), at(2), at(3)}, true, colours[skin.part[q[0]]], 0});
  }
  return quads;
}

cv::Mat measured_picture(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures,
                         MakeView make, int height, const ModelOverlay* model,
                         const std::vector<Eigen::Vector3d>& normals) {
  View view = framed(make, measures.body_from_scan, body.vertices, kAround);
  const Eigen::Vector3d right = view.forward.cross(view.up);
  double half_width = 0, half_height = 0;
  for (const Eigen::Vector3d& v : body.vertices) {
    half_width = std::max(half_width, std::abs(right.dot(v - view.centre)));
    half_height = std::max(half_height, std::abs(view.up.dot(v - view.centre)));
  }
  view.height = std::max(1e-3, 2 * kAround * half_height);
  const int width = std::max(1, static_cast<int>(2 * kAround * half_width / view.height * height));

  std::vector<Colour> colours;
  std::vector<Polyline> tapes;
  if (model != nullptr) {
    colours = tinted_skin(model->mesh_parts, model->skin.parts);
    tapes = facing_quads(model->skin, view.forward);
  }
  std::vector<Label> labels;
  // Landmarks, then the points of one tape after another: the body is looked at once.
  std::vector<Eigen::Vector3d> points;
  for (const geometry::Landmark& landmark : measures.landmarks) points.push_back(landmark.position);
  for (const geometry::GirthLoop& loop : measures.loops)
    points.insert(points.end(), loop.points.begin(), loop.points.end());
  const std::vector<SeenPoint> seen = seen_points(body, points, view, width, height);
  const SeenPoint* tape = seen.data() + measures.landmarks.size();
  for (const geometry::GirthLoop& loop : measures.loops) {
    tapes.push_back({loop.points, true, kTape});
    if (const SeenPoint* end = end_of_tape(tape, tape + loop.points.size(), width / 2.0))
      labels.push_back({girth_words(measures, loop.name), end->pixel, kTape, Label::Mark::none});
    tape += loop.points.size();
  }
  for (std::size_t i = 0; i < measures.landmarks.size(); ++i)
    if (seen[i].behind < kCloseBehind)
      labels.push_back({words(measures.landmarks[i].name), seen[i].pixel, kLandmark,
                        seen[i].behind < kOnTheSkin ? Label::Mark::dot : Label::Mark::ring});
  return with_labels(draw(body, colours, tapes, view, width, height, normals), labels);
}

}  // namespace

cv::Mat front_picture(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures, int height,
                      const ModelOverlay* model, const std::vector<Eigen::Vector3d>& normals) {
  return measured_picture(body, measures, front_view, height, model, normals);
}
cv::Mat side_picture(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures, int height,
                     const ModelOverlay* model, const std::vector<Eigen::Vector3d>& normals) {
  return measured_picture(body, measures, side_view, height, model, normals);
}

}  // namespace tensegric_fit::inspect
