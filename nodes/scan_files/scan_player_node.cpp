/// scan_player: publishes the scans of a file, of a bag, or of a folder that is watched, on scan/points, and
/// on scan/label where they come from.
#include <fmt/format.h>
#include <pcl_conversions/pcl_conversions.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/PointCloud2.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "files/checked_message.hpp"
#include "mesh_files/read_mesh.hpp"
#include "ros/held_scan.hpp"
#include "ros/parameters.hpp"
#include "ros/run_node.hpp"
#include "ros/scan_labels.hpp"
#include "ros/scan_tag.hpp"
#include "ros/set_parameter.hpp"
#include "ros/stage.hpp"
#include "scan_files/bag_messages.hpp"
#include "scan_files/customer_name.hpp"
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
  std::regex customer;                         // in the names of files
  std::vector<std::string> played_files;       // what this node played before it was respawned
  std::vector<std::string> interrupted_files;  // what it was at when it ended
};

Setup setup_from(Parameters parameters) {
  Setup setup;
  setup.file = parameters.text("file", "");
  setup.frame_id = parameters.frame("frame_id", "booth");
  setup.rate = parameters.number("rate", 0, {0, 1000});
  setup.interval = parameters.number("interval", 10, {0, 86400});
  setup.settle = parameters.number("settle", 1, {0.1, 3600});
  setup.existing = parameters.flag("existing", false);
  setup.customer = scan_files::customer_pattern(parameters.text("customer_pattern", ""));
  setup.played_files = parameters.texts("played_files");
  setup.interrupted_files = parameters.texts("interrupted_files");
  parameters.check_all_known();
  if (setup.file.rfind("~/", 0) == 0 ||
      setup.file.find("/~/") != std::string::npos)  // the log hides paths, they may name a customer
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            "parameter 'file': no shell has read its ~; write $HOME in its place");
  if (!fs::exists(setup.file))
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            fmt::format("parameter 'file': there is no file or folder '{}'", setup.file));
  if (setup.rate > 0 && fs::is_directory(setup.file))
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            "parameter 'rate': the scans of a folder are played once each");
  return setup;
}

/// What is known of it before it gets a new stamp.
struct FileScan {
  PointCloud2::ConstPtr points;
  ScanLabel label;
};

std::vector<FileScan> scans_in_bag(const std::string& path, const ScanLabel& label) {
  const std::vector<PointCloud2::ConstPtr> clouds = scan_files::read_bag_scans(path);  // refuses broken bags
  ScanLabels labels;
  const rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message :
       rosbag::View(bag, rosbag::TypeQuery(ros::message_traits::datatype<ScanLabel>())))
    if (const auto known = files::checked_message<ScanLabel>(message)) labels.add(*known);
  std::vector<FileScan> scans;
  for (const PointCloud2::ConstPtr& points : clouds) {
    ScanLabel own = labels.of(tag_of(*points).scan_id);
    own.source = label.source;
    if (own.customer.empty()) own.customer = label.customer;
    scans.push_back({points, own});
  }
  return scans;
}

std::vector<FileScan> scans_in(const std::string& path, const std::regex& customer) {
  ScanLabel label;
  label.source = fs::path(path).filename();
  label.customer = scan_files::customer_in(path, customer);
  if (mesh_files::ending_of(path) == ".bag") return scans_in_bag(path, label);
  scan_files::ScanFile file = scan_files::read_scan_file(path);
  scan_files::apply(scan_files::reading_of({file}, {}), file.cloud);
  const auto scan = boost::make_shared<PointCloud2>();
  pcl_conversions::moveFromPCL(file.cloud, *scan);
  return {{scan, label}};
}

class ScanPlayer {
 public:
  ScanPlayer(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
      : setup_(setup_from(Parameters(private_node))),
        node_(node),
        private_node_(private_node),
        publisher_(advertised()),
        labels_(advertised_labels()),
        stage_("scan_player", node) {
    if (fs::is_directory(setup_.file)) {
      folder_.emplace(setup_.file, setup_.settle);
      if (private_node_.hasParam("played_files"))
        folder_->skip(setup_.played_files);
      else if (!setup_.existing)
        skip_existing();
      report_lost();
      remember();
    } else {
      files_.push_back(setup_.file);
    }
    const double tick = folder_           ? setup_.settle / 4
                        : setup_.rate > 0 ? std::min(0.1, 0.1 / setup_.rate)
                                          : 0.1;
    clock_ = node.createWallTimer(ros::WallDuration(tick), [this](const ros::WallTimerEvent&) { go_on(); });
  }

  /// Who puts the first scan there before the booth is up should not wait without a word.
  void skip_existing() {
    folder_->skip_all();
    if (const std::size_t count = folder_->played().size(); count > 0)
      stage_.post("", [count]() -> Stage::Result {
        return {[] {},
                {},
                fmt::format("existing_files: {} were in the folder at the start and are not played; new ones "
                            "are, and those with existing:=true.",
                            count)};
      });
  }

  /// A file that this node was at when it ended is played again, unless that was its second time or some of
  /// its scans are out.
  void report_lost() {
    const std::vector<std::string> played = folder_->played();
    for (const std::string& text : setup_.interrupted_files)
      if (std::find(played.begin(), played.end(), text) == played.end())
        interrupted_.insert(text);
      else
        stage_.drop("", geometry::Refusal(geometry::refusal::kBrokenFile,
                                          "this node ended while it read a file for the second time, or "
                                          "between the scans of a file: the rest of it is not played"));
  }

  /// If it restarted, it would play its files again.
  void forget(const ForgetOrder& order, ForgetAnswer& done) {
    const auto source = sources_.find(source_key(order.scan_id));
    if (source == sources_.end()) {
      if (order.scan_file && (!folder_ || !setup_.played_files.empty()))
        done.failed.push_back(
            "the file that it was played from, if it was: this node has been started again");
      return;
    }
    if (!published_.empty() && order.scan_id != published_ && source_key(published_) == source->first)
      done.failed.push_back("the same points were played again, as scan " + published_ +
                            ": forget that, too");
    if (order.scan_id == published_ || (setup_.rate > 0 && source->second.path == playing_.path)) {
      publisher_.shutdown();
      publisher_ = advertised();
      labels_.shutdown();
      labels_ = advertised_labels();
      published_.clear();
      if (!busy_ && setup_.rate > 0) {  // nor is it played over again
        scans_.clear();
        at_ = 0;
      }
      done.removed.push_back("the latched scan/points and scan/label");
    }
    HeldScan::of_process().forget(source->second.work);  // its path on /diagnostics
    if (order.scan_file) delete_file(source, done);
  }

 private:
  struct Played {
    std::string path;
    fs::file_time_type written;
    std::size_t scans;  // in it
    std::string work;   // of the stage
  };
  using Sources = std::map<std::string, Played>;  // by source_key

  void delete_file(Sources::iterator source, ForgetAnswer& done) {
    std::error_code error;
    const Played& file = source->second;
    if (file.scans > 1)
      done.failed.push_back("the file " + file.path + " was not deleted: it holds other scans, too");
    else if (fs::symlink_status(file.path, error).type() != fs::file_type::regular)
      done.failed.push_back("the file " + file.path + " was not deleted: it is not there, or a link");
    else if (fs::last_write_time(file.path, error) != file.written)
      done.failed.push_back("the file " + file.path + " was not deleted: it was written again since");
    else if (!fs::remove(file.path, error))
      done.failed.push_back("the file " + file.path + " was not deleted");
    else {
      done.removed.push_back("the file " + file.path);
      if (folder_) {
        const std::string name = fs::path(file.path).filename();
        let_go(name);
        folder_->drop(name);
      }
      delete_companions(file.path, done);
      if (folder_) remember();
      if (playing_.path == file.path) playing_ = {};
      sources_.erase(source);
    }
  }

  /// Textures are photographs of her. They have the name of the scan file, as those of another scan may.
  void delete_companions(const fs::path& file, ForgetAnswer& done) {
    const fs::path scan = fs::absolute(file);
    std::vector<fs::path> companions;
    bool is_shared = false;
    std::error_code error;
    for (fs::directory_iterator entry(scan.parent_path(), error), end; !error && entry != end;
         entry.increment(error)) {
      if (entry->path().stem() != scan.stem()) continue;
      if (scan_files::is_companion_name(entry->path())) companions.push_back(entry->path());
      is_shared = is_shared || scan_files::is_scan_name(entry->path());
    }
    if (error)
      done.failed.push_back("textures beside the file " + scan.string() +
                            " were not looked for: " + error.message());
    for (const fs::path& path : companions)
      if (!is_shared && fs::symlink_status(path, error).type() == fs::file_type::regular &&
          fs::remove(path, error)) {
        done.removed.push_back("the file " + path.string());
        if (folder_) folder_->drop(path.filename());
      } else {
        done.failed.push_back("the file " + path.string() + " was not deleted: " +
                              (is_shared ? "another scan has that name, too" : "it is a link, or stays"));
      }
  }

  /// A file that is played over and over has a stamp each time, and the same points.
  std::string source_key(const std::string& scan_id) const {
    return setup_.rate > 0 ? scan_id.substr(scan_id.rfind('-') + 1) : scan_id;
  }

  ros::Publisher advertised() { return node_.advertise<PointCloud2>("scan/points", 1, true); }
  ros::Publisher advertised_labels() { return node_.advertise<ScanLabel>("scan/label", 4, true); }

  void go_on() {
    if (folder_) look();
    if (busy_) return;
    if (!begun_.empty() &&
        at_ == scans_.size()) {  // refused; or published at the tick before, and sent since
      let_go(scan_files::ScanFolder::name_in(begun_));
      remember();
    }
    if (ros::SteadyTime::now().toSec() < next_) return;
    if (setup_.rate > 0 && at_ == scans_.size()) at_ = 0;
    if (at_ < scans_.size()) {
      publish(scans_[at_++]);
      if (folder_ && again_ && at_ < scans_.size()) {
        again_ = false;  // scans of it are out
        remember();
      }
      if (setup_.rate == 0) scans_[at_ - 1] = {};  // played once
    } else if (!files_.empty()) {
      read_next();
    }
  }

  void look() {
    try {
      const std::vector<std::string> complete = folder_->poll(ros::SteadyTime::now().toSec());
      if (complete.empty()) return;
      for (const std::string& path : complete)
        if (scan_files::is_scan_name(path)) {
          const bool waits = std::find(files_.begin(), files_.end(), path) != files_.end();
          if (!waits) files_.push_back(path);  // else it was written once more, and is read as it is then
        } else if (!scan_files::is_companion_name(path))
          stage_.drop("", geometry::Refusal(geometry::refusal::kBrokenFile,
                                            "a file of type '" + fs::path(path).extension().string() +
                                                "' is there: scans are not read from it"));
      remember();
    } catch (const geometry::Refusal& refusal) {
      stage_.drop("", refusal);
    }
  }

  /// Files that wait are played by its next life, and the one that it is at, if `again_`. Where this node
  /// ends between the two, the file is played once more.
  void remember() {
    std::set<std::string> waiting, interrupted = interrupted_;
    for (const std::string& path : files_) waiting.insert(fs::path(path).filename());
    if (!begun_.empty()) interrupted.insert(begun_);
    if (!begun_.empty() && again_) waiting.insert(scan_files::ScanFolder::name_in(begun_));
    set_texts("interrupted_files", interrupted);
    set_texts("played_files", folder_->played(waiting));
  }

  template <typename Texts>
  void set_texts(const std::string& name, const Texts& texts) const {
    XmlRpc::XmlRpcValue value;
    value.setSize(0);
    for (const std::string& text : texts) value[value.size()] = text;
    set_parameter(private_node_, name, value);
  }

  /// The next life does not ask about the file of that name, in any version.
  void let_go(const std::string& name) {
    for (auto text = interrupted_.begin(); text != interrupted_.end();)
      text = scan_files::ScanFolder::name_in(*text) == name ? interrupted_.erase(text) : std::next(text);
    if (scan_files::ScanFolder::name_in(begun_) == name) begun_.clear();
  }

  void read_next() {
    const std::string path = std::move(files_.front());
    files_.pop_front();
    if (folder_) {
      const std::string name = fs::path(path).filename();
      const std::string text = folder_->text(name);
      again_ = interrupted_.count(text) == 0;
      let_go(name);
      begun_ = text;
      remember();
    }
    scans_.clear();  // played by now, and not to be kept where the next file is refused
    at_ = 0;
    busy_ = true;
    // Until the work is over, whatever comes of it: the stage may drop it.
    const std::shared_ptr<void> turn(nullptr, [this](void*) { busy_ = false; });
    std::error_code gone;                                      // meanwhile
    const std::string work = fmt::format("file {}", ++read_);  // names of files may be customers'
    playing_ = {path, fs::last_write_time(path, gone), 0, work};
    stage_.begin(work);
    stage_.post(work, [this, path, turn]() -> Stage::Result {
      const std::vector<FileScan> scans = scans_in(path, setup_.customer);
      return {[this, scans] {
                scans_ = scans;
                playing_.scans = scans.size();
                at_ = 0;
              },
              {{"file", path}, {"scans", std::to_string(scans.size())}}};
    });
  }

  void publish(const FileScan& file) {
    PointCloud2 scan = *file.points;
    scan.header.stamp = ros::Time::now();
    scan.header.frame_id = setup_.frame_id;
    ScanLabel label = file.label;
    const ScanTag tag = tag_of(scan);
    label.header = tag.header;
    label.scan_id = tag.scan_id;
    labels_.publish(label);
    publisher_.publish(scan);
    published_ = label.scan_id;
    sources_[source_key(published_)] = playing_;
    next_ = ros::SteadyTime::now().toSec() + (setup_.rate > 0 ? 1 / setup_.rate : setup_.interval);
    ROS_INFO("scan_player: scan %s", label.scan_id.c_str());
  }

  const Setup setup_;
  ros::NodeHandle node_, private_node_;
  ros::Publisher publisher_, labels_;
  std::optional<scan_files::ScanFolder> folder_;
  std::size_t read_ = 0;               // files
  std::deque<std::string> files_;      // complete, to be read
  std::set<std::string> interrupted_;  // files that its life before was at, until they are read again
  std::string begun_;                  // the file of a folder that is read or played
  bool again_ = false;                 // whether the node's next life may play that once more
  std::vector<FileScan> scans_;        // of the file read last; the worker's while busy
  Played playing_;
  std::string published_;  // scan_id
  Sources sources_;
  std::size_t at_ = 0;  // of the next one
  double next_ = 0;     // when it may go, seconds of the steady clock
  std::atomic<bool> busy_{false};
  ros::WallTimer clock_;
  Stage stage_;  // last: its worker uses all of the above
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::ScanPlayer>(argc, argv, "scan_player");
}
