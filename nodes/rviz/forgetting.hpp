/// rviz's part in `forget`.
#pragma once

#include <functional>
#include <string>

#ifndef Q_MOC_RUN
#include <ros/ros.h>
#include <rviz/display_context.h>
#include <tensegric_fit/ForgetOrder.h>
#endif

namespace tensegric_fit::inspect {

/// A panel or a display lets go of a scan when the vault orders it, and the vault has an answer. rviz's own
/// displays, which do not know of what scan they show something, are all reset: one of points or markers
/// stays empty until something comes again. What comes of the scan later is for node::is_of_forgotten.
class Forgetting {
 public:
  /// False: nothing of that scan was held. Called where rviz calls its subscribers.
  using LetGo = std::function<bool(const std::string& scan_id)>;

  Forgetting(rviz::DisplayContext& rviz, LetGo let_go);

 private:
  void on_order(const ForgetOrder& order);

  rviz::DisplayContext& rviz_;
  const LetGo let_go_;
  ros::NodeHandle node_;
  ros::Publisher answers_;
  ros::Subscriber orders_;
};

}  // namespace tensegric_fit::inspect
