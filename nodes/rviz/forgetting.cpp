#include "rviz/forgetting.hpp"

#include <ros/ros.h>
#include <rviz/display_group.h>
#include <tensegric_fit/ForgetAnswer.h>
#include <tensegric_fit/ForgetOrder.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ros/freed_memory.hpp"
#include "ros/held_scan.hpp"

namespace tensegric_fit::inspect {

class Forgetting::Desk {
 public:
  Desk()
      : answers_(node_.advertise<ForgetAnswer>("forget/answer", 4)),
        orders_(node_.subscribe<ForgetOrder>(
            "forget/order", 4, [this](const ForgetOrder::ConstPtr& order) { on_order(*order); })) {}

  static std::shared_ptr<Desk> of_process() {
    static std::weak_ptr<Desk> desk;
    std::shared_ptr<Desk> now = desk.lock();
    if (!now) desk = now = std::make_shared<Desk>();
    return now;
  }

  std::vector<Forgetting*> all;

 private:
  void on_order(const ForgetOrder& order) {
    if (order.step != ForgetOrder::LET_GO || order.scan_id.empty()) return;
    node::HeldScan::of_process().forget(order.scan_id);
    ForgetAnswer answer;
    answer.node = ros::this_node::getName();
    answer.scan_id = order.scan_id;
    answer.step = order.step;
    for (const Forgetting* one : all)
      if (one->let_go_(order.scan_id)) answer.removed = {"what it showed"};
    for (const Forgetting* one : all) {
      one->rviz_.getRootDisplayGroup()->reset();
      one->rviz_.queueRender();
    }
    node::give_back_freed_memory();
    answers_.publish(answer);
  }

  ros::NodeHandle node_;
  ros::Publisher answers_;
  ros::Subscriber orders_;
};

Forgetting::Forgetting(rviz::DisplayContext& rviz, LetGo let_go)
    : rviz_(rviz), let_go_(std::move(let_go)), desk_(Desk::of_process()) {
  desk_->all.push_back(this);
}

Forgetting::~Forgetting() {
  desk_->all.erase(std::remove(desk_->all.begin(), desk_->all.end(), this), desk_->all.end());
}

}  // namespace tensegric_fit::inspect
