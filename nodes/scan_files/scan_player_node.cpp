/// scan_player: publishes the scans of a file, of a bag, or of a folder that is watched, on scan/points.
#include <fmt/format.h>
#include <pcl_conversions/pcl_conversions.h>
#include <sensor_msgs/PointCloud2.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>

#include "ros/parameters.hpp"
#include "ros/run_node.hpp"
#include "ros/scan_tag.hpp"
#include "ros/stage.hpp"
#include "scan_files/scan_bag.hpp"
#include "scan_files/scan_file.hpp"
#include "scan_files/scan_folder.hpp"

namespace tensegric_fit::node {
namespace {

namespace fs = std::filesystem;
using sensor_msgs::PointCloud2;

struct Setup {
  std::string file, frame_id;
  double rate, interval, settle;
  bool existing;
  std::vector<std::string> played_files;  // what this node played before it was respawned
};

Setup setup_from(Parameters parameters) {
  Setup setup;
  setup.file = parameters.text("file", "");
  setup.frame_id = parameters.frame("frame_id", "booth");
  setup.rate = parameters.number("rate", 0, {0, 1000});
  setup.interval = parameters.number("interval", 10, {0, 86400});
  setup.settle = parameters.number("settle", 1, {0.1, 3600});
  setup.existing = parameters.flag("existing", false);
  setup.played_files = parameters.texts("played_files");
  parameters.check_all_known();
  if (!fs::exists(setup.file))
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            fmt::format("parameter 'file': there is no file or folder '{}'", setup.file));
  if (setup.rate > 0 && fs::is_directory(setup.file))
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            "parameter 'rate': the scans of a folder are played once each");
  return setup;
}

std::vector<PointCloud2::ConstPtr> scans_in(const std::string& path) {
  if (fs::path(path).extension() == ".bag") return scan_files::read_bag_scans(path);
  scan_files::ScanFile file = scan_files::read_scan_file(path);
  scan_files::apply(scan_files::reading_of({file}, {}), file.cloud);
  const auto scan = boost::make_shared<PointCloud2>();
  pcl_conversions::moveFromPCL(file.cloud, *scan);
  return {scan};
}

class ScanPlayer {
 public:
  ScanPlayer(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : setup_(setup_from(Parameters(private_node))),
        node_(node),
        private_node_(private_node),
        publisher_(advertised()),
        stage_("scan_player", node) {
    if (fs::is_directory(setup_.file)) {
      folder_.emplace(setup_.file, setup_.settle);
      if (private_node_.hasParam("played_files"))
        folder_->skip(setup_.played_files);
      else if (!setup_.existing)
        folder_->skip_all();
      remember();
    } else {
      files_.push_back(setup_.file);
    }
    const double tick = folder_           ? setup_.settle / 4
                        : setup_.rate > 0 ? std::min(0.1, 0.1 / setup_.rate)
                                          : 0.1;
    clock_ = node.createWallTimer(ros::WallDuration(tick), [this](const ros::WallTimerEvent&) { go_on(); });
  }

  /// It would play its files again, did it begin anew.
  void forget(const ForgetOrder& order, ForgetAnswer& done) {
    const auto source = sources_.find(order.scan_id);
    if (source == sources_.end()) return;
    if (order.scan_id == published_) {
      publisher_.shutdown();
      publisher_ = advertised();
      published_.clear();
      if (!busy_) scans_.clear();  // else they are another file's
      at_ = 0;
      done.removed.push_back("the latched scan/points");
    }
    if (order.scan_file) {
      std::error_code error;
      if (fs::symlink_status(source->second, error).type() == fs::file_type::regular &&
          fs::remove(source->second, error))
        done.removed.push_back("the file " + source->second);
      else
        done.failed.push_back("the file " + source->second + " was not deleted");
    }
    sources_.erase(source);
  }

 private:
  ros::Publisher advertised() { return node_.advertise<PointCloud2>("scan/points", 1, true); }

  void go_on() {
    if (folder_) look();
    if (busy_ || ros::SteadyTime::now().toSec() < next_) return;
    if (setup_.rate > 0 && at_ == scans_.size()) at_ = 0;
    if (at_ < scans_.size())
      publish(*scans_[at_++]);
    else if (!files_.empty())
      read(files_.front());
  }

  void look() {
    try {
      const std::vector<std::string> complete = folder_->poll(ros::SteadyTime::now().toSec());
      if (complete.empty()) return;
      for (const std::string& path : complete)
        if (scan_files::is_scan_name(path))
          files_.push_back(path);
        else if (!scan_files::is_companion_name(path))
          stage_.drop(path, geometry::Refusal(geometry::refusal::kBrokenFile,
                                              path + ": scans are not read from files of this type"));
      remember();
    } catch (const geometry::Refusal& refusal) {
      stage_.drop("", refusal);
    }
  }

  void remember() { private_node_.setParam("played_files", folder_->played()); }

  void read(const std::string path) {
    files_.pop_front();
    busy_ = true;
    playing_ = path;
    stage_.begin(path);
    stage_.post(path, [this, path]() -> Stage::Result {
      try {
        const std::vector<PointCloud2::ConstPtr> scans = scans_in(path);
        return {[this, scans] {
                  scans_ = scans;
                  at_ = 0;
                  busy_ = false;
                },
                {{"scans", std::to_string(scans.size())}}};
      } catch (...) {
        busy_ = false;
        throw;
      }
    });
  }

  void publish(PointCloud2 scan) {
    scan.header.stamp = ros::Time::now();
    scan.header.frame_id = setup_.frame_id;
    publisher_.publish(scan);
    published_ = tag_of(scan).scan_id;
    sources_[published_] = playing_;
    next_ = ros::SteadyTime::now().toSec() + (setup_.rate > 0 ? 1 / setup_.rate : setup_.interval);
    ROS_INFO("scan_player: scan %s", tag_of(scan).scan_id.c_str());
  }

  const Setup setup_;
  ros::NodeHandle node_, private_node_;
  ros::Publisher publisher_;
  std::optional<scan_files::ScanFolder> folder_;
  std::deque<std::string> files_;               // complete, to be read
  std::vector<PointCloud2::ConstPtr> scans_;    // of the file read last; the worker's while busy
  std::string playing_, published_;             // a path; a scan_id
  std::map<std::string, std::string> sources_;  // scan_id -> path
  std::size_t at_ = 0;                          // of the next one
  double next_ = 0;                             // when it may go, seconds of the steady clock
  std::atomic<bool> busy_{false};
  ros::WallTimer clock_;
  Stage stage_;  // last: its worker uses all of the above
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::ScanPlayer>(argc, argv, "scan_player");
}
