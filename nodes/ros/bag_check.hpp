/// Whether a bag can be replayed through the chain, and what to do where it cannot.
#pragma once

#include <rosbag/view.h>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace tensegric_fit::node {

/// Something that whoever recorded the bag should know.
struct BagFinding {
  bool hinders;        ///< the bag cannot be replayed because of it
  std::string name;    ///< one per cause: empty_bag, stamps_backwards, ...
  std::string what;    ///< a sentence that names topic and message
  std::string advice;  ///< what to do about it
};

/// A topic of one type and version.
struct BagTopic {
  std::string name, type, md5;
  std::size_t messages = 0;
  double first = 0, last = 0;  ///< record times, seconds
  double largest_gap = 0;      ///< seconds between two messages
  std::string frames;          ///< of its headers, with spaces between them
};

/// A scan of the bag.
struct BagScan {
  std::string topic, scan_id;
  std::size_t points = 0;
  double not_finite = 0;  ///< share of the points
};

struct BagCheck {
  std::vector<BagTopic> topics;  ///< by name
  std::vector<BagScan> scans;    ///< in order of recording
  std::vector<BagFinding> findings;

  bool can_be_replayed() const;
};

/// Names of findings that hinder: no_file, broken_bag, unindexed_bag, empty_bag, other_version, many_booths,
/// wrong_topic, no_scan, wrong_type, stamps_backwards, bad_scan, lost_latched; of others: gap, no_stamp,
/// no_frame, many_frames, sensors, no_tf, not_finite, no_model. Never throws for what is in the bag.
BagCheck check_bag(const std::string& path);

/// The topics of scans and garments, where they are of several booths: what came from two is no one's.
/// Empty: one booth's bag.
std::set<std::string> booths_in(rosbag::View& bag);

/// A page of text for people, the verdict first.
std::string to_text(const BagCheck& check, const std::string& path);

}  // namespace tensegric_fit::node
