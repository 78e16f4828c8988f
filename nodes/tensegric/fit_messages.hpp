/// Messages of the garment and of the fit <-> core types.
#pragma once

#include <tensegric_fit/BandShapes.h>
#include <tensegric_fit/DeformedMesh.h>
#include <tensegric_fit/FitState.h>
#include <tensegric_fit/Garment.h>
#include <tensegric_fit/LineForces.h>
#include <tensegric_fit/MemberForces.h>
#include <tensegric_fit/SetGarment.h>

#include <optional>
#include <string>
#include <vector>

#include "geometry/posture.hpp"
#include "ros/scan_tag.hpp"
#include "tensegric/garment.hpp"
#include "tensegric/model.hpp"
#include "tensegric/solver.hpp"

namespace tensegric_fit::node {

/// A garment with the solver that it asks for, empty for the node's own.
struct GarmentRequest {
  tensegric::Garment garment;
  std::string solver;
  /// scan_id of the body that its lines by points lie on, empty for the next body; nothing: of no certain
  /// one, or without such lines.
  std::optional<std::string> of{};
};

Garment to_message(const std_msgs::Header& header, const GarmentRequest& request);

/// \throw Refusal bad_garment: values out of range or arrays that do not fit each other; bad_option: unknown
/// solver
GarmentRequest request_in(const Garment& message);

/// What a service call asks for, with its ratios put in. `folder` holds the shipped garments. \throw Refusal
/// as above, and unknown_line
GarmentRequest request_in(const SetGarment::Request& request, const std::string& folder);

/// What a fit is of: which scan, which garment, which solver, which posture.
struct FitName {
  ScanTag tag;
  std::string garment;
  tensegric::SolverName solver;
  geometry::Posture posture = {};
};

/// A fit that has ended.
FitState to_message(const FitName& name, const tensegric::Solution& solution, double milliseconds);

/// A fit on its way: status `solving`.
FitState to_message(const FitName& name, const tensegric::Iterate& iterate,
                    const std::vector<Eigen::Vector3d>& outer, const std::vector<Eigen::Vector3d>& inner,
                    double milliseconds);

/// Forces of the lines in a fit that has ended, as far as they were calibrated.
LineForces forces_message(const FitName& name, const tensegric::Solution& solution);

/// Where the bands of a fit that has ended lie. \pre fibres of a line have as many points at rest as worn
BandShapes bands_message(const FitName& name, const tensegric::Solution& solution);

/// Forces of the model's members in a fit that has ended.
MemberForces to_message(const ScanTag& tag, const std::string& garment, const tensegric::Model& model,
                        const tensegric::Solution& solution);

}  // namespace tensegric_fit::node
