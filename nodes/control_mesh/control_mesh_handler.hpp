/// body/mesh + body/landmarks + body/model -> control/mesh, control/coarse
#pragma once

#include <tensegric_fit/BodyModel.h>
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

  /// Landmarks and body of one scan, and its model, which comes before the landmarks that are found by it;
  /// null where none came.
  struct Input {
    Landmarks::ConstPtr landmarks;
    TriangleMesh::ConstPtr mesh;
    BodyModel::ConstPtr model;
  };
  std::optional<Input> add(const Landmarks::ConstPtr& landmarks) { return with_model(join_.add(landmarks)); }
  std::optional<Input> add(const TriangleMesh::ConstPtr& mesh) { return with_model(join_.add(mesh)); }
  void add(const BodyModel::ConstPtr& model) { model_ = model; }

  struct Output {
    ControlMesh::ConstPtr control;
    ControlMesh::ConstPtr coarse;  ///< of the same body, for a first answer; null where none is asked for
    geometry::TriangleMesh body;
    geometry::ControlMesh control_mesh;
    Eigen::Isometry3d body_from_scan;
    std::string left_out;  ///< regions that this body lacks, each with the reason; empty: none
    Facts facts;
  };
  /// A mesh that came without its model has one registered to it; a shape that refuses it goes without.
  /// \throw Refusal as fit_template: no region is left; as registered_in
  Output handle(const Input& input) const;

 private:
  using Join = ScanJoin<Landmarks, TriangleMesh>;
  std::optional<Input> with_model(const std::optional<Join::Joined>& joined);

  std::vector<control_mesh::Options> options_{1};  // of control/mesh; of control/coarse, where there is one
  std::vector<control_mesh::Template> patterns_;
  Join join_;
  BodyModel::ConstPtr model_;  // the newest
};

}  // namespace tensegric_fit::node
