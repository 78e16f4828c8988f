/// Bag in, bag out: sends each scan and garment of a bag through a running chain and writes down what comes
/// out.

#include <fmt/format.h>

#include <fcntl.h>

#include <filesystem>
#include <memory>

#include "files/bag_structure.hpp"
#include "files/checked_message.hpp"
#include "files/descriptor.hpp"
#include "files/owner_only.hpp"
#include "geometry/status.hpp"
#include "ros/bag_check.hpp"
#include "ros/log_words.hpp"
#include "ros/parameters.hpp"
#include "ros/replay.hpp"

namespace tensegric_fit::node {
namespace {

struct Setup {
  std::string bag, out;
  Replay::Options options;
};

Setup setup_from(const ros::NodeHandle& private_node) {
  Setup setup;
  Parameters parameters(private_node);
  setup.bag = parameters.text("bag", "");
  setup.out = parameters.text("out", "");
  setup.options.timeout = parameters.number("timeout", setup.options.timeout, {1, 86400});
  setup.options.measure_only = parameters.flag("measure_only", setup.options.measure_only);
  parameters.check_all_known();
  if (setup.out.empty() || std::filesystem::exists(setup.out))
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            "parameter 'out': '" + setup.out + "' is empty or there already");
  return setup;
}

/// A bag that is written to its end, or is not there.
class WholeBag {
 public:
  /// \throw filesystem_error
  explicit WholeBag(const std::string& path) : unfinished_(path + ".active") {
    std::filesystem::remove(unfinished_);  // a link to elsewhere, or what one that was interrupted has left
    files::Descriptor(unfinished_, O_WRONLY | O_CREAT | O_EXCL);
    try {
      bag_ = std::make_unique<rosbag::Bag>(unfinished_, rosbag::bagmode::Write);
    } catch (...) {
      std::filesystem::remove(unfinished_);
      throw;
    }
  }
  ~WholeBag() {
    if (!bag_) return;
    static_cast<void>(bag_.release());  // its end writes, and where the disk is full it ends the process
    std::error_code gone;
    std::filesystem::remove(unfinished_, gone);
  }
  WholeBag(const WholeBag&) = delete;
  WholeBag& operator=(const WholeBag&) = delete;

  rosbag::Bag& operator*() { return *bag_; }

  /// \throw rosbag::BagException, filesystem_error
  void finish(const std::string& path) {
    bag_->close();
    std::filesystem::rename(unfinished_, path);
    bag_.reset();
  }

 private:
  const std::string unfinished_;
  std::unique_ptr<rosbag::Bag> bag_;
};

/// Number of messages that were not answered: with any, the output is OUT.incomplete. \throw
/// rosbag::BagException, filesystem_error, Refusal
int run(const Setup& setup) {
  files::check_bag_structure(setup.bag);
  rosbag::Bag in(setup.bag, rosbag::bagmode::Read);
  rosbag::View view(in);
  if (const std::set<std::string> booths = booths_in(view); !booths.empty())
    throw geometry::Refusal(
        geometry::refusal::kBrokenFile,
        fmt::format("'{}' is of more than one booth: {}; check_bag says how to take one out", setup.bag,
                    fmt::join(booths, ", ")));
  WholeBag out(setup.out);
  Replay replay(ros::NodeHandle{}, setup.options);
  const std::vector<std::string> missing = replay.wait_for_chain();
  if (!missing.empty())
    throw std::runtime_error(
        fmt::format("the chain did not come up: nobody serves {}", fmt::join(missing, ", ")));

  int sent = 0, lost = 0;
  // A bag does not say which of the messages of one time came first: a scan belongs to the label and garment
  // of its time.
  std::vector<rosbag::MessageInstance> scans;
  const auto send_scans = [&] {
    for (const rosbag::MessageInstance& message : scans) {
      ++sent;
      lost +=
          !replay.send(*files::checked_message<sensor_msgs::PointCloud2>(message), message.getTime(), *out);
    }
    scans.clear();
  };
  for (const rosbag::MessageInstance& message : view) {
    if (!scans.empty() && scans.front().getTime() != message.getTime()) send_scans();
    if (files::is_scan_topic(message.getTopic()) && files::checked_message<sensor_msgs::PointCloud2>(message))
      scans.push_back(message);
    if (const auto label = files::checked_message<ScanLabel>(message))
      replay.send(*label, message.getTime(), *out);
    if (const auto garment = files::checked_message<Garment>(message))
      lost += !replay.send(*garment, message.getTime(), *out);
  }
  send_scans();
  if (sent == 0)
    throw geometry::Refusal(geometry::refusal::kBrokenFile, "no scan/points in '" + setup.bag + "'");
  out.finish(lost == 0 ? setup.out : setup.out + ".incomplete");
  return lost;
}

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  tensegric_fit::files::owner_only();
  ros::init(argc, argv, "replay");
  ros::NodeHandle private_node("~");
  try {
    return tensegric_fit::node::run(tensegric_fit::node::setup_from(private_node)) == 0 ? 0 : 1;
  } catch (const tensegric_fit::geometry::Refusal& refusal) {
    ROS_FATAL("replay: %s: %s", refusal.code().c_str(),
              tensegric_fit::node::without_files(refusal.what()).c_str());
    return 2;
  } catch (const std::exception& error) {
    ROS_FATAL("replay: %s", tensegric_fit::node::without_files(error.what()).c_str());
    return 1;
  }
}
