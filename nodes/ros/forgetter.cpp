#include "ros/forgetter.hpp"

#include <ros/callback_queue.h>

#include "ros/held_scan.hpp"

namespace tensegric_fit::node {
namespace {

const ros::WallDuration kTick(0.05);
// Who ordered it may be gone, or waits for a node that has died: the next customer must not.
const ros::WallDuration kOrdererPatience(2);
// Another scan that is worked on is ended first, but scans that come without end are not waited for.
const ros::WallDuration kWorkPatience(10);

/// While ROS shuts down its queue is disabled, and waits for nothing.
void call_callbacks() {
  ros::getGlobalCallbackQueue()->callAvailable(kTick);
  if (ros::isShuttingDown()) kTick.sleep();
}

}  // namespace

Forgetter::Forgetter(ros::NodeHandle node)
    : answers_(node.advertise<ForgetAnswer>("forget/answer", 4)),
      orders_(node.subscribe<ForgetOrder>(
          "forget/order", 4, [this](const ForgetOrder::ConstPtr& order) { on_order(*order); })) {}

void Forgetter::on_order(const ForgetOrder& order) {
  go_on_ = order.step == ForgetOrder::GO_ON;
  if (go_on_ || order.scan_id.empty()) return;
  HeldScan::of_process().forget(order.scan_id);
  if (forget_) {
    ForgetAnswer done;
    forget_(order, done);
    answer(order, done);
  } else if (HeldScan::of_process().holds(order.scan_id)) {
    order_ = order;
    ordered_ = ros::SteadyTime::now();
  } else {
    answer(order, {});
  }
}

void Forgetter::answer(const ForgetOrder& order, ForgetAnswer answer) {
  answer.node = ros::this_node::getName();
  answer.scan_id = order.scan_id;
  answer.step = order.step;
  give_back_freed_memory();  // to the system, which clears it before others get it
  answers_.publish(answer);
}

bool Forgetter::serve(const Forget& forget) {
  forget_ = forget;
  while (ros::ok()) {
    call_callbacks();
    freed_.look(HeldScan::of_process().is_busy(), std::chrono::steady_clock::now());
    if (!order_ || (HeldScan::of_process().must_finish(order_->scan_id) &&
                    ros::SteadyTime::now() - ordered_ < kWorkPatience))
      continue;
    if (HeldScan::of_process().holds(order_->scan_id)) return true;
    ForgetAnswer done;  // what it worked on has taken the place of it
    done.removed = {"replaced by a newer scan"};
    answer(*order_, done);
    order_.reset();
  }
  return false;
}

void Forgetter::let_go() {
  ForgetAnswer done;
  done.removed = {"what it held, and its latched messages"};
  answer(*order_, done);
  order_.reset();
  for (const ros::SteadyTime end = ros::SteadyTime::now() + kOrdererPatience;
       ros::ok() && !go_on_ && ros::SteadyTime::now() < end;)
    call_callbacks();
}

}  // namespace tensegric_fit::node
