#include "ros/replay.hpp"

#include <tensegric_fit/SetGarment.h>

#include "ros/log_words.hpp"
#include "ros/scan_tag.hpp"
#include "ros/stage_report_message.hpp"
#include "ros/status_fact.hpp"

namespace tensegric_fit::node {
namespace {

constexpr double kFramePatience =
    1;  // s; tf has a connection of its own, and says nothing of a scan in `body`

template <typename Message>
void write(rosbag::Bag& out, const std::string& topic, const ros::Time& time,
           const boost::shared_ptr<const Message>& message) {
  if (message) out.write(topic, time, *message);
}

}  // namespace

Replay::Replay(ros::NodeHandle node, const Options& options)
    : options_(options),
      node_(node),
      scans_(node.advertise<sensor_msgs::PointCloud2>("scan/points", 1, true)),
      labels_(node.advertise<ScanLabel>("scan/label", 16, true)),
      set_garment_(node.serviceClient<SetGarment>("set_garment")),
      diagnostics_in_(node.subscribe("/diagnostics", 100, &Replay::on_diagnostics, this)),
      body_frame_in_(node.subscribe("/tf_static", 100, &Replay::on_tf, this)) {
  keep<BodyModel>("body/model", &Answer::model);
  keep<TriangleMesh>("body/mesh", &Answer::body);
  keep<Landmarks>("body/landmarks", &Answer::landmarks);
  last_stage_ = "landmarks";
  if (options.measure_only) return;
  worn_in_ = node_.subscribe<Garment>("garment", 10, [this](const Garment::ConstPtr& worn) { worn_ = worn; });
  keep<ControlMesh>("control/mesh", &Answer::control);
  keep<FitState>("control/deformed", &Answer::fit);
  keep<LineForces>("control/forces", &Answer::forces);
  keep<DeformedMesh>("body/deformed", &Answer::deformed);
  keep<FitWarnings>("body/warnings", &Answer::said);
  last_stage_ = "tffd";
}

template <typename Message>
void Replay::keep(const std::string& topic, boost::shared_ptr<const Message> Answer::*slot) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> take =
      [this, slot](const boost::shared_ptr<const Message>& message) {
        if constexpr (std::is_same_v<Message, FitState> || std::is_same_v<Message, DeformedMesh>)
          if (message->status == FitState::SOLVING) return;
        if (message->scan_id == scan_id_) got_.*slot = message;
      };
  subscribers_.push_back(node_.subscribe<Message>(topic, 10, take));
}

void Replay::on_diagnostics(const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
  for (const diagnostic_msgs::DiagnosticStatus& status : message->status) {
    const auto report = stage_report_in(status, node_.getNamespace());
    if (!report) continue;  // another booth's
    diagnostics_[report->stage] = message;
    if (scan_id_.empty()) continue;
    // The last error stays with a stage: of a garment after others it says nothing.
    if ((report->refused() && report->scan_id == scan_id_) ||
        (!went_through_ && fact(status, "last_error_scan_id") == scan_id_))
      refused_ = true;
  }
}

void Replay::on_tf(const tf2_msgs::TFMessage::ConstPtr& message) {
  if (!message->transforms.empty() && message->transforms.front().header.stamp == scan_stamp_)
    body_frame_ = message;
}

bool Replay::wait(const std::function<bool()>& condition, double seconds) const {
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(seconds);
  while (ros::ok() && ros::SteadyTime::now() < end) {
    ros::spinOnce();
    if (condition()) return true;
    ros::WallDuration(0.005).sleep();
  }
  return false;
}

std::vector<std::string> Replay::wait_for_chain() {
  std::vector<std::string> missing;
  wait([&] {
    missing.clear();
    if (scans_.getNumSubscribers() == 0) missing.push_back(scans_.getTopic());
    for (const ros::Subscriber& subscriber : subscribers_)
      if (subscriber.getNumPublishers() == 0) missing.push_back(subscriber.getTopic());
    if (!options_.measure_only && !set_garment_.exists()) missing.push_back(set_garment_.getService());
    return missing.empty();
  });
  return missing;
}

/// Everything is there, and the last stage has said what it took.
bool Replay::answered() const {
  if (refused_) return true;
  const bool fitted = got_.control && got_.fit && got_.forces && got_.deformed && got_.said;
  if (!got_.model || !got_.body || !got_.landmarks || (!options_.measure_only && !fitted)) return false;
  const auto last = diagnostics_.find(last_stage_);
  return last != diagnostics_.end() && fact(last->second->status.front(), "state") == "done" &&
         fact(last->second->status.front(), "scan_id") == scan_id_;
}

void Replay::write_input(const Garment& garment, const ros::Time& time, rosbag::Bag& out) const {
  Garment asked = garment;
  asked.header = {};
  asked.header.stamp = time;  // not when it was asked for here: the same bag in, the same bag out
  out.write("garment", time, asked);
}

void Replay::write_answer(const ros::Time& time, rosbag::Bag& out, bool whole) {
  if (whole) {
    write(out, "body/model", time, got_.model);
    write(out, "body/mesh", time, got_.body);
    write(out, "body/landmarks", time, got_.landmarks);
    write(out, "/tf_static", time, body_frame_);
    write(out, "control/mesh", time, got_.control);
  }
  write(out, "control/deformed", time, got_.fit);
  write(out, "control/forces", time, got_.forces);
  write(out, "body/deformed", time, got_.deformed);
  write(out, "body/warnings", time, got_.said);
  for (const auto& [stage, message] : diagnostics_) write(out, "/diagnostics", time, message);
}

bool Replay::send(const sensor_msgs::PointCloud2& scan, const ros::Time& time, rosbag::Bag& out) {
  scan_id_ = tag_of(scan).scan_id;
  scan_stamp_ = scan.header.stamp;
  body_frame_ = nullptr;
  got_ = Answer();
  refused_ = went_through_ = false;
  scans_.publish(scan);
  const bool ended = wait([this] { return answered(); });
  if (worn_) write_input(*worn_, time, out);
  out.write("scan/points", time, scan);
  if (got_.landmarks) wait([this] { return body_frame_ != nullptr; }, kFramePatience);
  write_answer(time, out, true);
  went_through_ = ended && !refused_;
  ROS_INFO("replay: scan %s %s", scan_id_.c_str(),
           !ended     ? "TIMED OUT"
           : refused_ ? "refused"
                      : "went through");
  return ended;
}

void Replay::send(const ScanLabel& label, const ros::Time& time, rosbag::Bag& out) {
  labels_.publish(label);
  out.write("scan/label", time, label);
}

bool Replay::send(const Garment& garment, const ros::Time& time, rosbag::Bag& out) {
  if (options_.measure_only) return true;  // nothing is asked for, and nothing is lost
  ros::spinOnce();                         // what was said of the garment before
  got_.fit = nullptr;
  got_.forces = nullptr;
  got_.deformed = nullptr;
  got_.said = nullptr;
  refused_ = false;
  SetGarment call;
  call.request.garment = garment;
  if (!set_garment_.call(call) || !call.response.accepted) {
    ROS_ERROR("replay: garment '%s': %s: %s", garment.name.c_str(), call.response.code.c_str(),
              log_words(call.response.message).c_str());
    return false;
  }
  if (!went_through_) return true;
  write_input(garment, time, out);
  const bool ended = wait([this] { return answered(); });
  write_answer(time, out, false);
  ROS_INFO("replay: garment '%s' %s", garment.name.c_str(), ended ? "worn" : "TIMED OUT");
  return ended;
}

}  // namespace tensegric_fit::node
