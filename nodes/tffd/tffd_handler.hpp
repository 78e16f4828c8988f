/// body/mesh + body/landmarks + control/mesh + control/deformed -> body/deformed, body/warnings
#pragma once

#include <tensegric_fit/FitWarnings.h>

#include <memory>
#include <optional>

#include "geometry/posture.hpp"
#include "ros/export_fit.hpp"
#include "ros/facts.hpp"
#include "ros/fit_figures.hpp"
#include "ros/parameters.hpp"
#include "ros/scan_join.hpp"
#include "tffd/binding.hpp"
#include "tffd/under_constriction.hpp"

namespace tensegric_fit::node {

/// A body bound to its control mesh: what a change of garment does not touch.
struct BoundBody {
  TriangleMesh::ConstPtr body;
  ControlMesh::ConstPtr control;
  geometry::TriangleMesh mesh;
  geometry::ControlMesh control_mesh;
  geometry::BodyMeasures measures;
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

  const ExportOptions& exports() const { return exports_; }

  struct Output {
    FittedScan scan;  ///< `deformed` and `warnings` are what is new
    std::shared_ptr<const BoundBody> bound;
    FitWarnings::ConstPtr warnings;  ///< none of a fit on its way
    Facts facts;
  };
  /// For one thread, which need not be that of add(). \throw Refusal as tffd::Binding
  Output handle(const Input& input);

 private:
  tffd::Options options_;
  ExportOptions exports_;
  tffd::HoldOptions hold_;
  Join join_;
  std::shared_ptr<const BoundBody> bound_;
};

}  // namespace tensegric_fit::node
