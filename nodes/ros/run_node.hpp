/// The main function of every stage node.
#pragma once

#include <ros/ros.h>

#include <exception>
#include <string>
#include <type_traits>
#include <utility>

#include "files/owner_only.hpp"
#include "geometry/status.hpp"
#include "ros/forgetter.hpp"
#include "ros/held_scan.hpp"
#include "ros/log_folder.hpp"
#include "ros/log_words.hpp"
#include "ros/memory_limit.hpp"

namespace tensegric_fit::node {

/// Whether a node forgets a scan by a function of its own, because it must not restart.
template <typename Node, typename = void>
struct Forgets : std::false_type {};
template <typename Node>
struct Forgets<Node, std::void_t<decltype(std::declval<Node&>().forget(std::declval<const ForgetOrder&>(),
                                                                       std::declval<ForgetAnswer&>()))>>
    : std::true_type {};

/// One life of a node, whose end is also that of all that it holds and latches. True: it forgets a scan and
/// has to restart.
template <typename Node>
bool serve_node(Forgetter& forgetter) {
  ros::NodeHandle private_node("~");
  HeldScan::of_process().clear();
  Node node(ros::NodeHandle{}, private_node);
  if constexpr (Forgets<Node>::value)
    return forgetter.serve(
        [&node](const ForgetOrder& order, ForgetAnswer& done) { node.forget(order, done); });
  else if (!forgetter.serve())
    return false;
  private_node.deleteParam("worn");
  return true;
}

/// Exit codes: 0 shut down, 1 an error nobody foresaw, 2 a parameter or file of its own was refused.
template <typename Node>
int run_node(int argc, char** argv, const std::string& name) {
  files::owner_only();
  limit_memory();
  ros::init(argc, argv, name);
  const ros::NodeHandle running;
  // At the end of this function, not among static objects: stages keep a handle for as long as the process
  // lives.
  const struct Shutdown {
    ~Shutdown() { ros::shutdown(); }
  } at_end{};
  try {
    close_log_folder();
    Forgetter forgetter{ros::NodeHandle{}};
    while (serve_node<Node>(forgetter)) forgetter.let_go();
    return 0;
  } catch (const geometry::Refusal& refusal) {
    ROS_FATAL("%s: %s: %s", name.c_str(), refusal.code().c_str(), without_files(refusal.what()).c_str());
    return 2;
  } catch (const std::exception& error) {
    ROS_FATAL("%s: %s", name.c_str(), without_files(error.what()).c_str());
    return 1;
  }
}

}  // namespace tensegric_fit::node
