/// body/mesh + body/landmarks -> control/mesh
#pragma once

#include <tensegric_fit/ControlMesh.h>
#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/TriangleMesh.h>

#include <optional>
#include <string>
#include <vector>

#include "control_mesh/fit_template.hpp"
#include "ros/facts.hpp"
#include "ros/parameters.hpp"
#include "ros/scan_join.hpp"

namespace tensegric_fit::node {

class ControlMeshHandler {
 public:
  /// \throw Refusal bad_option, bad_template
  explicit ControlMeshHandler(Parameters parameters);

  /// Landmarks and body of one scan.
  using Input = ScanJoin<Landmarks, TriangleMesh>::Joined;
  std::optional<Input> add(const Landmarks::ConstPtr& landmarks) { return join_.add(landmarks); }
  std::optional<Input> add(const TriangleMesh::ConstPtr& mesh) { return join_.add(mesh); }

  struct Output {
    ControlMesh::ConstPtr control;
    geometry::TriangleMesh body;
    geometry::ControlMesh control_mesh;
    Eigen::Isometry3d body_from_scan;
    std::string left_out;  ///< regions that this body lacks, each with the reason; empty: none
    Facts facts;
  };
  /// \throw Refusal as fit_template: no region is left
  Output handle(const Input& input) const;

 private:
  control_mesh::Options options_;
  std::vector<control_mesh::Template> patterns_;
  ScanJoin<Landmarks, TriangleMesh> join_;
};

}  // namespace tensegric_fit::node
