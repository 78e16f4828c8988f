#include "compare.hpp"

#include <fmt/format.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "case.hpp"
#include "compare_skin.hpp"
#include "geometry/status.hpp"
#include "message_fields.hpp"
#include "recording.hpp"

namespace tensegric_fit::regression {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kShort = 4;   // values of a field that is shown as it is
constexpr double kRounding = 1e-9;  // of metres, ratios, residuals: named last

bool is_payload(const std::string& topic, const std::string& field) {
  const auto ends = [&](const std::string& ending) {
    return field.size() >= ending.size() &&
           field.compare(field.size() - ending.size(), ending.size(), ending) == 0;
  };
  if (ends("header.seq")) return false;
  if (topic == "control/deformed" && field == "milliseconds") return false;
  return !(topic == "garment" && ends("header.stamp"));  // when somebody asked for it
}

const Field* find(const std::vector<Field>& fields, const std::string& path) {
  for (const Field& field : fields)
    if (field.path == path) return &field;
  return nullptr;
}

using Messages = std::map<std::string, std::vector<std::vector<Field>>>;  // by topic

/// Scans in their order, each with its messages; first what belongs to no scan.
struct Content {
  std::vector<std::string> scans;
  std::map<std::string, Messages> by_scan;
};

Content content_of(const std::string& path) {
  Content content;
  const rosbag::Bag bag(path, rosbag::bagmode::Read);
  rosbag::View view(bag);
  std::map<std::string, MessageReader> readers;  // by topic and version
  std::string scan;
  for (const rosbag::MessageInstance& message : view) {
    const std::string topic = chain_topic(message.getTopic());
    if (topic.empty()) continue;
    const auto reader =
        readers
            .try_emplace(topic + message.getMD5Sum(), message.getDataType(), message.getMessageDefinition())
            .first;
    std::vector<std::uint8_t> bytes(message.size());
    ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    message.write(stream);
    std::vector<Field> fields = reader->second.fields_of(bytes);
    const Field* status = find(fields, "status");
    if (status != nullptr && status->words == std::vector<std::string>{"solving"}) continue;
    const Field* id = find(fields, "scan_id");
    if (id != nullptr && !id->words.empty()) scan = id->words.front();
    const std::string owner = id != nullptr ? scan : "";
    if (content.by_scan.try_emplace(owner).second && !owner.empty()) content.scans.push_back(owner);
    content.by_scan[owner][topic].push_back(std::move(fields));
  }
  return content;
}

std::string shown(const Field* field) {
  if (field == nullptr) return "not there";
  const std::size_t size = field->numbers.size() + field->words.size();
  if (size > kShort) return fmt::format("{} values", size);
  if (size == 0) return "empty";
  return field->words.empty() ? fmt::format("{:.9g}", fmt::join(field->numbers, " "))
                              : fmt::format("{}", fmt::join(field->words, ", "));
}

bool other_number(double a, double b) {
  return a != b && !(std::isnan(a) && std::isnan(b));
}

std::optional<FieldDifference> difference(const Field* one, const Field* other) {
  FieldDifference found;
  found.one = shown(one);
  found.other = shown(other);
  found.share = 1;
  if (one == nullptr || other == nullptr || one->numbers.size() != other->numbers.size() ||
      one->words.size() != other->words.size()) {
    found.differing = found.of = 1;
    return found;
  }
  found.of = one->numbers.size() + one->words.size();
  for (std::size_t i = 0; i < one->words.size(); ++i) found.differing += one->words[i] != other->words[i];
  if (one->words.empty()) found.share = 0;
  double largest = 0;
  for (std::size_t i = 0; i < one->numbers.size(); ++i) {
    const double a = one->numbers[i], b = other->numbers[i];
    if (std::isfinite(a)) largest = std::max({largest, std::abs(a), std::isfinite(b) ? std::abs(b) : 0});
    if (!other_number(a, b)) continue;
    ++found.differing;
    const double off =
        std::isfinite(a) && std::isfinite(b) ? std::abs(a - b) : std::numeric_limits<double>::infinity();
    if (off > found.most) {
      found.most = off;
      found.where = i;
    }
  }
  if (found.differing == 0) return std::nullopt;
  if (one->words.empty()) found.share = found.most > kRounding ? std::min(1.0, found.most / largest) : 0;
  return found;
}

void compare_messages(const std::vector<Field>& one, const std::vector<Field>& other, int message,
                      TopicDifference& topic) {
  std::map<std::string, const Field*> others;
  for (const Field& field : other) others[field.path] = &field;
  const auto add = [&](const std::string& path, const Field* a, const Field* b) {
    if (!is_payload(topic.topic, path)) return;
    std::optional<FieldDifference> found = difference(a, b);
    if (!found) return;
    found->topic = topic.topic;
    found->message = message;
    found->field = path;
    topic.fields.push_back(std::move(*found));
  };
  for (const Field& field : one) {
    const auto same = others.find(field.path);
    add(field.path, &field, same == others.end() ? nullptr : same->second);
    if (same != others.end()) others.erase(same);
  }
  for (const auto& [path, field] : others) add(path, nullptr, field);
}

void compare_topics(const Messages& one, const Messages& other, RunComparison& result) {
  for (const std::string& name : kChainTopics) {
    const auto a = one.find(name), b = other.find(name);
    if (a == one.end() && b == other.end()) continue;
    TopicDifference topic{name, 0, 0, {}};
    topic.one = a == one.end() ? 0 : static_cast<int>(a->second.size());
    topic.other = b == other.end() ? 0 : static_cast<int>(b->second.size());
    for (int i = 0; i < std::min(topic.one, topic.other); ++i)
      compare_messages(a->second[static_cast<std::size_t>(i)], b->second[static_cast<std::size_t>(i)], i,
                       topic);
    std::stable_sort(topic.fields.begin(), topic.fields.end(),
                     [](const FieldDifference& x, const FieldDifference& y) { return x.share > y.share; });
    result.topics.push_back(std::move(topic));
  }
}

std::string bag_in(const fs::path& folder) {
  for (const char* name : {"result.bag", "replayed.bag"})
    if (fs::exists(folder / name)) return folder / name;
  return "";
}

}  // namespace

bool RunComparison::same() const {
  return notes.empty() && std::all_of(topics.begin(), topics.end(), [](const TopicDifference& topic) {
           return topic.fields.empty() && topic.one == topic.other;
         });
}

RunComparison compare_bags(const std::string& one, const std::string& other) {
  RunComparison result;
  result.one = one;
  result.other = other;
  const auto read = [](const std::string& bag) { return read_bag(bag, [&] { return content_of(bag); }); };
  const Content a = read(one), b = read(other);
  if (a.by_scan.empty() || b.by_scan.empty())
    throw geometry::Refusal(geometry::refusal::kBrokenFile,
                            (a.by_scan.empty() ? one : other) + ": holds nothing that comes out of a chain");
  if (a.scans.size() != b.scans.size())
    result.notes.push_back(fmt::format("{} scans in one, {} in the other: the first {} are compared",
                                       a.scans.size(), b.scans.size(),
                                       std::min(a.scans.size(), b.scans.size())));
  const auto of = [](const Content& content, const std::string& scan) {
    const auto found = content.by_scan.find(scan);
    return found == content.by_scan.end() ? Messages() : found->second;
  };
  compare_topics(of(a, ""), of(b, ""), result);
  for (std::size_t i = 0; i < std::min(a.scans.size(), b.scans.size()); ++i) {
    if (a.scans[i] != b.scans[i])
      result.notes.push_back(fmt::format("other scans: {} and {}", a.scans[i], b.scans[i]));
    compare_topics(of(a, a.scans[i]), of(b, b.scans[i]), result);
    compare_skins({one, a.scans[i]}, {other, b.scans[i]}, result);
  }
  return result;
}

std::vector<RunComparison> compare_runs(const std::string& one, const std::string& other) {
  if (fs::is_directory(one) != fs::is_directory(other))
    throw geometry::Refusal(kBadCase, "two bags, or two folders of `regression --out`, not one of each");
  if (!fs::is_directory(one)) return {compare_bags(one, other)};
  if (!bag_in(one).empty() && !bag_in(other).empty()) return {compare_bags(bag_in(one), bag_in(other))};
  std::set<std::string> names;
  for (const std::string& folder : {one, other})
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      if (!bag_in(entry.path()).empty()) names.insert(entry.path().filename());
  std::vector<RunComparison> comparisons;
  bool in_common = false;
  for (const std::string& name : names) {
    const std::string a = bag_in(one / fs::path(name)), b = bag_in(other / fs::path(name));
    if (a.empty() || b.empty()) {
      comparisons.emplace_back();
      comparisons.back().one = a;
      comparisons.back().other = b;
      comparisons.back().notes = {"only " + (a.empty() ? other : one) + " has this case"};
    } else {
      comparisons.push_back(compare_bags(a, b));
      in_common = true;
    }
    comparisons.back().name = name;
  }
  if (!in_common) throw geometry::Refusal(kBadCase, one + " and " + other + " have no case in common");
  return comparisons;
}

}  // namespace tensegric_fit::regression
