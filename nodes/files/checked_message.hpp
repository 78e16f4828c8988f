/// A message of a bag, whose lengths are checked before room is made for its arrays.
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <rosbag/message_instance.h>

#include <string>

#include "files/message_layout.hpp"

namespace tensegric_fit::files {

/// Null where it is of another type. \throw Refusal broken_file: it is shorter than it says
template <typename Message>
boost::shared_ptr<Message> checked_message(const rosbag::MessageInstance& recorded) {
  if (!recorded.isType<Message>()) return nullptr;
  static const MessageLayout layout(ros::message_traits::definition<Message>());
  std::string bytes(recorded.size(), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), recorded.size());
  recorded.write(stream);
  layout.check(bytes);
  return recorded.instantiate<Message>();
}

}  // namespace tensegric_fit::files
