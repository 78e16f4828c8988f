#include "rviz/forgetting.hpp"

#include <rviz/display_group.h>
#include <tensegric_fit/ForgetAnswer.h>

#include <utility>

#include "ros/freed_memory.hpp"
#include "ros/held_scan.hpp"

namespace tensegric_fit::inspect {

Forgetting::Forgetting(rviz::DisplayContext& rviz, LetGo let_go)
    : rviz_(rviz),
      let_go_(std::move(let_go)),
      answers_(node_.advertise<ForgetAnswer>("forget/answer", 4)),
      orders_(node_.subscribe<ForgetOrder>(
          "forget/order", 4, [this](const ForgetOrder::ConstPtr& order) { on_order(*order); })) {}

void Forgetting::on_order(const ForgetOrder& order) {
  if (order.step != ForgetOrder::LET_GO || order.scan_id.empty()) return;
  node::HeldScan::of_process().forget(order.scan_id);
  const bool held = let_go_(order.scan_id);
  rviz_.getRootDisplayGroup()->reset();
  rviz_.queueRender();
  ForgetAnswer answer;
  answer.node = ros::this_node::getName();
  answer.scan_id = order.scan_id;
  answer.step = order.step;
  if (held) answer.removed = {"what it showed"};
  node::give_back_freed_memory();
  answers_.publish(answer);
}

}  // namespace tensegric_fit::inspect
