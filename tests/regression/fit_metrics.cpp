#include "fit_metrics.hpp"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <stdexcept>

#include "ros/body_messages.hpp"
#include "ros/export_fit.hpp"
#include "ros/flat.hpp"

namespace tensegric_fit::tests {
namespace {

template <typename Message>
boost::shared_ptr<const Message> only(const rosbag::Bag& bag, const std::string& topic) {
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  if (view.size() != 1)
    throw std::runtime_error(topic + ": " + std::to_string(view.size()) + " messages, not one");
  return view.begin()->instantiate<Message>();
}

node::FittedScan fit_in(const std::string& path) {
  const rosbag::Bag bag(path);
  const node::FittedScan scan{only<TriangleMesh>(bag, "body/mesh"), only<Landmarks>(bag, "body/landmarks"),
                              only<ControlMesh>(bag, "control/mesh"), only<FitState>(bag, "control/deformed"),
                              only<DeformedMesh>(bag, "body/deformed")};
  for (const std::string& scan_id :
       {scan.landmarks->scan_id, scan.control->scan_id, scan.fit->scan_id, scan.deformed->scan_id})
    if (scan_id != scan.body->scan_id) throw std::runtime_error("two scans are mixed: " + scan_id);
  return scan;
}

double largest_move(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
  double largest = 0;
  for (std::size_t i = 0; i < from.size(); ++i) largest = std::max(largest, (to.at(i) - from[i]).norm());
  return largest;
}

}  // namespace

std::map<std::string, double> fit_metrics(const std::string& bag) {
  const node::FittedScan scan = fit_in(bag);
  const geometry::BodyMeasures measures = node::measures_in(*scan.landmarks);
  std::map<std::string, double> metrics;
  for (const geometry::Measure& height : measures.heights) metrics["height/" + height.name] = height.metres;
  for (const geometry::Measure& girth : measures.girths) metrics["girth/" + girth.name] = girth.metres;
  for (const geometry::Landmark& landmark : measures.landmarks) {
    const Eigen::Vector3d& position = landmark.position;
    metrics["landmark/" + landmark.name + "/x"] = position.x();
    metrics["landmark/" + landmark.name + "/y"] = position.y();
    metrics["landmark/" + landmark.name + "/z"] = position.z();
  }
  for (const LineResult& line : scan.fit->lines) metrics["line/" + line.name + "/ratio"] = line.ratio;
  for (const RegionResult& region : scan.fit->regions)
    metrics["region/" + region.name + "/volume_error"] = region.volume_after / region.volume_before - 1;
  metrics["fit/converged"] = scan.fit->status == FitState::CONVERGED;

  metrics["body/triangles"] = static_cast<double>(scan.body->triangles.size() / 3);
  metrics["body/volume"] = scan.deformed->volume_before;
  metrics["body/volume_change"] = scan.deformed->volume_after / scan.deformed->volume_before - 1;
  metrics["body/largest_move"] =
      largest_move(node::points_in(scan.body->vertices), node::points_in(scan.deformed->vertices));
  const auto [least, most] =
      std::minmax_element(scan.deformed->distortion.begin(), scan.deformed->distortion.end());
  metrics["distortion/least"] = *least;
  metrics["distortion/most"] = *most;
  return metrics;
}

}  // namespace tensegric_fit::tests
