#include "chain_client.hpp"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "ros/scan_tag.hpp"

namespace tensegric_fit::tests {
namespace {

template <typename Message>
ros::Subscriber collect(ros::NodeHandle& node, const std::string& topic,
                        std::vector<boost::shared_ptr<const Message>>& messages) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> take =
      [&messages](const boost::shared_ptr<const Message>& message) {
        if constexpr (std::is_same_v<Message, FitState> || std::is_same_v<Message, DeformedMesh>)
          if (message->status == FitState::SOLVING) return;
        messages.push_back(message);
      };
  return node.subscribe<Message>(topic, 100, take);
}

}  // namespace

bool wait_for(const std::function<bool()>& condition, double seconds) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
  while (ros::ok() && ros::WallTime::now() < end) {
    ros::spinOnce();
    if (condition()) return true;
    ros::WallDuration(0.01).sleep();
  }
  return false;
}

void listen(double seconds) {
  wait_for([] { return false; }, seconds);
}

sensor_msgs::PointCloud2 booth_scan(const std::string& body) {
  static std::uint32_t second = 1000;
  rosbag::Bag bag(std::string(TENSEGRIC_FIT_SCANS) + "/" + body + "/scan.bag");
  rosbag::View view(bag, rosbag::TypeQuery("sensor_msgs/PointCloud2"));
  sensor_msgs::PointCloud2 scan = *view.begin()->instantiate<sensor_msgs::PointCloud2>();
  scan.header.stamp = ros::Time(++second, 0);
  return scan;
}

ChainClient::ChainClient() : scans_(node_.advertise<sensor_msgs::PointCloud2>("scan/points", 4)) {
  subscribers_ = {collect(node_, "body/model", models),
                  collect(node_, "body/mesh", bodies),
                  collect(node_, "body/landmarks", landmarks),
                  collect(node_, "control/mesh", controls),
                  collect(node_, "control/deformed", fits),
                  collect(node_, "control/forces", forces),
                  collect(node_, "body/deformed", deformed),
                  node_.subscribe("/diagnostics", 1000, &ChainClient::on_diagnostics, this)};
}

bool ChainClient::ready() {
  return wait_for([this] {
    bool complete = scans_.getNumSubscribers() != 0 && diagnostics.size() >= 5;
    for (const ros::Subscriber& subscriber : subscribers_)
      complete = complete && subscriber.getNumPublishers() != 0;
    return complete;
  });
}

std::string ChainClient::send(const sensor_msgs::PointCloud2& scan) {
  scans_.publish(scan);
  return node::tag_of(scan).scan_id;
}

std::string ChainClient::fit(const sensor_msgs::PointCloud2& scan) {
  const std::string scan_id = send(scan);
  return wait_for([&] { return count_of(deformed, scan_id) != 0; }) ? scan_id : "";
}

std::string ChainClient::refusal_of(const std::string& scan_id) const {
  for (const auto& [stage, facts] : diagnostics)
    if (facts.at("last_error_scan_id") == scan_id) return facts.at("last_error");
  return "";
}

void ChainClient::forget() {
  models.clear();
  bodies.clear();
  landmarks.clear();
  controls.clear();
  fits.clear();
  forces.clear();
  deformed.clear();
}

void ChainClient::on_diagnostics(const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
  for (const diagnostic_msgs::DiagnosticStatus& status : message->status) {
    diagnostics[status.name]["level"] = std::to_string(status.level);
    for (const diagnostic_msgs::KeyValue& fact : status.values)
      diagnostics[status.name][fact.key] = fact.value;
  }
}

}  // namespace tensegric_fit::tests
