/// Clouds of a booth's sensors -> scan/points
#include <fmt/format.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <mutex>

#include "assembler/assembler_handler.hpp"
#include "assembler/capture_queue.hpp"
#include "ros/held_scan.hpp"
#include "ros/run_node.hpp"
#include "ros/scan_tag.hpp"
#include "ros/stage.hpp"

namespace tensegric_fit::node {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

/// Before it is assembled, a scan is known by its stamp.
std::string id_of(std::uint64_t stamp) {
  return fmt::format("{}.{:09}", stamp / 1000000000, stamp % 1000000000);
}

/// What is to be said of a scan that came out.
std::string warning_of(const assembler::CaptureTurn& turn, const AssemblerHandler::Output& output) {
  std::vector<std::string> parts;
  if (!turn.warning.empty()) parts.push_back(turn.warning);
  if (turn.left_out > 0)
    parts.push_back(
        fmt::format("sensors send faster than a scan is assembled: {} left out",
                    turn.left_out == 1 ? "1 capture was" : fmt::format("{} captures were", turn.left_out)));
  if (!output.warning.empty()) parts.push_back(output.warning);
  return fmt::format("{}", fmt::join(parts, "; "));
}

class AssemblerNode {
 public:
  AssemblerNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : node_(node),
        handler_(Parameters(private_node)),
        listener_(transforms_),
        scan_(advertised()),
        stage_("assembler", node) {
    constexpr int kQueue = 4;
    const std::vector<std::string>& topics = handler_.setup().sensors;
    for (std::size_t sensor = 0; sensor < topics.size(); ++sensor)
      sensors_.push_back(node.subscribe<sensor_msgs::PointCloud2>(
          topics[sensor], kQueue, [this, sensor](const sensor_msgs::PointCloud2::ConstPtr& cloud) {
            on_cloud(static_cast<int>(sensor), *cloud);
          }));
    clock_ = node.createWallTimer(ros::WallDuration(std::min(0.05, handler_.setup().capture.timeout / 4)),
                                  [this](const ros::WallTimerEvent&) { hand_on(); });
  }

  /// If this node restarted, what sensors latch would be assembled again.
  void forget(const ForgetOrder& order, ForgetAnswer& done) {
    HeldScan::of_process().forget(order.scan_id.substr(0, order.scan_id.rfind('-')));  // as id_of
    const std::lock_guard<std::mutex> lock(publishing_);
    if (published_ != order.scan_id) return;
    scan_.shutdown();
    scan_ = advertised();
    published_.clear();
    done.removed = {"the latched scan/points"};
  }

 private:
  ros::Publisher advertised() { return node_.advertise<sensor_msgs::PointCloud2>("scan/points", 1, true); }

  void publish(const sensor_msgs::PointCloud2::ConstPtr& scan) {
    const std::lock_guard<std::mutex> lock(publishing_);
    scan_.publish(scan);
    published_ = tag_of(*scan).scan_id;
  }

  void on_cloud(int sensor, const sensor_msgs::PointCloud2& message) {
    try {
      handler_.add(sensor, message, ros::SteadyTime::now().toSec());
    } catch (const Refusal& refused) {
      stage_.drop(id_of(message.header.stamp.toNSec()), refused);
    } catch (const std::exception& error) {  // memory ran out
      stage_.drop(id_of(message.header.stamp.toNSec()), Refusal("internal_error", error.what()));
    }
    hand_on();
  }

  void hand_on() {
    while (const std::optional<assembler::Capture> capture = handler_.next(ros::SteadyTime::now().toSec())) {
      take(*capture);
      start_next();
    }
    start_next();  // what waited while another was assembled
  }

  void take(const assembler::Capture& capture) {
    const AssemblerHandler::Setup& setup = handler_.setup();
    const auto named = [&setup](const std::vector<int>& sensors) {
      std::vector<std::string> names;
      for (const int sensor : sensors) names.push_back(setup.sensors[sensor]);
      return fmt::format("{}", fmt::join(names, ", "));
    };
    const std::vector<int> missing = capture.missing(), blind = capture.blind();
    const std::size_t came = setup.sensors.size() - missing.size();
    std::vector<std::string> parts;
    if (!missing.empty() && !capture.is_stray)
      parts.push_back(fmt::format("{} of {} sensors came in time; missing: {}", came, setup.sensors.size(),
                                  named(missing)));
    if (!blind.empty() && !capture.is_stray) parts.push_back(named(blind) + " saw nothing");
    for (const assembler::OtherClock& clock : capture.other_clocks)
      parts.push_back(words_of(clock, setup.sensors));
    const std::string warning = fmt::format("{}", fmt::join(parts, "; "));
    if (capture.is_stray) return stage_.drop(id_of(capture.first), Refusal(refusal::kMissingSensor, warning));
    const bool are_all_blind = blind.size() == came;  // refused as such by assembler::assemble
    const int counted = are_all_blind ? static_cast<int>(came) : capture.seeing();
    if (counted < setup.capture.min_sensors)
      return stage_.refuse(id_of(capture.first), Refusal(refusal::kMissingSensor, warning));
    const std::shared_ptr<const assembler::CaptureTurn> replaced = queue_.put(capture, warning);
    if (!replaced) return;
    const std::string scan_id = id_of(replaced->capture.first);
    stage_.drop(scan_id,
                Refusal(refusal::kSuperseded,
                        fmt::format("capture {}: a newer one came before it was assembled", scan_id)));
  }

  /// The work holds the turn, whatever its end: the stage lets go of both once it has published or refused.
  void start_next() {
    const std::shared_ptr<const assembler::CaptureTurn> turn = queue_.next();
    if (!turn) return;
    const std::string scan_id = id_of(turn->capture.first);
    stage_.begin(scan_id);
    stage_.post(scan_id, [this, turn]() -> Stage::Result {
      wait_for_transforms(turn->capture);
      const AssemblerHandler::Output output = handler_.handle(turn->capture, transforms_);
      return {[this, output] { publish(output.scan); }, output.facts, warning_of(*turn, output)};
    });
  }

  /// They can come after the clouds. By a clock of its own: a recording's can stand still, the wall's jump.
  void wait_for_transforms(const assembler::Capture& capture) const {
    const AssemblerHandler::Setup& setup = handler_.setup();
    const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(setup.capture.timeout);
    const auto can_come =
        [](const std::string& frame) {  // tf logs a warning each time it is asked for another
          return !frame.empty() && frame.front() != '/';
        };
    for (const auto& cloud : capture.clouds)
      while (cloud && can_come(cloud->frame_id) &&
             !transforms_.canTransform(setup.frame_id, cloud->frame_id, time_of(cloud->stamp)) &&
             ros::SteadyTime::now() < end && ros::ok())
        ros::WallDuration(0.01).sleep();
  }

  ros::NodeHandle node_;
  AssemblerHandler handler_;
  assembler::CaptureQueue queue_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener listener_;
  std::mutex publishing_;  // guards the next two
  ros::Publisher scan_;
  std::string published_;
  std::vector<ros::Subscriber> sensors_;
  ros::WallTimer clock_;
  Stage stage_;  // last: its worker uses all of the above
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::AssemblerNode>(argc, argv, "assembler");
}
