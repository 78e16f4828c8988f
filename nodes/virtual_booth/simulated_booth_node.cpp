/// simulated_booth: customers drawn at random, as a booth of twelve sensors or of depth cameras sees them.
/// For trying everything without a booth.
#include <fmt/format.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>

#include <optional>

#include "geometry/scan_stamp.hpp"
#include "geometry/slop.hpp"
#include "ros/parameters.hpp"
#include "ros/run_node.hpp"
#include "virtual_booth/random_body.hpp"
#include "virtual_booth/sensor_messages.hpp"

namespace tensegric_fit::node {
namespace {

constexpr int kColumns = 4;
constexpr int kSensors = 12;  // four columns of three, as launch/config/booth.yaml lists them
constexpr int kMostCameras = 16;

struct Setup {
  virtual_booth::Family family;
  int first, customers, points, silent, cameras;
  double interval;
  std::string frame_id, sensor_frames;
};

Setup setup_from(Parameters parameters) {
  Setup setup;
  setup.family = virtual_booth::family_named(
      parameters.choice("family", virtual_booth::families().front(), virtual_booth::families()));
  setup.first = parameters.integer("first_customer", 1, {0, 1000000});
  setup.customers = parameters.integer("customers", 3, {0, 1000000});
  setup.points = parameters.integer("points", 180000, {20000, 2000000});
  setup.silent = parameters.integer("silent_sensor", -1, {-1, kMostCameras - 1});
  setup.cameras = parameters.integer("depth_cameras", 0, {0, kMostCameras});
  setup.interval = parameters.number("interval", 15, {0, 86400});
  setup.frame_id = parameters.frame("frame_id", "booth");
  setup.sensor_frames = parameters.frame("sensor_frames", "sensor_");
  parameters.check_all_known();
  if (setup.cameras % kColumns != 0)
    throw geometry::Refusal(
        geometry::refusal::kBadOption,
        fmt::format("parameter 'depth_cameras' is {}: they stand on {} columns", setup.cameras, kColumns));
  if (const int sensors = setup.cameras > 0 ? setup.cameras : kSensors; setup.silent >= sensors)
    throw geometry::Refusal(
        geometry::refusal::kBadOption,
        fmt::format("parameter 'silent_sensor' is {}: there are 0 to {}", setup.silent, sensors - 1));
  return setup;
}

class SimulatedBooth {
 public:
  SimulatedBooth(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : setup_(setup_from(Parameters(private_node))),
        node_(node),
        next_(setup_.first),
        poses_(node.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true)),
        service_(node.advertiseService("scan", &SimulatedBooth::on_scan, this)) {
    advertise();
    clock_ = node.createWallTimer(ros::WallDuration(0.2), [this](const ros::WallTimerEvent&) { go_on(); });
  }

  /// Which customers come, and when, stays as it is.
  void forget(const ForgetOrder& order, ForgetAnswer& done) {
    const auto stamp = geometry::stamp_in(order.scan_id);
    if (!stamp || !latched_ || geometry::gap(*stamp, *latched_) > kOneScan) return;
    for (std::vector<ros::Publisher>* publishers : {&sensors_, &lenses_}) {
      for (ros::Publisher& publisher : *publishers) publisher.shutdown();
      publishers->clear();
    }
    advertise();
    latched_.reset();
    done.removed = {setup_.cameras > 0 ? "the latched depth images" : "the latched clouds of its sensors"};
  }

 private:
  /// Latched: an assembler that is started again finds the capture that it was at.
  void advertise() {
    for (int sensor = 0; setup_.cameras == 0 && sensor < kSensors; ++sensor)
      sensors_.push_back(
          node_.advertise<sensor_msgs::PointCloud2>(fmt::format("sensors/{}/points", sensor), 1, true));
    for (int camera = 0; camera < setup_.cameras; ++camera) {
      sensors_.push_back(
          node_.advertise<sensor_msgs::Image>(fmt::format("cameras/{}/image", camera), 1, true));
      lenses_.push_back(
          node_.advertise<sensor_msgs::CameraInfo>(fmt::format("cameras/{}/camera_info", camera), 1, true));
    }
  }

  void go_on() {
    const double now = ros::SteadyTime::now().toSec();
    if (next_ >= setup_.first + setup_.customers || now < due_ || sensors_.back().getNumSubscribers() == 0)
      return;
    due_ = now + setup_.interval;
    scan(next_++);
  }

  bool on_scan(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    response.message = fmt::format("scanned customer {}", next_);
    scan(next_++);
    response.success = true;
    return true;
  }

  void scan(int customer) {
    virtual_booth::ScannerOptions scanner;
    scanner.seed = customer;
    scanner.points = setup_.points;
    const virtual_body::VirtualBody body = virtual_booth::random_customer(setup_.family, customer);
    if (setup_.cameras > 0)
      publish_images(body.mesh, scanner);
    else
      publish_clouds(body.mesh, scanner);
    ROS_INFO("simulated_booth: scanned customer %d", customer);
  }

  void publish_clouds(const geometry::TriangleMesh& body, const virtual_booth::ScannerOptions& scanner) {
    const virtual_booth::VirtualScan scan = virtual_booth::scan_body(body, scanner);
    const std::vector<virtual_booth::SensorScan> scans = virtual_booth::by_sensor(scan);
    const ros::Time stamp = ros::Time::now();
    latched_ = stamp.toNSec();
    poses_.publish(virtual_booth::sensor_poses(scan.sensors, setup_.frame_id, setup_.sensor_frames, stamp));
    for (int sensor = 0; sensor < kSensors; ++sensor)
      if (sensor != setup_.silent)
        sensors_[sensor].publish(
            virtual_booth::sensor_cloud(scans[sensor], frame_of(sensor), seen_at(stamp, sensor)));
  }

  void publish_images(const geometry::TriangleMesh& body, virtual_booth::ScannerOptions scanner) {
    scanner.sensors_per_column = setup_.cameras / kColumns;
    const std::vector<virtual_booth::DepthPicture> pictures =
        virtual_booth::depth_pictures(body, scanner, virtual_booth::kWideLens);
    std::vector<virtual_booth::SensorPose> poses;
    for (const virtual_booth::DepthPicture& picture : pictures) poses.push_back(picture.pose);
    const ros::Time stamp = ros::Time::now();
    latched_ = stamp.toNSec();
    poses_.publish(virtual_booth::sensor_poses(poses, setup_.frame_id, setup_.sensor_frames, stamp));
    for (int camera = 0; camera < setup_.cameras; ++camera) {
      if (camera == setup_.silent) continue;
      lenses_[camera].publish(
          virtual_booth::camera_info(pictures[camera], frame_of(camera), seen_at(stamp, camera)));
      sensors_[camera].publish(
          virtual_booth::depth_image(pictures[camera], frame_of(camera), seen_at(stamp, camera)));
    }
  }

  std::string frame_of(int sensor) const { return setup_.sensor_frames + std::to_string(sensor); }
  static ros::Time seen_at(const ros::Time& stamp, int sensor) {
    return stamp + ros::Duration(0.001 * sensor);
  }

  // ns: a scan is known by the stamp of one of its sensors
  static constexpr auto kOneScan = static_cast<std::uint64_t>(1e9 * geometry::kUsualSlop);

  const Setup setup_;
  ros::NodeHandle node_;
  int next_;        // customer
  double due_ = 0;  // when she comes, seconds of the steady clock
  ros::Publisher poses_;
  std::vector<ros::Publisher> sensors_, lenses_;  // lenses of cameras alone
  std::optional<std::uint64_t> latched_;          // stamp of what they latch, ns
  ros::ServiceServer service_;
  ros::WallTimer clock_;
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::SimulatedBooth>(argc, argv, "simulated_booth");
}
