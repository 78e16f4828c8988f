/// Bag in, bag out: sends each scan of a bag through a running chain and writes down what comes out.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/PointCloud2.h>

#include <filesystem>

#include "geometry/status.hpp"
#include "ros/export_fit.hpp"
#include "ros/parameters.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::node {
namespace {

const std::string kScanTopic = "scan/points";

struct Setup {
  std::string bag, out;
  double timeout = 120;  ///< seconds that a scan may take
};

Setup setup_from(const ros::NodeHandle& private_node) {
  Setup setup;
  Parameters parameters(private_node);
  setup.bag = parameters.text("bag", "");
  setup.out = parameters.text("out", "");
  setup.timeout = parameters.number("timeout", setup.timeout, 1, 86400);
  parameters.check_all_known();
  if (setup.out.empty() || std::filesystem::exists(setup.out))
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            "parameter 'out': '" + setup.out + "' is empty or there already");
  return setup;
}

bool ends_in(const std::string& topic, const std::string& ending) {
  return topic.size() >= ending.size() &&
         topic.compare(topic.size() - ending.size(), ending.size(), ending) == 0;
}

class Replay {
 public:
  explicit Replay(ros::NodeHandle node)
      : scans_(node.advertise<sensor_msgs::PointCloud2>(kScanTopic, 1, true)) {
    subscribers_ = {
        keep(node, "body/mesh", &FittedScan::body), keep(node, "body/landmarks", &FittedScan::landmarks),
        keep(node, "control/mesh", &FittedScan::control), keep(node, "control/deformed", &FittedScan::fit),
        keep(node, "body/deformed", &FittedScan::deformed)};
    diagnostics_ = node.subscribe("/diagnostics", 100, &Replay::on_diagnostics, this);
  }

  /// Waits until the whole chain is there. False: it did not come up.
  bool wait_for_chain(double timeout) {
    return wait(timeout, [this] {
      bool ready = scans_.getNumSubscribers() != 0;
      for (const ros::Subscriber& subscriber : subscribers_)
        ready = ready && subscriber.getNumPublishers() != 0;
      return ready;
    });
  }

  /// True once the scan went through or was refused; what came out is then in `out`, at `time`.
  bool send(const sensor_msgs::PointCloud2& scan, const ros::Time& time, double timeout, rosbag::Bag& out) {
    scan_id_ = tag_of(scan).scan_id;
    got_ = FittedScan();
    refused_ = nullptr;
    scans_.publish(scan);
    const bool ended = wait(timeout, [this] {
      return refused_ || (got_.body && got_.landmarks && got_.control && got_.fit && got_.deformed);
    });
    write(out, "body/mesh", time, got_.body);
    write(out, "body/landmarks", time, got_.landmarks);
    write(out, "control/mesh", time, got_.control);
    write(out, "control/deformed", time, got_.fit);
    write(out, "body/deformed", time, got_.deformed);
    write(out, "/diagnostics", time, refused_);
    ROS_INFO("replay: scan %s %s", scan_id_.c_str(), !ended ? "TIMED OUT" : refused_ ? "refused" : "fitted");
    return ended;
  }

 private:
  template <typename Message>
  ros::Subscriber keep(ros::NodeHandle& node, const std::string& topic,
                       boost::shared_ptr<const Message> FittedScan::*slot) {
    const boost::function<void(const boost::shared_ptr<const Message>&)> take =
        [this, slot](const boost::shared_ptr<const Message>& message) {
          if constexpr (std::is_same_v<Message, FitState>)
            if (message->status == FitState::SOLVING) return;
          if (message->scan_id == scan_id_) got_.*slot = message;
        };
    return node.subscribe<Message>(topic, 10, take);
  }

  void on_diagnostics(const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
    for (const diagnostic_msgs::DiagnosticStatus& status : message->status)
      for (const diagnostic_msgs::KeyValue& fact : status.values)
        if (fact.key == "last_error_scan_id" && fact.value == scan_id_) refused_ = message;
  }

  template <typename Condition>
  static bool wait(double timeout, Condition condition) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(timeout);
    while (ros::ok() && ros::WallTime::now() < end) {
      ros::spinOnce();
      if (condition()) return true;
      ros::WallDuration(0.01).sleep();
    }
    return false;
  }

  template <typename Message>
  static void write(rosbag::Bag& out, const std::string& topic, const ros::Time& time,
                    const boost::shared_ptr<const Message>& message) {
    if (message) out.write(topic, time, *message);
  }

  std::string scan_id_;
  FittedScan got_;
  diagnostic_msgs::DiagnosticArray::ConstPtr refused_;
  ros::Publisher scans_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Subscriber diagnostics_;
};

/// Number of scans that did not come through. \throw rosbag::BagException, Refusal
int run(const Setup& setup) {
  rosbag::Bag in(setup.bag, rosbag::bagmode::Read);
  rosbag::View view(in, rosbag::TypeQuery("sensor_msgs/PointCloud2"));
  const std::string unfinished = setup.out + ".active";
  rosbag::Bag out(unfinished, rosbag::bagmode::Write);
  Replay replay(ros::NodeHandle{});
  if (!replay.wait_for_chain(setup.timeout)) throw std::runtime_error("the chain did not come up");

  int sent = 0, lost = 0;
  for (const rosbag::MessageInstance& message : view) {
    if (!ends_in(message.getTopic(), kScanTopic)) continue;
    ++sent;
    if (!replay.send(*message.instantiate<sensor_msgs::PointCloud2>(), message.getTime(), setup.timeout, out))
      ++lost;
  }
  if (sent == 0)
    throw geometry::Refusal(geometry::refusal::kBrokenFile, "no scan/points in '" + setup.bag + "'");
  out.close();
  std::filesystem::rename(unfinished, setup.out);
  return lost;
}

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  ros::init(argc, argv, "replay");
  ros::NodeHandle private_node("~");
  try {
    return tensegric_fit::node::run(tensegric_fit::node::setup_from(private_node)) == 0 ? 0 : 1;
  } catch (const tensegric_fit::geometry::Refusal& refusal) {
    ROS_FATAL("replay: %s: %s", refusal.code().c_str(), refusal.what());
    return 2;
  } catch (const std::exception& error) {
    ROS_FATAL("replay: %s", error.what());
    return 1;
  }
}
