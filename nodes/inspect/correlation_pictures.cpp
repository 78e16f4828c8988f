#include "inspect/correlation_pictures.hpp"

#include <opencv2/imgproc.hpp>

#include "geometry/status.hpp"
#include "inspect/composition.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr int kDistancePanel = 750, kPanelEdge = 4;  // pixels
constexpr double kBodyMargin = 1.45;
const cv::Vec3b kPanelPaper(255, 255, 255), kBody(205, 200, 196);
const cv::Scalar kSimulated(60, 48, 40), kBefore(120, 118, 116);

cv::Vec3b bgr(const Colour& colour) {
  return {colour[2], colour[1], colour[0]};
}

void check(const CorrelationScene& scene) {
  if (scene.distance.size() != scene.simulated.vertices.size() ||
      scene.compared.size() != scene.simulated.vertices.size())
    throw geometry::Refusal(geometry::refusal::kBadMesh, "picture: not one distance a vertex");
}

std::vector<std::vector<cv::Point>> outlines_of(const cv::Mat1b& mask) {
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(mask, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  return outlines;
}

// Drawn a little larger than it is shown: outlines that the picture's edge makes are no outlines.
cv::Mat outlines_from(MakeView make, const CorrelationScene& scene, const Part& part) {
  constexpr int kSize = kDistancePanel + 2 * kPanelEdge;
  View view = framed(make, scene.body_from_scan, part.nodes, kBodyMargin);
  view.height *= static_cast<double>(kSize) / kDistancePanel;
  const cv::Mat1b simulated = silhouette(scene.simulated, view, kSize, kSize),
                  before = silhouette(scene.before, view, kSize, kSize),
                  worn = silhouette(scene.worn, view, kSize, kSize);
  cv::Mat3b picture(kSize, kSize, kPanelPaper);
  picture.setTo(kBody, worn & simulated);
  picture.setTo(bgr(two_sided_colour(0.7)), worn & ~simulated);
  picture.setTo(bgr(two_sided_colour(-0.7)), simulated & ~worn);
  for (const auto& outline : outlines_of(before))
    for (std::size_t i = 0; i < outline.size(); i += 8)
      cv::circle(picture, outline[i], 1, kBefore, cv::FILLED, cv::LINE_AA);
  cv::drawContours(picture, outlines_of(simulated), -1, kSimulated, 2, cv::LINE_AA);
  return picture(cv::Rect(kPanelEdge, kPanelEdge, kDistancePanel, kDistancePanel)).clone();
}

std::vector<Part> rows_of(const CorrelationScene& scene) {
  if (!scene.parts.empty() && scene.parts.size() <= kMostRows) return scene.parts;
  return {{scene.simulated.vertices, false}};
}

cv::Mat stacked(const std::vector<cv::Mat>& rows) {
  cv::Mat picture;
  cv::vconcat(rows, picture);
  return picture;
}

}  // namespace

std::vector<Colour> distance_colours(const std::vector<double>& distance, const std::vector<char>& compared) {
  std::vector<Colour> colours;
  for (std::size_t v = 0; v < distance.size(); ++v)
    colours.push_back(distance_colour(distance[v], compared[v] != 0));
  return colours;
}

cv::Mat distance_picture(const CorrelationScene& scene) {
  check(scene);
  const std::vector<Colour> colours = distance_colours(scene.distance, scene.compared);
  std::vector<cv::Mat> rows;
  for (const Part& part : rows_of(scene)) {
    const auto from = [&](MakeView make) {
      return draw(scene.simulated, colours, {}, framed(make, scene.body_from_scan, part.nodes, kBodyMargin),
                  kDistancePanel, kDistancePanel);
    };
    rows.push_back(part.behind ? side_by_side(from(back_view), from(oblique_back_view))
                               : side_by_side(from(front_view), from(oblique_view)));
  }
  return with_distance_scale(
      with_caption(stacked(rows), "worn scan against simulated body (blue-grey: not compared)"));
}

cv::Mat silhouette_picture(const CorrelationScene& scene) {
  check(scene);
  std::vector<cv::Mat> rows;
  for (const Part& part : rows_of(scene))
    rows.push_back(
        side_by_side(outlines_from(front_view, scene, part), outlines_from(side_view, scene, part)));
  return with_caption(stacked(rows), "worn: grey; farther out: worn blue, simulated red; dots: before");
}

}  // namespace tensegric_fit::inspect
