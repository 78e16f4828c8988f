#include "case_pictures.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "inspect/composition.hpp"
#include "inspect/fit_pictures.hpp"
#include "ros/body_messages.hpp"
#include "ros/export_fit.hpp"
#include "ros/fit_sheet.hpp"
#include "ros/flat.hpp"

namespace tensegric_fit::regression {
namespace {

constexpr int kWidth = 580;  // pixels: a page with all cases stays small

CasePicture picture(const std::string& caption, const cv::Mat& large) {
  cv::Mat small;
  cv::resize(large, small, {kWidth, large.rows * kWidth / large.cols}, 0, 0, cv::INTER_AREA);
  std::vector<uchar> bytes;
  cv::imencode(".png", small, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9});
  return {caption, std::string(bytes.begin(), bytes.end())};
}

// Of the regions that the fit is about.
std::vector<inspect::Part> worn_parts(const geometry::ControlMesh& control, const FitState& fit,
                                      const Eigen::Isometry3d& body_from_scan) {
  const std::vector<inspect::Part> all = inspect::parts_of(control, body_from_scan);
  std::vector<inspect::Part> worn;
  for (std::size_t r = 0; r < all.size(); ++r)
    if (std::any_of(fit.regions.begin(), fit.regions.end(),
                    [&](const RegionResult& result) { return result.name == control.regions[r].name; }))
      worn.push_back(all[r]);
  return worn;
}

std::vector<Eigen::Vector3d> line_points(const LineResult& line, const std::vector<Eigen::Vector3d>& nodes) {
  std::vector<Eigen::Vector3d> points;
  for (const std::uint32_t node : line.nodes) points.push_back(nodes.at(node));
  return points;
}

}  // namespace

std::vector<CasePicture> pictures_of(const Recording& recording) {
  std::vector<CasePicture> pictures;
  if (!recording.body || !recording.landmarks) return pictures;
  const geometry::TriangleMesh body = node::mesh_in(*recording.body);
  const geometry::BodyMeasures measures = node::measures_in(*recording.landmarks);
  pictures.push_back(picture(
      "landmarks and tapes",
      inspect::side_by_side(inspect::front_picture(body, measures), inspect::side_picture(body, measures))));
  if (!has_fit(recording)) return pictures;

  const FitState& fit = *recording.fits.back();
  const DeformedMesh& deformed = *recording.deformed.back();
  const geometry::ControlMesh control = node::control_in(*recording.control);
  const std::vector<Eigen::Vector3d> after = node::points_in(deformed.vertices),
                                     outer = node::points_in(fit.outer);
  const std::vector<double> distortion(deformed.distortion.begin(), deformed.distortion.end());
  inspect::FitScene scene{
      body, after, distortion, measures, worn_parts(control, fit, measures.body_from_scan), {}, {}};
  for (const LineResult& line : fit.lines) {
    scene.lines_before.push_back(line_points(line, control.outer));
    scene.lines_after.push_back(line_points(line, outer));
  }
  const bool behind = !scene.parts.empty() && scene.parts.back().behind;
  pictures.push_back(picture("from the side", inspect::side_picture(scene)));
  pictures.push_back(behind ? picture("from behind", inspect::back_picture(scene))
                            : picture("from the front", inspect::front_picture(scene)));
  pictures.push_back(picture("distortion", inspect::distortion_picture(scene)));
  return pictures;
}

bool has_fit(const Recording& recording) {
  return recording.body && recording.landmarks && recording.control && !recording.fits.empty() &&
         recording.deformed.size() == recording.fits.size();
}

std::string fit_page(const Recording& recording) {
  const node::FitFigures figures = node::figures_of({recording.body, recording.landmarks, recording.control,
                                                     recording.fits.back(), recording.deformed.back()});
  return node::fit_sheet(figures, {}, {"fit.glb", node::fit_model(figures)});
}

}  // namespace tensegric_fit::regression
