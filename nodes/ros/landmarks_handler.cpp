#include "ros/landmarks_handler.hpp"

#include <boost/make_shared.hpp>

#include "ros/body_messages.hpp"
#include "ros/transform_message.hpp"

namespace tensegric_fit::node {
namespace {

tf2_msgs::TFMessage::ConstPtr transform_to(const std::string& body_frame, const std_msgs::Header& header,
                                           const Eigen::Isometry3d& body_from_scan) {
  if (header.frame_id == body_frame) return nullptr;  // tf knows no frame within itself
  const auto message = boost::make_shared<tf2_msgs::TFMessage>();
  message->transforms.emplace_back();
  message->transforms.back().header = header;
  message->transforms.back().child_frame_id = body_frame;
  message->transforms.back().transform = transform_of(body_from_scan.inverse());
  return message;
}

}  // namespace

LandmarksHandler::LandmarksHandler(Parameters parameters)
    : body_frame_(parameters.frame("body_frame", "body")) {
  parameters.check_all_known();
}

LandmarksHandler::Output LandmarksHandler::handle(const TriangleMesh& message) const {
  Output output;
  output.mesh = mesh_in(message);
  output.measures = landmarks::find_landmarks(output.mesh, filled_in(message), {});
  geometry::doubt_fractured(fractures_in(message), output.measures);
  output.landmarks = boost::make_shared<Landmarks>(to_message(tag_in(message), output.measures));
  output.body_frame = transform_to(body_frame_, message.header, output.measures.body_from_scan);
  output.facts = {{"landmarks", std::to_string(output.measures.landmarks.size())}};
  return output;
}

}  // namespace tensegric_fit::node
