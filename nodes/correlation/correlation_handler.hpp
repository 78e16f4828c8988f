/// body/mesh + body/landmarks + control/mesh + body/deformed + worn/points -> worn/correlation
#pragma once

#include <sensor_msgs/PointCloud2.h>
#include <tensegric_fit/ControlMesh.h>
#include <tensegric_fit/Correlation.h>
#include <tensegric_fit/DeformedMesh.h>
#include <tensegric_fit/FitState.h>
#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/TriangleMesh.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "correlation/correlate.hpp"
#include "geometry/body_measures.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/status.hpp"
#include "geometry/triangle_mesh.hpp"
#include "ros/facts.hpp"
#include "ros/parameters.hpp"
#include "ros/scan_join.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::node {

/// A scan in the garment, measured.
struct MeasuredScan {
  geometry::TriangleMesh mesh;
  std::vector<char> filled;  ///< one flag per vertex: no point of the scan is there
  geometry::BodyMeasures measures;
};

/// Measures a scan as the stages before do; whoever wires the node gives it. Called by the thread of
/// handle().
using MeasureScan = std::function<MeasuredScan(const geometry::PointCloud& scan)>;

class CorrelationHandler {
 public:
  /// Reads the parameters of the correlation; checks that none is left: `measure` has read its own.
  /// \throw Refusal bad_option
  CorrelationHandler(Parameters parameters, MeasureScan measure);

  // What comes in, for one thread. Each returns the correlation that it completes, if any: of the newest fit
  // with the newest worn scan, where both are of the newest body.

  using Join = ScanJoin<DeformedMesh, TriangleMesh, Landmarks, ControlMesh>;
  struct Worn {
    sensor_msgs::PointCloud2::ConstPtr points;
    ScanTag tag;
    std::string of;  ///< scan_id of the body that it is compared with; empty: it came before any
  };
  struct Input {
    Join::Joined fit;
    Worn worn;
  };
  /// A body of another scan: a worn scan without a stamp, or made before it, was for the one before and is
  /// forgotten.
  std::optional<Input> add(const TriangleMesh::ConstPtr& body);
  std::optional<Input> add(const Landmarks::ConstPtr& landmarks) { return completed(join_.add(landmarks)); }
  std::optional<Input> add(const ControlMesh::ConstPtr& control) { return completed(join_.add(control)); }
  /// Shapes on the way of a fit do not count.
  std::optional<Input> add(const DeformedMesh::ConstPtr& deformed);
  /// \throw Refusal nothing_yet: there is no body so far that it could be a second scan of (one with a stamp
  /// waits for the first body: where this node was started again, what is latched comes in any order), or its
  /// stamp is earlier than the body's: what a publisher latched of the customer before
  std::optional<Input> add(const sensor_msgs::PointCloud2::ConstPtr& worn, const ScanTag& tag);

  /// Whether the scan in the garment of that id waits for a body.
  bool waits(const std::string& worn_scan_id) const {
    return worn_ && worn_->of.empty() && worn_->tag.scan_id == worn_scan_id;
  }

  /// scan_id of the newest body; empty before the first.
  const std::string& scan_id() const { return scan_id_; }

  struct Output {
    Correlation::ConstPtr correlation;
    std::shared_ptr<const geometry::TriangleMesh> simulated, before, worn;  ///< all in the frame before
    geometry::TriangleMesh control;
    Eigen::Isometry3d body_from_scan;
    Facts facts;
    std::string warning;  ///< empty where there is nothing to be said
  };
  /// For one thread, which need not be that of add(). \throw Refusal as MeasureScan, which is not asked again
  /// about a scan that it refused, and correlate
  Output handle(const Input& input);

 private:
  bool is_before_body(const ScanTag& worn) const;
  std::optional<Input> completed(const std::optional<Join::Joined>& fit);
  std::optional<Input> input() const;

  MeasureScan measure_;
  correlation::Options options_;
  Join join_;
  std::string scan_id_;
  ros::Time stamp_;                  // of that scan
  std::optional<Join::Joined> fit_;  // newest
  std::optional<Worn> worn_;         // newest

  /// A worn scan as far as it is known without a fit: another garment needs no other reconstruction.
  struct WornBody {
    std::string scan_id;
    MeasuredScan scan;
    std::optional<geometry::Refusal> refused;  // in place of the scan
  };
  WornBody measured(const Worn& worn) const;
  std::optional<WornBody> body_;  // of the newest worn scan; for the thread of handle()
};

}  // namespace tensegric_fit::node
