/// Depth images with lens distortion in, a body and its measures out, against the truth of the virtual body.
/// Its cameras stand where they are believed to: what all columns are off together is no fault of the way
/// from images to measures.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_srvs/Trigger.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "chain_client.hpp"
#include "geometry/ply.hpp"
#include "surface_distance.hpp"

namespace tensegric_fit::tests {
namespace {

constexpr int kCameras = 8;
const std::string kFolder = std::string(TENSEGRIC_FIT_SCANS) + "/cameras/";

struct Seen {
  sensor_msgs::Image image;
  sensor_msgs::CameraInfo info;
};

const std::vector<Seen>& recorded_cameras() {
  static const std::vector<Seen> all = [] {
    std::vector<Seen> seen(kCameras);
    const rosbag::Bag bag(kFolder + "cameras.bag");
    for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
      const std::string topic = message.getTopic();
      if (topic.rfind("/cameras/", 0) != 0) continue;
      Seen& camera = seen[std::stoi(topic.substr(9))];
      if (const auto image = message.instantiate<sensor_msgs::Image>()) camera.image = *image;
      if (const auto info = message.instantiate<sensor_msgs::CameraInfo>()) camera.info = *info;
    }
    return seen;
  }();
  return all;
}

/// The cameras of a booth in a namespace, and what its assembler and nodes say.
class Cameras {
 public:
  explicit Cameras(const std::string& name) : node_(name), name_(name) {
    for (int camera = 0; camera < kCameras; ++camera) {
      const std::string topics = "cameras/" + std::to_string(camera);
      images_.push_back(node_.advertise<sensor_msgs::Image>(topics + "/image", 1));
      infos_.push_back(node_.advertise<sensor_msgs::CameraInfo>(topics + "/camera_info", 1));
    }
    subscribers_.push_back(node_.subscribe<sensor_msgs::PointCloud2>(
        "scan/points", 8, [this](const sensor_msgs::PointCloud2::ConstPtr& scan) { scans.push_back(scan); }));
    subscribers_.push_back(node_.subscribe<TriangleMesh>(
        "body/mesh", 8, [this](const TriangleMesh::ConstPtr& body) { bodies.push_back(body); }));
    subscribers_.push_back(node_.subscribe<Landmarks>(
        "body/landmarks", 8, [this](const Landmarks::ConstPtr& found) { landmarks.push_back(found); }));
    subscribers_.push_back(node_.subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 1000, [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
          for (const auto& status : message->status)
            for (const auto& fact : status.values) facts[status.name][fact.key] = fact.value;
        }));
  }

  bool ready() {
    return wait_for([this] {
      for (int camera = 0; camera < kCameras; ++camera)
        if (images_[camera].getNumSubscribers() == 0 || infos_[camera].getNumSubscribers() == 0) return false;
      return !facts[stage("assembler")].empty() && subscribers_[0].getNumPublishers() > 0;
    });
  }

  void send(int camera, Seen seen, const ros::Time& stamp) {
    seen.image.header.stamp = seen.info.header.stamp = stamp;
    infos_[camera].publish(seen.info);
    images_[camera].publish(seen.image);
  }
  void send_all(const ros::Time& stamp, const std::set<int>& but = {}) {
    for (int camera = 0; camera < kCameras; ++camera)
      if (but.count(camera) == 0)
        send(camera, recorded_cameras()[camera], stamp + ros::Duration(0.001 * camera));
  }

  bool says(const std::string& node, const std::string& code, const std::string& words) {
    return wait_for([&] {
      auto& said = facts[stage(node)];
      return said["last_error"] == code && said["last_error_message"].find(words) != std::string::npos;
    });
  }

  std::string stage(const std::string& node) const { return name_ + "/" + node + ": " + node; }

  std::vector<sensor_msgs::PointCloud2::ConstPtr> scans;
  std::vector<TriangleMesh::ConstPtr> bodies;
  std::vector<Landmarks::ConstPtr> landmarks;
  std::map<std::string, std::map<std::string, std::string>> facts;

 private:
  ros::NodeHandle node_;
  std::string name_;
  std::vector<ros::Publisher> images_, infos_;
  std::vector<ros::Subscriber> subscribers_;
};

TEST(DepthCamerasTest, DepthImagesBecomeABodyAndItsMeasures) {
  Cameras booth("played");
  ASSERT_TRUE(booth.ready());
  ros::Time sent(100);
  booth.send_all(sent);
  ASSERT_TRUE(wait_for([&] {
    // Where /tf_static came later than the images they were refused by that name.
    if (sent == ros::Time(100) && booth.facts[booth.stage("assembler")]["last_error"] == "no_transform")
      booth.send_all(sent = ros::Time(110));
    return !booth.landmarks.empty() && !booth.bodies.empty();
  }));
  EXPECT_EQ(booth.scans.size(), 1u);
  EXPECT_EQ(booth.scans[0]->header.stamp, sent);

  // The surface, where it was seen: away from soles, hands and head, as far as ISO-like limits of the design
  // go.
  std::vector<Eigen::Vector3d> points;
  const auto& flat = booth.bodies[0]->vertices;
  for (std::size_t i = 0; i + 2 < flat.size(); i += 3) points.emplace_back(flat[i], flat[i + 1], flat[i + 2]);
  std::vector<char> left_out;
  for (const Eigen::Vector3d& p : points) left_out.push_back(p.z() < 0.3 || p.z() > 1.35);
  const std::vector<double> off =
      gauge::distances(points, left_out, geometry::read_ply_mesh(kFolder + "body.ply"));
  const double median = 1000 * gauge::quantile(off, 0.5), most = 1000 * gauge::quantile(off, 0.95);
  std::cout << "surface to truth, mm: median " << median << ", 95 % " << most << '\n';
  EXPECT_LT(median, 0.8);
  EXPECT_LT(most, 4.0);

  const nlohmann::json truth = nlohmann::json::parse(std::ifstream(kFolder + "truth.json"));
  std::map<std::string, double> girths;
  for (const Measure& girth : booth.landmarks[0]->girths) girths[girth.name] = girth.value;
  // ISO 20685, large girths. The neck's 4 mm are not kept: nodes/depth_cameras/README.md.
  const std::map<std::string, double> limits = {{"bust", 9}, {"underbust", 9}, {"waist", 9}, {"hip", 9}};
  for (const auto& [name, limit] : limits) {
    ASSERT_TRUE(girths.count(name)) << name;
    const double off_mm = 1000 * (girths[name] - truth["girths"][name].get<double>());
    std::cout << name << " off by " << off_mm << " mm\n";
    EXPECT_LT(std::abs(off_mm), limit) << name;
  }

  // What cannot be used is named with its camera, the booth goes on, and a camera that is silent is named.
  Seen bad = recorded_cameras()[3];
  bad.info.K[0] = 0;
  booth.send(3, bad, ros::Time(200));
  EXPECT_TRUE(booth.says("depth_cameras", "wrong_fields", "cameras/3"));
  bad = recorded_cameras()[2];
  bad.image.data.resize(100);
  booth.send(2, bad, ros::Time(200));
  EXPECT_TRUE(booth.says("depth_cameras", "broken_file", "cameras/2"));
  booth.send_all(ros::Time(300), {5});
  EXPECT_TRUE(booth.says("assembler", "missing_sensor", "cameras/5/points"));
}

/// Asks for a scan; until the answer is there `cameras_send` is called with 0, 1, ..., farther apart than the
/// parameter `slop`.
std_srvs::Trigger::Response asked_while(const std::function<void(int)>& cameras_send) {
  std_srvs::Trigger scan;
  std::future<bool> call = std::async(
      std::launch::async, [&scan] { return ros::service::call("asked/depth_cameras/scan", scan); });
  for (int count = 0; call.wait_for(std::chrono::seconds(0)) != std::future_status::ready; ++count) {
    cameras_send(count);
    listen(0.3);
  }
  EXPECT_TRUE(call.get()) << "no service";
  return scan.response;
}

TEST(DepthCamerasTest, CamerasThatSendAllTheTimeAreAskedForAScan) {
  Cameras booth("asked");
  ASSERT_TRUE(booth.ready());
  ASSERT_TRUE(ros::service::waitForService("asked/depth_cameras/scan", ros::Duration(kPatience)));

  // Nobody asked: no scan.
  booth.send_all(ros::Time::now());
  listen(2);
  EXPECT_TRUE(booth.scans.empty());

  // Asked while a set of images comes in: half of the cameras sent theirs before. For a second the others are
  // silent, so that the service has been called by then.
  const std_srvs::Trigger::Response whole = asked_while([&booth](int count) {
    if (count >= 4) return booth.send_all(ros::Time::now());
    for (int camera = 0; camera < kCameras / 2; ++camera)
      booth.send(camera, recorded_cameras()[camera], ros::Time::now());
  });
  EXPECT_TRUE(whole.success) << whole.message;
  EXPECT_TRUE(wait_for([&] { return !booth.scans.empty(); }))
      << booth.facts[booth.stage("assembler")]["last_error_message"];
  booth.send_all(ros::Time::now());
  listen(2);
  EXPECT_EQ(booth.scans.size(), 1u);

  // The assembler makes a scan of seven.
  const std_srvs::Trigger::Response seven =
      asked_while([&booth](int) { booth.send_all(ros::Time::now(), {6}); });
  EXPECT_TRUE(seven.success);
  EXPECT_NE(seven.message.find("cameras/6"), std::string::npos) << seven.message;
  EXPECT_TRUE(wait_for([&] { return booth.scans.size() == 2; }));

  const std_srvs::Trigger::Response lacking = asked_while([&booth](int) {
    booth.send_all(ros::Time::now(), {6, 7});
  });
  EXPECT_FALSE(lacking.success);
  EXPECT_NE(lacking.message.find("cameras/6"), std::string::npos) << lacking.message;
  EXPECT_EQ(lacking.message.find("cameras/5"), std::string::npos) << lacking.message;
}

}  // namespace
}  // namespace tensegric_fit::tests
