/// The display's properties.
#pragma once

#include <QObject>
#include <memory>
#include <string>

#include "rviz/body_scene.hpp"

namespace rviz {
class BoolProperty;
class EnumProperty;
class FloatProperty;
class Property;
class RosTopicProperty;
class StringProperty;
}  // namespace rviz

namespace tensegric_fit::inspect {

/// Made under the display, which owns and saves them.
class LookProperties {
 public:
  /// The slots are the receiver's.
  LookProperties(rviz::Property* parent, QObject* receiver, const char* topics_changed,
                 const char* look_changed);

  Look look() const;
  /// Words for what was pointed at, shown read-only; null: nothing.
  void show_pointed(const Pointed* pointed);

  rviz::RosTopicProperty *body, *worn, *landmarks, *model, *control, *fit, *bands, *members, *warnings;

 private:
  rviz::EnumProperty *show_, *colour_by_, *scale_;
  rviz::FloatProperty *blend_, *opacity_;
  rviz::BoolProperty *legend_, *landmarks_, *names_, *girths_, *model_, *control_mesh_, *members_, *lines_,
      *pale_;
  rviz::StringProperty *value_, *position_, *nearest_;
};

}  // namespace tensegric_fit::inspect
