#include "recording.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <memory>

namespace tensegric_fit::regression {
namespace {

class Digest {
 public:
  Digest() { EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr); }

  template <typename Message>
  void add(Message message) {
    if constexpr (std::is_same_v<Message, tf2_msgs::TFMessage>)
      for (auto& transform : message.transforms) transform.header.seq = 0;
    else
      message.header.seq = 0;
    if constexpr (std::is_same_v<Message, FitState>) message.milliseconds = 0;
    std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    ros::serialization::serialize(stream, message);
    EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size());
  }

  std::string text() const {
    unsigned char bytes[EVP_MAX_MD_SIZE];
    unsigned int count = 0;
    EVP_DigestFinal_ex(context_.get(), bytes, &count);
    return fmt::format("{:02x}", fmt::join(bytes, bytes + count, ""));
  }

 private:
  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_{EVP_MD_CTX_new(), EVP_MD_CTX_free};
};

template <typename Message>
std::string hash_of(const std::vector<boost::shared_ptr<const Message>>& messages) {
  Digest digest;
  for (const auto& message : messages) digest.add(*message);
  return digest.text();
}

template <typename Message>
void keep(const rosbag::MessageInstance& instance, const std::string& scan_id,
          std::vector<boost::shared_ptr<const Message>>& messages) {
  const boost::shared_ptr<const Message> message = instance.instantiate<Message>();
  if (!message || message->scan_id != scan_id) return;
  if constexpr (std::is_same_v<Message, FitState> || std::is_same_v<Message, DeformedMesh>)
    if (message->status == FitState::SOLVING) return;
  messages.push_back(message);
}

template <typename Message>
void keep(const rosbag::MessageInstance& instance, const std::string& scan_id,
          boost::shared_ptr<const Message>& message) {
  std::vector<boost::shared_ptr<const Message>> messages;
  keep(instance, scan_id, messages);
  if (!messages.empty()) message = messages.front();
}

void keep(const diagnostic_msgs::DiagnosticStatus& status, Recording& recording) {
  std::map<std::string, std::string> facts;
  for (const diagnostic_msgs::KeyValue& fact : status.values) facts[fact.key] = fact.value;
  const std::string stage = status.name.substr(status.name.rfind(' ') + 1);
  if (facts["last_error_scan_id"] == recording.scan_id) {
    recording.refused_by = stage;
    recording.refusal = facts["last_error"];
  } else if (facts["scan_id"] == recording.scan_id && facts["state"] == "done") {
    recording.milliseconds[stage] = std::stod(facts["milliseconds"]);
    recording.peak_mebibytes[stage] = std::stod(facts["peak_mebibytes"]);
  }
}

}  // namespace

std::string chain_topic(const std::string& topic) {
  const std::string slashed = topic.front() == '/' ? topic : "/" + topic;
  for (const std::string& known : kChainTopics) {
    const std::string ending = known.front() == '/' ? known : "/" + known;
    if (slashed.size() >= ending.size() &&
        slashed.compare(slashed.size() - ending.size(), ending.size(), ending) == 0)
      return known;
  }
  return "";
}

std::pair<ros::Time, ros::Time> times_of(const std::string& path) {
  const rosbag::Bag bag(path);
  rosbag::View view(bag);
  return {view.getBeginTime(), view.getEndTime()};
}

std::map<std::string, std::string> hashes_of(const Recording& recording) {
  std::map<std::string, std::string> hashes;
  if (recording.scan) hashes["scan/points"] = hash_of<sensor_msgs::PointCloud2>({recording.scan});
  if (recording.body_frame) hashes["/tf_static"] = hash_of<tf2_msgs::TFMessage>({recording.body_frame});
  if (recording.model) hashes["body/model"] = hash_of<BodyModel>({recording.model});
  if (recording.body) hashes["body/mesh"] = hash_of<TriangleMesh>({recording.body});
  if (recording.landmarks) hashes["body/landmarks"] = hash_of<Landmarks>({recording.landmarks});
  if (recording.control) hashes["control/mesh"] = hash_of<ControlMesh>({recording.control});
  if (!recording.fits.empty()) hashes["control/deformed"] = hash_of(recording.fits);
  if (!recording.forces.empty()) hashes["control/forces"] = hash_of(recording.forces);
  if (!recording.deformed.empty()) hashes["body/deformed"] = hash_of(recording.deformed);
  if (!recording.warnings.empty()) hashes["body/warnings"] = hash_of(recording.warnings);
  return hashes;
}

Recording recording_in(const std::string& path, const std::string& scan_id) {
  Recording recording;
  recording.scan_id = scan_id;
  const rosbag::Bag bag(path);
  rosbag::View view(bag);
  for (const rosbag::MessageInstance& message : view) {
    const std::string topic = chain_topic(message.getTopic());
    if (topic == "body/model") keep(message, scan_id, recording.model);
    if (topic == "body/mesh") keep(message, scan_id, recording.body);
    if (topic == "body/landmarks") keep(message, scan_id, recording.landmarks);
    if (topic == "control/mesh") keep(message, scan_id, recording.control);
    if (topic == "control/deformed") keep(message, scan_id, recording.fits);
    if (topic == "control/forces") keep(message, scan_id, recording.forces);
    if (topic == "body/deformed") keep(message, scan_id, recording.deformed);
    if (topic == "body/warnings") keep(message, scan_id, recording.warnings);
    if (topic == "/tf_static") recording.body_frame = message.instantiate<tf2_msgs::TFMessage>();
    const auto diagnostics = message.instantiate<diagnostic_msgs::DiagnosticArray>();
    if (diagnostics)
      for (const diagnostic_msgs::DiagnosticStatus& status : diagnostics->status) keep(status, recording);
  }
  return recording;
}

void append(const Recording& recording, const std::string& path) {
  const ros::Time time = times_of(path).second + ros::Duration(1);
  rosbag::Bag bag(path, rosbag::bagmode::Append);
  const auto write = [&](const std::string& topic, const auto& message) {
    if (message) bag.write(topic, time, *message);
  };
  write("scan/points", recording.scan);
  write("body/model", recording.model);
  write("body/mesh", recording.body);
  write("body/landmarks", recording.landmarks);
  write("/tf_static", recording.body_frame);
  write("control/mesh", recording.control);
  for (std::size_t i = 0; i < recording.fits.size(); ++i) {
    write("control/deformed", recording.fits[i]);
    if (i < recording.forces.size()) write("control/forces", recording.forces[i]);
    if (i < recording.deformed.size()) write("body/deformed", recording.deformed[i]);
    if (i < recording.warnings.size()) write("body/warnings", recording.warnings[i]);
  }
}

}  // namespace tensegric_fit::regression
