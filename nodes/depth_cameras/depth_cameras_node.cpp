/// depth_cameras: depth images -> the clouds that the assembler takes, through Debian's depth_image_proc, the
/// nodelets of which run in this process. Says where the cameras stand, where a file has it.
#include <fmt/format.h>
#include <message_filters/time_synchronizer.h>
#include <nodelet/loader.h>
#include <ros/callback_queue.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <regex>
#include <set>
#include <utility>

#include "depth_cameras/camera_message.hpp"
#include "depth_cameras/camera_poses.hpp"
#include "depth_cameras/one_moment.hpp"
#include "geometry/scan_stamp.hpp"
#include "geometry/slop.hpp"
#include "ros/await.hpp"
#include "ros/parameters.hpp"
#include "ros/run_node.hpp"
#include "ros/stage.hpp"
#include "ros/transform_message.hpp"

namespace tensegric_fit::node {
namespace {

using geometry::Refusal;
using sensor_msgs::CameraInfo;
using sensor_msgs::Image;
namespace refusal = geometry::refusal;

constexpr std::size_t kMostCameras = 16;

struct Setup {
  std::vector<std::string> cameras;
  std::string frame_id, camera_frames;
  std::vector<Eigen::Isometry3d> poses;  // booth_from_camera; empty: tf has them
  bool on_demand;
  double timeout, slop;
  std::size_t min_cameras;  // whose images make a scan that was asked for
};

std::vector<std::string> check_names(std::vector<std::string> names) {
  const std::set<std::string> different(names.begin(), names.end());
  if (names.empty() || names.size() > kMostCameras || different.size() != names.size())
    throw Refusal(refusal::kBadOption,
                  fmt::format("parameter 'cameras' must list 1 to {} names, each once", kMostCameras));
  for (const std::string& name : names)
    if (!std::regex_match(name, std::regex("[A-Za-z0-9_]+")))
      throw Refusal(refusal::kBadOption,
                    "parameter 'cameras': '" + name + "' is no name of letters and digits");
  return names;
}

/// `assembler`: its parameters, which say how many sensors make a scan.
Setup setup_from(Parameters parameters, Parameters assembler) {
  Setup setup;
  setup.cameras = check_names(parameters.texts("cameras"));
  setup.frame_id = parameters.frame("frame_id", "booth");
  setup.camera_frames = parameters.frame("camera_frames", "camera_");
  const std::string extrinsics = parameters.text("extrinsics", "");
  setup.on_demand = parameters.flag("on_demand", false);
  setup.timeout = parameters.number("timeout", 2, {0.01, 600});
  setup.slop = parameters.number("slop", geometry::kUsualSlop, geometry::kSlop);
  parameters.check_all_known();
  const auto count = static_cast<int>(setup.cameras.size());
  setup.min_cameras =
      static_cast<std::size_t>(std::min(count, assembler.integer("min_sensors", count, {1, 64})));
  if (!extrinsics.empty()) setup.poses = depth_cameras::load_camera_poses(extrinsics, setup.cameras);
  return setup;
}

/// A depth image and its lens, of the same stamp.
struct Seen {
  Image::ConstPtr image;
  CameraInfo::ConstPtr info;
};

/// One camera: images in, those that make a scan handed on to its nodelets.
class Camera {
 public:
  using Pair = boost::function<void(const Image::ConstPtr&, const CameraInfo::ConstPtr&)>;

  Camera(ros::NodeHandle node, const std::string& name, nodelet::Loader& loader, Pair pair)
      : node_(node), name_(name), both_(kQueue) {
    advertise();
    image_ = node.subscribe<Image>(
        fmt::format("cameras/{}/image", name), kQueue,
        [this](const Image::ConstPtr& image) { both_.add<0>(ros::MessageEvent<Image const>(image)); });
    info_ = node.subscribe<CameraInfo>(fmt::format("cameras/{}/camera_info", name), kQueue,
                                       [this](const CameraInfo::ConstPtr& info) {
                                         both_.add<1>(ros::MessageEvent<CameraInfo const>(info));
                                       });
    const std::string here = node.resolveName("cameras/" + name);
    load(loader, ros::this_node::getName() + "_points_" + name, "depth_image_proc/point_cloud_xyz",
         {{node.resolveName("image_rect"), here + "/taken/image"},
          {node.resolveName("points"), here + "/points"}});
    both_.registerCallback(boost::bind(std::move(pair), boost::placeholders::_1, boost::placeholders::_2));
  }

  /// Both with `frame`, unless it is empty.
  void take(const Seen& seen, const std::string& frame) {
    CameraInfo info = *seen.info;
    Image image = rectified(*seen.image, info);
    if (!frame.empty()) image.header.frame_id = info.header.frame_id = frame;
    info_out_.publish(info);
    image_out_.publish(image);
    taken_ = seen.image->header.stamp.toNSec();
  }

  /// What it handed on last, unless that was taken more than so many ns after the stamp, and is another's.
  /// True where there was something to let go of.
  bool forget(std::uint64_t stamp, std::uint64_t within) {
    if (!taken_ || *taken_ > stamp + within) return false;
    image_out_.shutdown();
    info_out_.shutdown();
    advertise();
    taken_.reset();
    return true;
  }

  const std::string& name() const { return name_; }

 private:
  static constexpr int kQueue = 5;  // pairs of image and CameraInfo that wait for each other

  void advertise() {  // latched: the nodelets connect when the assembler does
    image_out_ = node_.advertise<Image>(fmt::format("cameras/{}/taken/image", name_), 1, true);
    info_out_ = node_.advertise<CameraInfo>(fmt::format("cameras/{}/taken/camera_info", name_), 1, true);
  }

  static void load(nodelet::Loader& loader, const std::string& name, const std::string& type,
                   const nodelet::M_string& names) {
    if (!loader.load(name, type, names, {}))
      throw std::runtime_error(type + " cannot be loaded; are the packages of package.xml installed?");
  }

  ros::NodeHandle node_;
  std::string name_;
  message_filters::TimeSynchronizer<Image, CameraInfo> both_;
  ros::Subscriber image_, info_;
  ros::Publisher image_out_, info_out_;
  std::optional<std::uint64_t> taken_;  // stamp of what is latched
};

class DepthCameras {
 public:
  DepthCameras(const ros::NodeHandle& node, ros::NodeHandle private_node)
      : setup_(setup_from(Parameters(private_node), Parameters(ros::NodeHandle(node, "assembler")))),
        loader_(false),
        named_(setup_.cameras.size()),
        stage_("depth_cameras", node) {
    publish_poses();
    for (std::size_t i = 0; i < setup_.cameras.size(); ++i)
      cameras_.push_back(
          std::make_unique<Camera>(node, setup_.cameras[i], loader_,
                                   [this, i](const Image::ConstPtr& image, const CameraInfo::ConstPtr& info) {
                                     on_pair(i, {image, info});
                                   }));
    if (!setup_.on_demand) return;
    private_node.setCallbackQueue(&calls_);
    service_ = private_node.advertiseService("scan", &DepthCameras::on_scan, this);
    caller_.start();
  }

  /// The clouds are the nodelets' to publish and the assembler's to keep. Images are known by their stamps.
  void forget(const ForgetOrder& order, ForgetAnswer& done) {
    const auto stamp = geometry::stamp_in(order.scan_id);
    if (!stamp) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    bool any = false;
    for (const auto& camera : cameras_) any |= camera->forget(*stamp, slop());
    if (any) done.removed = {"the latched depth images"};
  }

 private:
  void publish_poses() {
    std::vector<geometry_msgs::TransformStamped> poses(setup_.poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses[i].header.stamp = ros::Time::now();
      poses[i].header.frame_id = setup_.frame_id;
      poses[i].child_frame_id = setup_.camera_frames + setup_.cameras[i];
      poses[i].transform = transform_of(setup_.poses[i]);
    }
    if (!poses.empty()) broadcaster_.sendTransform(poses);
  }

  void on_pair(std::size_t camera, const Seen& seen) {
    try {
      check_depth_image(*seen.image, *seen.info);
    } catch (const Refusal& refused) {
      if (const auto now = ros::SteadyTime::now(); now >= named_[camera]) {
        named_[camera] = now + kNamedAgain;
        stage_.drop("", Refusal(refused.code(), "cameras/" + setup_.cameras[camera] + ": " + refused.what()));
      }
      return;
    }
    try {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (setup_.on_demand)
        hold(camera, seen);
      else
        take(camera, seen);
    } catch (const std::exception& error) {  // memory ran out
      stage_.drop("", Refusal("internal_error", "cameras/" + setup_.cameras[camera] + ": " + error.what()));
    }
  }

  void take(std::size_t camera, const Seen& seen) {
    cameras_[camera]->take(seen, setup_.poses.empty() ? "" : setup_.camera_frames + setup_.cameras[camera]);
  }

  /// Until there are images of all cameras that are of one moment.
  void hold(std::size_t camera, const Seen& seen) {
    if (!asked_) return;
    if (seen.image->header.stamp < since_) {
      early_[camera].push_back(seen.image->header.stamp);
      return;
    }
    std::deque<Seen>& held = held_[camera];
    if (!held.empty() && seen.image->header.stamp <= held.back().image->header.stamp) return;
    held.push_back(seen);
    const auto stamp = [](const Seen& of) { return of.image->header.stamp.toNSec(); };
    while (held.size() > kAlwaysHeld && (stamp(held.back()) - stamp(held.front()) > kHeld ||
                                         held.size() * seen.image->data.size() > kMostBytes))
      held.pop_front();
    const std::vector<int> chosen = of_one_moment();
    if (std::count(chosen.begin(), chosen.end(), depth_cameras::kNone) == 0) take_held(chosen);
  }

  std::vector<int> of_one_moment() const {
    std::vector<std::deque<std::uint64_t>> stamps(held_.size());
    for (std::size_t i = 0; i < held_.size(); ++i)
      for (const Seen& seen : held_[i]) stamps[i].push_back(seen.image->header.stamp.toNSec());
    return depth_cameras::of_one_moment(stamps, slop());
  }

  std::uint64_t slop() const { return static_cast<std::uint64_t>(std::llround(1e9 * setup_.slop)); }

  void take_held(const std::vector<int>& chosen) {
    for (std::size_t i = 0; i < chosen.size(); ++i)
      if (chosen[i] != depth_cameras::kNone) take(i, held_[i][chosen[i]]);
    asked_ = false;
    taken_.notify_all();
  }

  bool on_scan(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    std::unique_lock<std::mutex> lock(mutex_);
    since_ = ros::Time::now();
    held_.assign(cameras_.size(), {});
    early_.assign(cameras_.size(), {});
    asked_ = true;
    response.success =
        await(taken_, lock, std::chrono::duration<double>(setup_.timeout), [this] { return !asked_; });
    if (!response.success && ros::isShuttingDown()) return false;
    if (response.success) {
      response.message = fmt::format("{} depth images taken", cameras_.size());
    } else {
      const std::vector<int> chosen = of_one_moment();
      const std::size_t taken =
          chosen.size() - std::count(chosen.begin(), chosen.end(), depth_cameras::kNone);
      response.message = without(chosen);
      response.success = taken >= setup_.min_cameras;  // the assembler names who is missing
      take_held(chosen);
      if (response.success)
        response.message = fmt::format("{} depth images taken; {}", taken, response.message);
      else
        stage_.drop("", Refusal(refusal::kMissingSensor, response.message));
    }
    held_.assign(cameras_.size(), {});
    return true;
  }

  /// What the scan that was asked for lacks.
  std::string without(const std::vector<int>& chosen) const {
    std::vector<std::string> silent, apart;
    for (std::size_t i = 0; i < chosen.size(); ++i)
      if (chosen[i] == depth_cameras::kNone)
        (held_[i].empty() ? silent : apart).push_back("cameras/" + setup_.cameras[i]);
    std::string words;
    if (!silent.empty())
      words = fmt::format("no depth image with CameraInfo of the same stamp within {} s from: {}",
                          setup_.timeout, fmt::join(silent, ", "));
    for (std::size_t i = 0; i < chosen.size(); ++i)
      if (held_[i].empty() && early_[i].size() > kInFlight)
        words += fmt::format(
            "; images from cameras/{} are stamped {:.1f} s and more before they were asked for: are "
            "the clocks set alike?",
            setup_.cameras[i], 1e-9 * static_cast<double>(since_.toNSec() - early_[i].back().toNSec()));
    if (!apart.empty())
      words += fmt::format("{}no depth image within {} s (parameter 'slop') of those of the others from: {}",
                           words.empty() ? "" : "; ", setup_.slop, fmt::join(apart, ", "));
    return words;
  }

  // Cameras of one moment may be so much later than others, within the memory of one camera's images.
  static constexpr std::size_t kAlwaysHeld = 5, kMostBytes = 64u << 20;
  static constexpr std::uint64_t kHeld = 1000000000;  // ns
  static constexpr std::size_t kInFlight = 2;  // images that were on their way when they were asked for
  inline static const ros::WallDuration kNamedAgain{1};  // s until a camera's fault is named again

  const Setup setup_;
  tf2_ros::StaticTransformBroadcaster broadcaster_;
  nodelet::Loader loader_;
  std::mutex mutex_;  // guards cameras_ once they run, and the next five
  std::condition_variable taken_;
  bool asked_ = false;
  ros::Time since_;
  std::vector<std::deque<Seen>> held_;         // by camera, since it was asked
  std::vector<std::vector<ros::Time>> early_;  // by camera: stamps of images that came since, and are older
  std::vector<ros::SteadyTime> named_;  // by camera: when its faults may be named again; of the main thread
  std::vector<std::unique_ptr<Camera>> cameras_;
  Stage stage_;
  ros::CallbackQueue calls_;
  ros::ServiceServer service_;
  ros::AsyncSpinner caller_{1, &calls_};  // last: the service uses all of the above, and waits for images,
                                          // which come on the main queue
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::DepthCameras>(argc, argv, "depth_cameras");
}
