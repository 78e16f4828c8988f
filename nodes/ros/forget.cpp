/// forget: one scan, everywhere in a running booth, or in folders where none runs.
#include <fmt/format.h>
#include <ros/ros.h>
#include <tensegric_fit/Forget.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "geometry/status.hpp"
#include "ros/export_folders.hpp"

namespace {

using tensegric_fit::Forget;

constexpr int kDone = 0, kNotEverywhere = 1, kUsage = 2, kRefused = 3;

int said(const Forget::Response& response) {
  fmt::print("{}\n", response.message);
  for (const std::string& line : response.removed) fmt::print("removed: {}\n", line);
  for (const std::string& line : response.not_reached) fmt::print("not reached: {}\n", line);
  return !response.code.empty() ? kRefused : response.complete ? kDone : kNotEverywhere;
}

/// Without nodes: the exports in the folders.
Forget::Response forget_exports(const Forget::Request& request) {
  Forget::Response response;
  bool none = true;
  for (const std::string& folder : request.folders) {
    try {
      std::vector<tensegric_fit::geometry::Refusal> left;
      const auto deleted = tensegric_fit::node::delete_exports(folder, request.scan_id, left);
      for (const std::string& line : lines_of(deleted)) response.removed.push_back(line);
      none = none && deleted.exports.empty() && left.empty();
      for (const auto& refusal : left) response.not_reached.emplace_back(refusal.what());
    } catch (const tensegric_fit::geometry::Refusal& refusal) {
      if (refusal.code() == tensegric_fit::geometry::refusal::kNothingYet) continue;
      response.not_reached.emplace_back(refusal.what());
      none = false;  // there may be one
    }
  }
  if (request.scan_file)
    response.not_reached.emplace_back("the file that it was played from: the scan player knows it");
  response.complete = response.not_reached.empty();
  response.message = fmt::format("no booth is running: looked for exports only{}",
                                 none ? ", and of scan " + request.scan_id + " there was none" : "");
  return response;
}

int forget(const Forget::Request& request) {
  if (!ros::master::check()) {
    if (request.folders.empty()) {
      fmt::print(stderr, "no booth is running, and no --folder is given\n");
      return kUsage;
    }
    return said(forget_exports(request));
  }
  Forget::Response response;
  ros::NodeHandle node;
  Forget::Request asked = request;
  if (!node.serviceClient<Forget>("forget").call(asked, response)) {
    fmt::print(stderr, "the service '{}' does not answer: is the node vault running?\n",
               node.resolveName("forget"));
    return kRefused;
  }
  return said(response);
}

int run(int argc, char** argv) {
  ros::init(argc, argv, "forget", ros::init_options::AnonymousName | ros::init_options::NoRosout);
  Forget::Request request;
  bool scan_file = false;
  CLI::App app(
      "Forgets one scan: what nodes hold of it, and its exports.\nExit: 0 done, 1 not everywhere, 2 usage, 3 "
      "refused.");
  app.add_option("scan_id", request.scan_id, "as reports, exports and /diagnostics give it")->required();
  app.add_option("--folder", request.folders,
                 "exports, or a folder that they lie in; beside those of the node vault");
  app.add_flag("--scan-file", scan_file, "delete also the file that it was played from");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kUsage;
  }
  request.scan_file = scan_file;
  for (std::string& folder : request.folders) folder = std::filesystem::absolute(folder).string();
  return forget(request);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {  // a name of a node that cannot be, for one
    std::cerr << "forget: " << error.what() << '\n';
    return kRefused;
  }
}
