/// body/mesh + body/model -> body/landmarks, and where the body's frame lies in the scan's for tf
#pragma once

#include <tensegric_fit/BodyModel.h>
#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/TriangleMesh.h>
#include <tf2_msgs/TFMessage.h>

#include <optional>
#include <string>

#include "geometry/body_measures.hpp"
#include "geometry/triangle_mesh.hpp"
#include "landmarks/find_landmarks.hpp"
#include "ros/facts.hpp"
#include "ros/parameters.hpp"
#include "ros/scan_join.hpp"

namespace tensegric_fit::node {

/// A mesh of a reconstruction comes with its registered model. One that comes alone, from elsewhere or from
/// an old bag, has the model registered to it here, once it has waited for kPatience; if its model comes
/// later, it is measured once more.
class LandmarksHandler {
 public:
  static constexpr double kPatience = 3;  ///< seconds; the two leave the reconstruction within milliseconds

  /// \throw Refusal bad_option, broken_file: body model or precision
  explicit LandmarksHandler(Parameters parameters);

  /// Mesh and model of one scan; the model is null where none came.
  using Input = ScanJoin<TriangleMesh, BodyModel>::Joined;
  std::optional<Input> add(const TriangleMesh::ConstPtr& mesh);
  std::optional<Input> add(const BodyModel::ConstPtr& model);
  /// The mesh that waits for its model, if any, without one.
  std::optional<Input> alone();

  struct Output {
    Landmarks::ConstPtr landmarks;
    tf2_msgs::TFMessage::ConstPtr body_frame;  ///< null where the scan's own frame has the same name
    geometry::TriangleMesh mesh;
    geometry::BodyMeasures measures;
    Facts facts;
    std::string warning;  ///< `missing_part`, where parts of the body are missing, or empty
  };
  /// \throw Refusal as mesh_in, registered_in, register_mesh, find_landmarks
  Output handle(const Input& input) const;

  const std::string& body_frame() const { return body_frame_; }

 private:
  std::string body_frame_;
  ScanJoin<TriangleMesh, BodyModel> join_;
  TriangleMesh::ConstPtr alone_;  // the newest mesh, where it went without its model
};

}  // namespace tensegric_fit::node
