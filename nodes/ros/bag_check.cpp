#include "ros/bag_check.hpp"

#include <fmt/format.h>
#include <rosbag/bag.h>
#include <tensegric_fit/BodyModel.h>
#include <tensegric_fit/DeformedMesh.h>
#include <tensegric_fit/FitState.h>
#include <tensegric_fit/Garment.h>
#include <tensegric_fit/ScanLabel.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "files/bag_structure.hpp"
#include "files/checked_message.hpp"
#include "ros/bag_scans.hpp"
#include "ros/body_messages.hpp"

namespace tensegric_fit::node {
namespace {

constexpr double kGap = 5;  // a gap this many times as long as the middle one is worth a word

template <typename Message>
std::pair<std::string, std::string> version_of() {
  return {ros::message_traits::datatype<Message>(), ros::message_traits::md5sum<Message>()};
}

/// Versions of the messages that a replay sends or that the chain has written.
const std::map<std::string, std::string>& known_versions() {
  static const std::map<std::string, std::string> versions = {version_of<sensor_msgs::PointCloud2>(),
                                                              version_of<Garment>(),
                                                              version_of<ScanLabel>(),
                                                              version_of<BodyModel>(),
                                                              version_of<TriangleMesh>(),
                                                              version_of<Landmarks>(),
                                                              version_of<ControlMesh>(),
                                                              version_of<FitState>(),
                                                              version_of<DeformedMesh>(),
                                                              version_of<tf2_msgs::TFMessage>()};
  return versions;
}

class BagReader {
 public:
  explicit BagReader(const rosbag::Bag& bag) : view_(bag) {}

  BagCheck read() {
    if (view_.size() == 0) {
      find(true, "empty_bag", "the bag holds no messages",
           "record while the booth publishes: rosbag record -O scan.bag /scan/points");
      return std::move(check_);
    }
    check_connections();
    ScanChecker scans(check_);
    for (const rosbag::MessageInstance& message : view_) {
      count(message);
      if (outdated_.count(message.getTopic())) continue;
      scans.look_at(message);
      look_for_outputs(message);
    }
    scans.finish();
    finish_topics(scans);
    return std::move(check_);
  }

 private:
  void find(bool hinders, const std::string& name, const std::string& what, const std::string& advice) {
    check_.findings.push_back({hinders, name, what, advice});
  }

  void check_connections() {
    if (const std::set<std::string> booths = booths_in(view_); !booths.empty())
      find(true, "many_booths", fmt::format("more than one booth is in the bag: {}", fmt::join(booths, ", ")),
           "take one out: rosbag filter BAG ONE.bag \"topic.startswith(('/ONE/', '/tf'))\", with ONE for its "
           "namespace");
    for (const rosbag::ConnectionInfo* connection : view_.getConnections()) {
      BagTopic& topic = topics_[connection->topic];
      topic.name = connection->topic;
      topic.type = connection->datatype;
      topic.md5 = connection->md5sum;
      const auto known = known_versions().find(connection->datatype);
      if (known == known_versions().end() || known->second == connection->md5sum) continue;
      if (!outdated_.insert(connection->topic).second) continue;
      find(true, "other_version",
           fmt::format("{}: {} of another version: md5 {}, this build has {}", connection->topic,
                       connection->datatype, connection->md5sum, known->second),
           "record again with this version, or convert it: rosbag fix old.bag new.bag "
           "$(rospack find tensegric_fit)/launch/migration/*.bmr");
    }
  }

  void count(const rosbag::MessageInstance& message) {
    BagTopic& topic = topics_[message.getTopic()];
    const double time = message.getTime().toSec();
    if (topic.messages == 0) topic.first = time;
    if (topic.messages != 0) gaps_[topic.name].push_back(time - topic.last);
    topic.last = time;
    ++topic.messages;
  }

  // What a chain has written belongs together: a latched topic that was published before a split is missing.
  void look_for_outputs(const rosbag::MessageInstance& message) {
    if (const auto body = files::checked_message<TriangleMesh>(message)) bodies_.insert(body->scan_id);
    if (const auto model = files::checked_message<BodyModel>(message)) modelled_.insert(model->scan_id);
    if (const auto fit = files::checked_message<FitState>(message))
      dressed_[fit->scan_id] = message.getTopic();
    if (const auto deformed = files::checked_message<DeformedMesh>(message))
      dressed_[deformed->scan_id] = message.getTopic();
  }

  void finish_topics(const ScanChecker& scans) {
    for (const auto& [scan_id, topic] : dressed_)
      if (bodies_.count(scan_id) == 0)
        find(
            true, "lost_latched", fmt::format("{}: no body/mesh of scan {} is in the bag", topic, scan_id),
            "the latched body/mesh went into an earlier part of a split recording: join the parts, or record "
            "with --repeat-latched");
    for (const std::string& scan_id : bodies_)
      if (modelled_.count(scan_id) == 0)
        find(false, "no_model",
             fmt::format("no body/model of scan {} is in the bag, its body/mesh is", scan_id),
             "played to the landmarks, the mesh waits 3 s and has the model registered again: record "
             "body/model, too");
    for (auto& [name, topic] : topics_) {
      std::vector<double>& gaps = gaps_[name];
      if (!gaps.empty()) topic.largest_gap = *std::max_element(gaps.begin(), gaps.end());
      topic.frames = fmt::format("{}", fmt::join(scans.frames_of(name), " "));
      check_gaps(topic, gaps);
      check_.topics.push_back(topic);
    }
  }

  void check_gaps(const BagTopic& topic, std::vector<double>& gaps) {
    if (gaps.size() < 3 || topic.type != ros::message_traits::datatype<sensor_msgs::PointCloud2>()) return;
    const auto middle = gaps.begin() + static_cast<long>(gaps.size() / 2);
    std::nth_element(gaps.begin(), middle, gaps.end());
    if (topic.largest_gap > kGap * *middle)
      find(false, "gap",
           fmt::format("{}: {:.3g} s without a message, where {:.3g} s are usual", topic.name,
                       topic.largest_gap, *middle),
           "look whether the recorder dropped scans: a larger --buffsize, a faster disk");
  }

  rosbag::View view_;
  BagCheck check_;
  std::map<std::string, BagTopic> topics_;
  std::map<std::string, std::vector<double>> gaps_;
  std::set<std::string> outdated_;           // topics whose messages cannot be read
  std::set<std::string> bodies_, modelled_;  // scan_ids
  std::map<std::string, std::string> dressed_;
};

BagCheck unreadable(const std::string& name, const std::string& what, const std::string& advice) {
  BagCheck check;
  check.findings.push_back({true, name, what, advice});
  return check;
}

}  // namespace

bool BagCheck::can_be_replayed() const {
  return std::none_of(findings.begin(), findings.end(), [](const BagFinding& f) { return f.hinders; });
}

std::set<std::string> booths_in(rosbag::View& bag) {
  std::set<std::string> topics, namespaces;
  for (const rosbag::ConnectionInfo* connection : bag.getConnections()) {
    const std::string topic = connection->topic.substr(
        std::min(connection->topic.find_first_not_of('/'), connection->topic.size()));
    const bool is_scan = files::is_scan_topic(topic);
    if (!is_scan && connection->datatype != ros::message_traits::datatype<Garment>()) continue;
    topics.insert(topic);
    const std::size_t name = is_scan ? sizeof "scan/points" - 1 : topic.size() - (topic.rfind('/') + 1);
    namespaces.insert(topic.substr(0, topic.size() - name));
  }
  return namespaces.size() > 1 ? topics : std::set<std::string>();
}

BagCheck check_bag(const std::string& path) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none))
    return unreadable("no_file", path + ": there is no such file", "look at the path");
  try {
    files::check_bag_structure(path);
    const rosbag::Bag bag(path, rosbag::bagmode::Read);
    return BagReader(bag).read();
  } catch (const rosbag::BagUnindexedException&) {
    return unreadable("unindexed_bag", path + ": has no index: its recording was cut off",
                      "rosbag reindex " + path + " saves what is whole");
  } catch (const std::exception& error) {  // rosbag and its streams throw many kinds
    return unreadable("broken_bag", path + ": is truncated, or is no bag: " + error.what(),
                      "copy it again; rosbag reindex saves what is whole");
  }
}

std::string to_text(const BagCheck& check, const std::string& path) {
  std::string text =
      fmt::format("{}: {}\n", path, check.can_be_replayed() ? "can be replayed" : "CANNOT be replayed");
  for (const BagFinding& finding : check.findings)
    text += fmt::format("  {} {}: {}\n      {}\n", finding.hinders ? "fault" : "note ", finding.name,
                        finding.what, finding.advice);
  for (const BagTopic& topic : check.topics)
    text += fmt::format("  {:<24} {:<28} {} {:>5} messages in {:.3f} s, largest gap {:.3f} s{}\n", topic.name,
                        topic.type, topic.md5.substr(0, 8), topic.messages, topic.last - topic.first,
                        topic.largest_gap, topic.frames.empty() ? "" : ", frames: " + topic.frames);
  for (const BagScan& scan : check.scans)
    text += fmt::format("  scan {} on {}: {} points, {:.1f} % not finite\n", scan.scan_id, scan.topic,
                        scan.points, 100 * scan.not_finite);
  return text;
}

}  // namespace tensegric_fit::node
