/// body/mesh + body/landmarks + control/mesh + control/deformed -> body/deformed
#pragma once

#include <memory>
#include <optional>

#include "geometry/posture.hpp"
#include "ros/facts.hpp"
#include "ros/fit_figures.hpp"
#include "ros/parameters.hpp"
#include "ros/scan_join.hpp"
#include "tffd/binding.hpp"

namespace tensegric_fit::node {

/// A body bound to its control mesh: what a change of garment does not touch.
struct BoundBody {
  TriangleMesh::ConstPtr body;
  ControlMesh::ConstPtr control;
  geometry::TriangleMesh mesh;
  geometry::ControlMesh control_mesh;
  Eigen::Isometry3d body_from_scan;
  geometry::Posture posture;
  tffd::Binding binding;
  double volume;
};

class TffdHandler {
 public:
  /// \throw Refusal bad_option
  explicit TffdHandler(Parameters parameters);

  /// A fit, on its way or ended, and what it is a fit of.
  using Join = ScanJoin<FitState, TriangleMesh, Landmarks, ControlMesh>;
  using Input = Join::Joined;
  template <typename Message>
  std::optional<Input> add(const boost::shared_ptr<const Message>& message) {
    return join_.add(message);
  }

  struct Output {
    FittedScan scan;  ///< `deformed` is what is new
    std::shared_ptr<const BoundBody> bound;
    Facts facts;
  };
  /// For one thread, which need not be that of add(). \throw Refusal as tffd::Binding
  Output handle(const Input& input);

 private:
  tffd::Options options_;
  Join join_;
  std::shared_ptr<const BoundBody> bound_;
};

}  // namespace tensegric_fit::node
