/// body/mesh -> body/landmarks, and where the body's frame lies in the scan's for tf
#pragma once

#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/TriangleMesh.h>
#include <tf2_msgs/TFMessage.h>

#include <string>

#include "geometry/body_measures.hpp"
#include "geometry/triangle_mesh.hpp"
#include "landmarks/find_landmarks.hpp"
#include "ros/facts.hpp"
#include "ros/parameters.hpp"

namespace tensegric_fit::node {

class LandmarksHandler {
 public:
  /// \throw Refusal bad_option
  explicit LandmarksHandler(Parameters parameters);

  struct Output {
    Landmarks::ConstPtr landmarks;
    tf2_msgs::TFMessage::ConstPtr body_frame;  ///< null where the scan's own frame has the same name
    geometry::TriangleMesh mesh;
    geometry::BodyMeasures measures;
    Facts facts;
  };
  /// \throw Refusal as find_landmarks
  Output handle(const TriangleMesh& mesh) const;

  const std::string& body_frame() const { return body_frame_; }

 private:
  std::string body_frame_;
};

}  // namespace tensegric_fit::node
