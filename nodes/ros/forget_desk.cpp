#include "ros/forget_desk.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <fmt/format.h>
#include <tensegric_fit/ForgetOrder.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>

#include "geometry/status.hpp"
#include "ros/await.hpp"
#include "ros/export_folders.hpp"
#include "ros/forgetter.hpp"
#include "ros/log_words.hpp"

namespace tensegric_fit::node {
namespace {

using Names = std::set<std::string>;

const ros::WallDuration kDay(86400);
const geometry::Range kRetention{0, 36500};

using NodesByTopic = std::map<std::string, Names>;

/// As the master has it.
struct Graph {
  NodesByTopic publishers, subscribers;
};

/// None: the master does not answer.
std::optional<Graph> graph_now() {
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, state, false)) return std::nullopt;
  Graph graph;
  for (const auto& [part, nodes] : {std::pair{0, &graph.publishers}, {1, &graph.subscribers}})
    for (int t = 0; t < state[part].size(); ++t)
      for (int i = 0; i < state[part][t][1].size(); ++i)
        (*nodes)[state[part][t][0]].insert(static_cast<std::string>(state[part][t][1][i]));
  return graph;
}

bool is_about_no_body(const std::string& topic, const std::string& forget) {
  return topic == "/diagnostics" || topic == "/rosout" || topic == "/tf" || topic == "/tf_static" ||
         topic == "/clock" || topic.rfind(forget, 0) == 0;
}

/// Namespaces of this master, beside the one of `order`, where somebody gives orders to forget.
Names other_booths(const Graph& graph, const std::string& order) {
  constexpr std::string_view kOrder = "/forget/order";
  Names booths;
  for (const auto& [topic, nodes] : graph.publishers)
    if (topic != order && topic.size() >= kOrder.size() &&
        topic.compare(topic.size() - kOrder.size(), kOrder.size(), kOrder) == 0)
      booths.insert(topic == kOrder ? "/" : topic.substr(0, topic.size() - kOrder.size()));
  return booths;
}

/// Topics that nodes publish or hear which let go of scans, and those that scans and labels come on.
Names body_topics(const Graph& graph, const Names& asked, const ros::NodeHandle& node) {
  Names topics{node.resolveName("scan/points"), node.resolveName("scan/label"),
               node.resolveName("worn/points")};
  const std::string forget = node.resolveName("forget") + "/";
  for (const NodesByTopic* side : {&graph.publishers, &graph.subscribers})  // what drivers latch comes in
    for (const auto& [topic, nodes] : *side)
      if (!is_about_no_body(topic, forget) &&
          std::any_of(nodes.begin(), nodes.end(),
                      [&asked](const std::string& name) { return asked.count(name) != 0; }))
        topics.insert(topic);
  return topics;
}

}  // namespace

VaultOptions vault_options(Parameters parameters) {
  VaultOptions options;
  options.folders = parameters.texts("folders");
  options.retention_days = parameters.number("retention_days", options.retention_days, kRetention);
  parameters.check_all_known();
  for (const std::string& folder : options.folders)
    if (!std::filesystem::path(folder).is_absolute())
      throw geometry::Refusal(geometry::refusal::kBadOption,
                              fmt::format("parameter 'folders': '{}' is not an absolute path", folder));
  if (options.retention_days > 0 && options.folders.empty())
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            "parameter 'retention_days': 'folders' does not say where exports lie");
  return options;
}

ForgetDesk::ForgetDesk(ros::NodeHandle node, const ros::NodeHandle& private_node)
    : node_(node),
      options_(vault_options(Parameters(private_node))),
      orders_(node.advertise<ForgetOrder>("forget/order", 4)),
      spinner_(1, &queue_) {
  answers_in_ =
      node.subscribe<ForgetAnswer>("forget/answer", 64, [this](const ForgetAnswer::ConstPtr& answer) {
        const std::lock_guard<std::mutex> lock(mutex_);
        answers_[answer->node] = *answer;
        answered_.notify_all();
      });
  if (options_.retention_days > 0) {
    diagnostics_ = node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 4);
    delete_old();
    heartbeat_ = node.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) {
      if (look_again_.exchange(false)) delete_old();
      report();
    });
    daily_ = node.createWallTimer(kDay, [this](const ros::WallTimerEvent&) { delete_old(); });
  }
  ros::NodeHandle own(node);
  own.setCallbackQueue(&queue_);
  service_ = own.advertiseService("forget", &ForgetDesk::on_forget, this);
  spinner_.start();
}

void ForgetDesk::delete_old() {
  left_in_.clear();
  std::size_t gone = 0;
  for (const std::string& folder : options_.folders) {
    std::vector<std::string> left;
    std::error_code unknown;
    const bool is_there = std::filesystem::exists(folder, unknown);
    if (unknown) left.push_back(fmt::format("'{}' cannot be looked at: {}", folder, unknown.message()));
    if (is_there) gone += delete_old_exports(folder, options_.retention_days, left).size();
    for (const std::string& why : left)
      ROS_WARN("vault: an old export may be left: %s", log_words(why).c_str());
    if (!left.empty()) left_in_.insert(folder);
  }
  if (gone > 0) ROS_INFO("vault: exports were deleted, as they were old");
}

void ForgetDesk::report() const {
  diagnostic_msgs::DiagnosticStatus status;
  status.name = ros::this_node::getName().substr(1) + ": retention";
  status.hardware_id = "tensegric_fit";
  const bool fine = left_in_.empty();
  status.level = fine ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN;
  status.message = fine ? fmt::format("exports are kept for {} days", options_.retention_days)
                        : fmt::format("old exports may be left in {}", fmt::join(left_in_, ", "));
  diagnostic_msgs::DiagnosticArray array;
  array.header.stamp = ros::Time::now();
  array.status.push_back(status);
  diagnostics_.publish(array);
}

Names ForgetDesk::let_go(const Names& asked, const Forget::Request& request, Forget::Response& response) {
  ForgetOrder order;
  order.step = ForgetOrder::LET_GO;
  order.scan_id = request.scan_id;
  order.scan_file = request.scan_file;
  Names silent = asked;
  std::unique_lock<std::mutex> lock(mutex_);
  answers_.clear();
  orders_.publish(order);
  const auto all = [&] {
    return std::all_of(asked.begin(), asked.end(), [&](const std::string& node) {
      const auto answer = answers_.find(node);
      return answer != answers_.end() && answer->second.scan_id == request.scan_id;
    });
  };
  await(answered_, lock, kForgetPatience, all);
  for (const auto& [node, answer] : answers_) {
    if (answer.scan_id != request.scan_id) continue;
    silent.erase(node);
    for (const std::string& line : answer.removed) response.removed.push_back(node + ": " + line);
    for (const std::string& line : answer.failed) response.not_reached.push_back(node + ": " + line);
  }
  answers_.clear();  // they have names of files
  return silent;
}

bool ForgetDesk::delete_exports_of(const std::string& scan_id, const std::string& folder,
                                   Forget::Response& response) {
  try {
    std::vector<geometry::Refusal> left;
    const DeletedExports deleted = delete_exports(folder, scan_id, left);
    for (const std::string& line : lines_of(deleted)) response.removed.push_back(line);
    for (const geometry::Refusal& refusal : left) response.not_reached.emplace_back(refusal.what());
    return !deleted.exports.empty();
  } catch (const geometry::Refusal& refusal) {
    if (refusal.code() != geometry::refusal::kNothingYet) response.not_reached.emplace_back(refusal.what());
  } catch (const std::filesystem::filesystem_error& error) {
    response.not_reached.push_back(folder + ": " + error.code().message());
  }
  return false;
}

bool ForgetDesk::on_forget(Forget::Request& request, Forget::Response& response) {
  if (request.scan_id.empty()) {
    response.code = geometry::refusal::kBadOption;
    response.message = "which scan is to be forgotten?";
    return true;
  }
  std::optional<Graph> before = graph_now();  // nodes that let go publish nothing for a moment
  if (!before) {
    response.code = geometry::refusal::kDeadStage;
    response.message =
        "the ROS master does not answer: which nodes hold the scan is not known, and nothing was forgotten";
    return true;
  }
  // A recorder hears orders, too, and answers none: it is named by what it hears.
  const Names &hear = before->subscribers[node_.resolveName("forget/order")],
              &answer = before->publishers[node_.resolveName("forget/answer")];
  Names asked;
  std::set_intersection(hear.begin(), hear.end(), answer.begin(), answer.end(),
                        std::inserter(asked, asked.end()));
  for (const std::string& node : let_go(asked, request, response))
    response.not_reached.push_back(node + ": did not answer");
  ForgetOrder go_on;
  go_on.step = ForgetOrder::GO_ON;
  go_on.scan_id = request.scan_id;
  orders_.publish(go_on);
  bool was_there = !response.removed.empty();
  for (const std::string& folder : options_.folders) {
    std::error_code unknown;
    const bool is_there = std::filesystem::exists(folder, unknown);  // else there was no export so far
    if (unknown) response.not_reached.push_back(folder + ": " + unknown.message());
    if (is_there && delete_exports_of(request.scan_id, folder, response)) was_there = true;
  }
  for (const std::string& folder : request.folders)
    if (delete_exports_of(request.scan_id, folder, response)) was_there = true;
  look_again_ = true;
  const auto is_of_file = [](const std::string& line) {
    return line.find(": the file ") != std::string::npos;
  };
  const bool file_is_known =
      std::any_of(response.removed.begin(), response.removed.end(), is_of_file) ||
      std::any_of(response.not_reached.begin(), response.not_reached.end(), is_of_file);
  if (request.scan_file && !file_is_known)
    response.not_reached.emplace_back("the file that it was played from, if it was: no node knows of it");
  std::optional<Graph> now = graph_now();
  if (!now)
    response.not_reached.emplace_back("nodes that came meanwhile: the ROS master does not answer any more");
  response.complete = response.not_reached.empty();
  Names booths = other_booths(*before, node_.resolveName("forget/order"));
  if (now) booths.merge(other_booths(*now, node_.resolveName("forget/order")));
  const char* done = response.complete && was_there ? "forgotten"
                     : response.complete            ? "nothing of it was found"
                     : was_there                    ? "forgotten, but not everywhere"
                                                    : "nothing of it was deleted, and it may be left";
  response.message = fmt::format("scan {}: {}{}", request.scan_id, done,
                                 booths.empty() ? "" : ", in " + node_.getNamespace() + " alone");
  for (const std::string& booth : booths)
    response.not_reached.push_back(booth + ": another booth, which was not asked");
  for (const std::string& topic : body_topics(*before, asked, node_)) {
    Names others;  // who hears it, and who publishes, and may latch, it
    for (std::optional<Graph>* at : {&before, &now})
      if (*at)
        for (NodesByTopic* side : {&(*at)->subscribers, &(*at)->publishers})
          others.insert((*side)[topic].begin(), (*side)[topic].end());
    for (const std::string& node : others)
      if (asked.count(node) == 0)
        response.not_reached.push_back(node + ": what it keeps, latches or shows of " + topic);
  }
  if (!request.scan_file && !file_is_known)
    response.not_reached.emplace_back("the file that it was played from, where it was");
  response.not_reached.emplace_back(
      "bags, copies of exports, results of fit, pages of history, other machines, backups, swap, blocks of "
      "the disk that are free");
  return true;
}

}  // namespace tensegric_fit::node
