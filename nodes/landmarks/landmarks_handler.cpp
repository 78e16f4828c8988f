#include "landmarks/landmarks_handler.hpp"

#include <boost/make_shared.hpp>
#include <utility>

#include "body_model/missing_parts.hpp"
#include "body_model/model_message.hpp"
#include "body_model/registration.hpp"
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

body_model::RegisteredBody registered(const geometry::TriangleMesh& mesh, const std::vector<char>& filled,
                                      const BodyModel::ConstPtr& model) {
  const body_model::Registrar& registrar = body_model::shipped_registrar();
  if (!model) return body_model::register_mesh(registrar, mesh, filled);
  check_mesh_parts(*model, mesh.vertices.size());
  return registered_in(*model, registrar.shared_model());
}

}  // namespace

LandmarksHandler::LandmarksHandler(Parameters parameters)
    : body_frame_(parameters.frame("body_frame", "body")) {
  parameters.check_all_known();
  body_model::shipped_registrar();  // a broken file is refused now, not with the first scan
  landmarks::shipped_precision();
}

std::optional<LandmarksHandler::Input> LandmarksHandler::add(const TriangleMesh::ConstPtr& mesh) {
  alone_ = nullptr;
  return join_.add(mesh);
}

std::optional<LandmarksHandler::Input> LandmarksHandler::add(const BodyModel::ConstPtr& model) {
  if (std::optional<Input> joined = join_.add(model)) return joined;
  if (!alone_ || alone_->scan_id != model->scan_id) return std::nullopt;
  return Input{std::exchange(alone_, nullptr), model};
}

std::optional<LandmarksHandler::Input> LandmarksHandler::alone() {
  const TriangleMesh::ConstPtr mesh = join_.give_up();
  if (!mesh) return std::nullopt;
  BodyModel::ConstPtr& model = join_.newest<BodyModel>();
  if (model && model->header.stamp <= mesh->header.stamp) model.reset();  // of a scan before
  alone_ = mesh;
  return Input{mesh, nullptr};
}

LandmarksHandler::Output LandmarksHandler::handle(const Input& input) const {
  const TriangleMesh& message = *std::get<0>(input);
  Output output;
  output.mesh = mesh_in(message);
  const std::vector<char> filled = filled_in(message);
  const body_model::RegisteredBody model = registered(output.mesh, filled, std::get<1>(input));
  output.measures = landmarks::find_landmarks(output.mesh, filled, model, landmarks::shipped_precision());
  const std::vector<geometry::Missing> parts = body_model::missing_parts(model);
  output.measures.missing.insert(output.measures.missing.end(), parts.begin(), parts.end());
  if (!parts.empty())  // names of limbs do not go into logs
    output.warning = "missing_part: the body lacks parts, which its pictures and body/landmarks name.";
  geometry::doubt_fractured(fractures_in(message), output.measures);
  output.landmarks = boost::make_shared<Landmarks>(to_message(tag_in(message), output.measures));
  output.body_frame = transform_to(body_frame_, message.header, output.measures.body_from_scan);
  output.facts = {{"landmarks", std::to_string(output.measures.landmarks.size())},
                  {"body_model", std::get<1>(input) ? "came with the mesh" : "registered to the mesh"},
                  {"missing", std::to_string(output.measures.missing.size())}};
  return output;
}

}  // namespace tensegric_fit::node
