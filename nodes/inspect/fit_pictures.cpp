#include "inspect/fit_pictures.hpp"

#include <algorithm>
#include <limits>

#include "inspect/composition.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr int kPanel = 750;  // pixels
constexpr int kSingle = 900;
constexpr Colour kGarment{176, 44, 84}, kTape{90, 130, 150}, kInk{52, 50, 48};

using MakeView = View (*)(const Eigen::Isometry3d&, const Eigen::Vector3d&, double);

// The square that holds the points, `margin` times as large as they need.
View framed(MakeView make, const geometry::BodyMeasures& measures, const std::vector<Eigen::Vector3d>& points,
            double margin) {
  View view = make(measures.body_from_scan, Eigen::Vector3d::Zero(), 1);
  const Eigen::Vector3d right = view.forward.cross(view.up);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Eigen::Vector2d low(kFar, kFar), high(-kFar, -kFar);
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector2d seen(p.dot(right), p.dot(view.up));
    low = low.cwiseMin(seen);
    high = high.cwiseMax(seen);
  }
  if (points.empty()) return view;
  const Eigen::Vector2d middle = (low + high) / 2;
  view.centre = middle.x() * right + middle.y() * view.up;
  view.height = std::max(1e-3, margin * (high - low).maxCoeff());
  return view;
}

View framed(MakeView make, const FitScene& scene) {
  if (scene.parts.empty()) return framed(make, scene.measures, scene.before.vertices, 1.1);
  std::vector<Eigen::Vector3d> all;
  for (const Part& part : scene.parts) all.insert(all.end(), part.nodes.begin(), part.nodes.end());
  return framed(make, scene.measures, all, 1.45);
}

std::vector<Polyline> garment_lines(const std::vector<std::vector<Eigen::Vector3d>>& lines,
                                    const Colour& colour) {
  std::vector<Polyline> drawn;
  for (const auto& points : lines) drawn.push_back({points, false, colour});
  return drawn;
}

cv::Mat before_and_after(const FitScene& scene, MakeView make) {
  const View view = framed(make, scene);
  const cv::Mat left =
      draw(scene.before, {}, garment_lines(scene.lines_before, kGarment), view, kPanel, kPanel);
  const cv::Mat right = draw({scene.after, scene.before.triangles}, {},
                             garment_lines(scene.lines_after, kGarment), view, kPanel, kPanel);
  return side_by_side(with_caption(left, "before"), with_caption(right, "after"));
}

cv::Mat with_tapes(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures,
                   MakeView make) {
  std::vector<Polyline> tapes;
  for (const geometry::GirthLoop& loop : measures.loops) tapes.push_back({loop.points, true, kTape});
  return draw(body, {}, tapes, framed(make, measures, body.vertices, 1.1), kSingle, kSingle);
}

}  // namespace

cv::Mat front_picture(const FitScene& scene) {
  return before_and_after(scene, front_view);
}
cv::Mat side_picture(const FitScene& scene) {
  return before_and_after(scene, side_view);
}
cv::Mat back_picture(const FitScene& scene) {
  return before_and_after(scene, back_view);
}

cv::Mat distortion_picture(const FitScene& scene) {
  const geometry::TriangleMesh after{scene.after, scene.before.triangles};
  const std::vector<Colour> colours = distortion_colours(scene.distortion);
  const std::vector<Polyline> lines = garment_lines(scene.lines_after, kInk);
  std::vector<Part> rows = scene.parts;
  if (rows.empty()) rows.push_back({scene.before.vertices, false});
  std::vector<cv::Mat> pictures;
  for (const Part& row : rows) {
    const auto from = [&](MakeView make) {
      return draw(after, colours, lines, framed(make, scene.measures, row.nodes, 1.45), kPanel, kPanel);
    };
    pictures.push_back(row.behind ? side_by_side(from(back_view), from(oblique_back_view))
                                  : side_by_side(from(front_view), from(oblique_view)));
  }
  cv::Mat picture;
  cv::vconcat(pictures, picture);
  return with_distortion_scale(with_caption(picture, "area of the skin after / before"));
}

cv::Mat front_picture(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures) {
  return with_tapes(body, measures, front_view);
}
cv::Mat side_picture(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures) {
  return with_tapes(body, measures, side_view);
}

}  // namespace tensegric_fit::inspect
