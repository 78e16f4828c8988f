/// The part of a node in `forget`.
#pragma once

#include <ros/ros.h>
#include <tensegric_fit/ForgetAnswer.h>
#include <tensegric_fit/ForgetOrder.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ros/freed_memory.hpp"

namespace tensegric_fit::node {

/// For how long the vault waits for a node's answer: a stage that works on the next scan ends that first,
/// where it can in 10 s.
inline constexpr std::chrono::seconds kForgetPatience(15);

/// Hears the orders and answers them. For the main thread.
class Forgetter {
 public:
  /// What a node that goes on by itself does: fills `removed` and `failed`.
  using Forget = std::function<void(const ForgetOrder&, ForgetAnswer&)>;

  explicit Forgetter(ros::NodeHandle node);

  /// Serves callbacks until this process is to let go of a scan that it holds. False: it is shut down. With
  /// `forget` the node does it itself and serves on.
  bool serve(const Forget& forget = {});

  /// To be called when nothing is held any more: says so, and waits until all nodes have let go, 2 s at most:
  /// what others latch of it meanwhile is not taken (HeldScan::is_forgotten).
  void let_go();

 private:
  void on_order(const ForgetOrder& order);
  void answer(const ForgetOrder& order, ForgetAnswer answer);

  ros::Publisher answers_;
  ros::Subscriber orders_;
  Forget forget_;
  std::optional<ForgetOrder> order_;  // to let go, not yet followed
  ros::SteadyTime ordered_;           // when it came
  bool go_on_ = false;
  FreedMemory freed_;
};

}  // namespace tensegric_fit::node
