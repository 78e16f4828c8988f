#include "correlation/correlation_handler.hpp"

#include <fmt/format.h>
#include <pcl_conversions/pcl_conversions.h>

#include <boost/make_shared.hpp>

#include "geometry/status.hpp"
#include "ros/body_messages.hpp"
#include "ros/flat.hpp"

namespace tensegric_fit::node {
namespace {

constexpr double kMostlyCompared = 0.8;  // share of the skin under the garment; below, it is said

geometry::PointCloud cloud_in(const sensor_msgs::PointCloud2& scan) {
  pcl::PCLPointCloud2 cloud;
  pcl_conversions::toPCL(scan, cloud);
  return geometry::points_of(cloud);
}

/// Of the points, whatever their stamp.
std::string checksum_in(const std::string& scan_id) {
  return scan_id.substr(scan_id.rfind('-') + 1);
}

geometry::TriangleMesh moved(geometry::TriangleMesh mesh, const Eigen::Isometry3d& motion) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = motion * vertex;
  return mesh;
}

Correlation::ConstPtr to_message(const DeformedMesh& deformed, const std::string& worn_scan_id,
                                 double thickness, const correlation::Correlation& result) {
  const auto message = boost::make_shared<Correlation>();
  message->header = deformed.header;
  message->scan_id = deformed.scan_id;
  message->worn_scan_id = worn_scan_id;
  message->garment = deformed.garment;
  message->thickness = thickness;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c)
      message->simulated_from_worn[4 * r + c] = result.alignment.patch_from_scan.matrix()(r, c);
  message->distance.assign(result.map.distance.begin(), result.map.distance.end());
  message->compared.assign(result.map.compared.begin(), result.map.compared.end());
  message->covered_mean = result.covered.mean;
  message->covered_mean_size = result.covered.mean_size;
  message->covered_rms = result.covered.rms;
  message->covered_p95 = result.covered.p95;
  message->still_mean_size = result.still.mean_size;
  return message;
}

}  // namespace

CorrelationHandler::CorrelationHandler(Parameters parameters, MeasureScan measure)
    : measure_(std::move(measure)) {
  options_.thickness = parameters.number("thickness", options_.thickness, correlation::kThickness);
  parameters.check_all_known();
}

std::optional<CorrelationHandler::Input> CorrelationHandler::add(const TriangleMesh::ConstPtr& body) {
  if (body->scan_id != scan_id_) {
    scan_id_ = body->scan_id;
    stamp_ = body->header.stamp;
    fit_.reset();
    // It may have come while this body was being reconstructed.
    if (worn_ && (worn_->tag.header.stamp.isZero() || is_before_body(worn_->tag))) worn_.reset();
    if (worn_) worn_->of = scan_id_;
  }
  return completed(join_.add(body));
}

std::optional<CorrelationHandler::Input> CorrelationHandler::add(const DeformedMesh::ConstPtr& deformed) {
  return deformed->status == FitState::SOLVING ? std::nullopt : completed(join_.add(deformed));
}

std::optional<CorrelationHandler::Input> CorrelationHandler::add(
    const sensor_msgs::PointCloud2::ConstPtr& worn, const ScanTag& tag) {
  if (scan_id_.empty()) {
    if (!tag.header.stamp.isZero()) worn_ = {worn, tag, ""};
    throw geometry::Refusal(geometry::refusal::kNothingYet,
                            "a scan in the garment came before any body: it is compared with the first one "
                            "if that was scanned before it");
  }
  if (is_before_body(tag))
    throw geometry::Refusal(
        geometry::refusal::kNothingYet,
        fmt::format(
            "the scan in the garment was made {:.1f} s before the newest one without it: is it of the "
            "customer before, or are the clocks of two scanners not set alike?",
            (stamp_ - tag.header.stamp).toSec()));
  worn_ = {worn, tag, scan_id_};
  return input();
}

bool CorrelationHandler::is_before_body(const ScanTag& worn) const {
  return !worn.header.stamp.isZero() && worn.header.stamp < stamp_;
}

std::optional<CorrelationHandler::Input> CorrelationHandler::completed(
    const std::optional<Join::Joined>& fit) {
  if (!fit) return std::nullopt;
  fit_ = fit;
  return input();
}

std::optional<CorrelationHandler::Input> CorrelationHandler::input() const {
  if (!fit_ || !worn_ || std::get<0>(*fit_)->scan_id != worn_->of) return std::nullopt;
  return Input{*fit_, *worn_};
}

CorrelationHandler::WornBody CorrelationHandler::measured(const Worn& worn) const {
  try {
    return {worn.tag.scan_id, measure_(cloud_in(*worn.points)), std::nullopt};
  } catch (const geometry::Refusal& refusal) {
    if (refusal.code() == geometry::refusal::kSurfaceFailed) throw;  // the machine's fault: may go next time
    return {worn.tag.scan_id, {}, refusal};
  }
}

CorrelationHandler::Output CorrelationHandler::handle(const Input& input) {
  const auto& [deformed, body, landmarks, control] = input.fit;
  if (!body_ || body_->scan_id != input.worn.tag.scan_id) {
    body_.reset();
    body_ = measured(input.worn);
  }
  if (body_->refused) throw geometry::Refusal(*body_->refused);
  const MeasuredScan& worn = body_->scan;
  const geometry::TriangleMesh rest = mesh_in(*body);
  const std::vector<char> filled = filled_in(*body);
  const geometry::ControlMesh outer = control_in(*control);
  const geometry::BodyMeasures measures = measures_in(*landmarks);
  const std::vector<Eigen::Vector3d> vertices = points_in(deformed->vertices);
  const geometry::TriangleMesh nodes{outer.outer, outer.triangles};
  const correlation::Correlation result = correlation::correlate(
      {rest, vertices, nodes, measures, filled}, {worn.mesh, worn.filled, worn.measures}, options_);

  Output output;
  output.correlation = to_message(*deformed, body_->scan_id, options_.thickness, result);
  output.simulated =
      std::make_shared<const geometry::TriangleMesh>(geometry::TriangleMesh{vertices, rest.triangles});
  output.before = std::make_shared<const geometry::TriangleMesh>(rest);
  output.worn =
      std::make_shared<const geometry::TriangleMesh>(moved(worn.mesh, result.alignment.patch_from_scan));
  output.control = nodes;
  output.body_from_scan = measures.body_from_scan;
  const auto millimetres = [](double metres) { return fmt::format("{:.2f}", 1e3 * metres); };
  output.facts = {{"garment", deformed->garment},
                  {"worn_scan_id", body_->scan_id},
                  {"covered_mean_mm", millimetres(result.covered.mean)},
                  {"covered_mean_size_mm", millimetres(result.covered.mean_size)},
                  {"covered_compared", fmt::format("{:.2f}", result.compared)},
                  {"still_mean_size_mm", millimetres(result.still.mean_size)},
                  {"alignment", to_string(result.alignment.status)}};
  if (result.compared < kMostlyCompared)
    output.warning = fmt::format("{:.0f} % of the skin under the garment could not be compared",
                                 100 * (1 - result.compared));
  if (checksum_in(body_->scan_id) == checksum_in(body->scan_id))
    output.warning =
        "the scan in the garment is the one without it once more: these differences say nothing of the "
        "garment";
  return output;
}

}  // namespace tensegric_fit::node
