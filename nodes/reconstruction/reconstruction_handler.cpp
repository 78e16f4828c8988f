#include "reconstruction/reconstruction_handler.hpp"

#include <fmt/format.h>
#include <pcl_conversions/pcl_conversions.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <set>
#include <utility>

#include "body_model/model_message.hpp"
#include "body_model/parts.hpp"
#include "body_model/registration.hpp"
#include "geometry/percentile.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/scan_extent.hpp"
#include "geometry/status.hpp"
#include "reconstruction/validate.hpp"
#include "ros/body_messages.hpp"

namespace tensegric_fit::node {
namespace {

Hole to_message(const reconstruction::Hole& hole) {
  Hole message;
  for (int k = 0; k < 3; ++k) message.centre[k] = hole.centre[k];
  message.area = hole.area;
  message.confidence = hole.confidence;
  return message;
}

std::string words(const std::vector<body_model::Unexplained>& things) {
  std::string text;
  for (const body_model::Unexplained& thing : things) text += (text.empty() ? "" : "; ") + thing.reason;
  return text;
}

}  // namespace

reconstruction::Options reconstruction_options(Parameters& parameters) {
  reconstruction::Options options;
  options.body_triangles =
      parameters.integer("body_triangles", options.body_triangles, reconstruction::kBodyTriangles);
  options.poisson_depth =
      parameters.integer("poisson_depth", options.poisson_depth, reconstruction::kPoissonDepth);
  options.min_points = parameters.integer("min_points", options.min_points, reconstruction::kMinPoints);
  options.max_points = parameters.integer("max_points", options.max_points, reconstruction::kMaxPoints);
  options.support_distance =
      parameters.number("support_distance", options.support_distance, reconstruction::kSupportDistance);
  options.bust_only = parameters.flag("bust_only", options.bust_only);
  reconstruction::check_options(options);
  return options;
}

reconstruction::Anatomy shipped_anatomy() {
  const body_model::Registrar& registrar = body_model::shipped_registrar();
  return {[&registrar](const body_model::Samples& samples) { return registrar(samples); },
          registrar.standing()};
}

namespace {

// Frames of the same booth: those of one namespace.
std::vector<std::string> beside(const std::string& frame, const std::vector<std::string>& known) {
  const auto prefix = [](const std::string& name) {  // older drivers put a slash in front
    const std::size_t from = name.rfind('/', 0) == 0 ? 1 : 0;
    return name.substr(from, name.rfind('/') + 1 - from);
  };
  std::vector<std::string> own;
  for (const std::string& other : known)
    if (prefix(other) == prefix(frame)) own.push_back(other);
  std::sort(own.begin(), own.end());
  return own;
}

/// Before her surface is looked for: far away coordinates of single precision show none. \throw Refusal
/// no_transform
void check_near_origin(const std::vector<Eigen::Vector3d>& points, const std::string& frame) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& p : points)
      if (std::isfinite(p[axis])) values.push_back(p[axis]);
    const double middle = values.empty() ? 0 : std::abs(geometry::median(std::move(values)));
    if (middle >= geometry::kFarthestFromOrigin)
      throw geometry::Refusal(
          geometry::refusal::kNoTransform,
          fmt::format(
              "the scan is {:.0f} km from the origin of frame '{}': the chain's messages are in single "
              "precision; send scans in a frame of the booth",
              middle / 1000, frame));
  }
}

std::string last_part(const std::string& frame) {
  return frame.substr(frame.rfind('/') + 1);
}

}  // namespace

std::vector<std::string> frames_of_others(const std::string& transforms, const std::string& body_frame) {
  std::set<std::string> frames;
  try {
    for (const auto& frame : YAML::Load(transforms)) {
      const auto name = frame.first.as<std::string>();  // who broadcasts it a tf2 listener does not know
      if (last_part(name) == last_part(body_frame)) continue;  // of another booth's chain, too
      frames.insert(name);
      frames.insert(frame.second["parent"].as<std::string>());
    }
  } catch (const YAML::Exception&) {
    return {};
  }
  return {frames.begin(), frames.end()};
}

std::string lacks_of(const std_msgs::Header& header, const std::vector<std::string>& known) {
  std::string words;
  if (header.stamp.isZero())
    words = "no_stamp: the scan has no time stamp; let the driver set it, or equal scans count as one. ";
  if (header.frame_id.empty())
    words += "no_frame: the scan names no frame and is taken to be in 'scan'; set the driver's frame_id. ";
  const std::vector<std::string> own = beside(header.frame_id, known);
  if (!header.frame_id.empty() && !own.empty() &&
      !std::binary_search(own.begin(), own.end(), header.frame_id))
    words += fmt::format("unknown_frame: tf does not know '{}', only {}; is the driver's frame_id misspelt? ",
                         header.frame_id, fmt::join(own, ", "));
  if (!words.empty()) words.pop_back();
  return words;
}

std::string company_of(const body_model::RegisteredBody& body) {
  for (const body_model::Unexplained& thing : body.unexplained)
    if (thing.person)
      return fmt::format(
          "two_persons: somebody else, or something as large, is in the scan, {:.1f} m from her, and was "
          "left "
          "out; is it she that is shown? Scan her alone.",
          (thing.centre - body.joints.front()).head<2>().norm());
  return {};
}

ReconstructionHandler::ReconstructionHandler(Parameters parameters)
    : options_(reconstruction_options(parameters)), anatomy_(shipped_anatomy()) {
  parameters.check_all_known();
}

ReconstructionHandler::Output ReconstructionHandler::handle(const sensor_msgs::PointCloud2& scan,
                                                            const ScanTag& tag) const {
  pcl::PCLPointCloud2 cloud;
  pcl_conversions::toPCL(scan, cloud);
  const geometry::PointCloud points = geometry::points_of(cloud);
  check_near_origin(points.points, scan.header.frame_id);
  const auto result = std::make_shared<const reconstruction::Reconstruction>(
      reconstruction::reconstruct(points, options_, anatomy_));
  const reconstruction::BodyMesh& body = result->body;
  const auto mesh = boost::make_shared<TriangleMesh>(node::to_message(tag, body.mesh, body.filled));
  for (const reconstruction::Hole& hole : body.holes) mesh->holes.push_back(to_message(hole));
  for (const geometry::Fracture& fracture : body.fractures)
    mesh->fractures.push_back(node::to_message(fracture));
  const auto model = boost::make_shared<BodyModel>(
      to_message(tag, result->model, body_model::parts_of(body.mesh, result->model)));
  return {mesh,
          model,
          result,
          {{"points_used", std::to_string(body.points_used)},
           {"vertices", std::to_string(body.mesh.vertices.size())},
           {"triangles", std::to_string(body.mesh.triangles.size())},
           {"holes_closed", std::to_string(body.holes.size())},
           {"fractures", std::to_string(body.fractures.size())},
           {"model_residual_mm", fmt::format("{:.2f}", 1e3 * result->model.residual)},
           {"unexplained", words(result->model.unexplained)},
           {"note", result->model.note}}};
}

}  // namespace tensegric_fit::node
