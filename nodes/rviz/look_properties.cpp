#include "rviz/look_properties.hpp"

#include <ros/message_traits.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/ros_topic_property.h>
#include <rviz/properties/string_property.h>
#include <tensegric_fit/BandShapes.h>
#include <tensegric_fit/BodyModel.h>
#include <tensegric_fit/ControlMesh.h>
#include <tensegric_fit/DeformedMesh.h>
#include <tensegric_fit/FitState.h>
#include <tensegric_fit/FitWarnings.h>
#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/MemberForces.h>
#include <tensegric_fit/TriangleMesh.h>

#include "inspect/words.hpp"
#include "rviz/qt_text.hpp"

namespace tensegric_fit::inspect {
namespace {

template <typename Message>
rviz::RosTopicProperty* topic(const char* name, const char* value, const char* what, rviz::Property* parent,
                              QObject* receiver, const char* changed) {
  return new rviz::RosTopicProperty(name, value, ros::message_traits::datatype<Message>(), what, parent,
                                    changed, receiver);
}

rviz::FloatProperty* share(const char* name, double value, const char* what, rviz::Property* parent,
                           QObject* receiver, const char* changed) {
  auto* property = new rviz::FloatProperty(name, static_cast<float>(value), what, parent, changed, receiver);
  property->setMin(0);
  property->setMax(1);
  return property;
}

rviz::StringProperty* answer(const char* name, const char* what, rviz::Property* parent) {
  auto* property = new rviz::StringProperty(name, "", what, parent);
  property->setReadOnly(true);
  property->setShouldBeSaved(false);
  return property;
}

}  // namespace

LookProperties::LookProperties(rviz::Property* parent, QObject* receiver, const char* topics_changed,
                               const char* look_changed) {
  const Look first;
  const auto flag = [&](const char* name, bool value, const char* what, rviz::Property* under) {
    return new rviz::BoolProperty(name, value, what, under, look_changed, receiver);
  };
  const auto choice = [&](const char* name, const char* value, const char* what) {
    return new rviz::EnumProperty(name, value, what, parent, look_changed, receiver);
  };
  show_ = choice("Show", words::kAfter, words::kShowHelp);
  show_->addOption(words::kAfter, static_cast<int>(Show::after));
  show_->addOption(words::kBefore, static_cast<int>(Show::before));
  show_->addOption(words::kSideBySide, static_cast<int>(Show::side_by_side));
  show_->addOption(words::kBlend, static_cast<int>(Show::blend));
  show_->addOption(words::kGhost, static_cast<int>(Show::ghost));
  show_->addOption(words::kWipe, static_cast<int>(Show::wipe));
  blend_ = share("Blend", first.blend, words::kBlendHelp, parent, receiver, look_changed);
  colour_by_ = choice("Colour", words::kDistortion, words::kColourHelp);
  colour_by_->addOption(words::kDistortion, static_cast<int>(ColourBy::distortion));
  colour_by_->addOption(words::kStretch, static_cast<int>(ColourBy::stretch));
  colour_by_->addOption(words::kDisplacement, static_cast<int>(ColourBy::displacement));
  colour_by_->addOption(words::kPlain, static_cast<int>(ColourBy::plain));
  scale_ = choice("Scale", words::kFixed, words::kScaleHelp);
  scale_->addOption(words::kFixed, 0);
  scale_->addOption(words::kAutomatic, 1);
  legend_ = flag("Legend", first.legend, words::kLegendHelp, parent);
  opacity_ = share("Alpha", first.opacity, words::kOpacityHelp, parent, receiver, look_changed);
  lines_ = flag("Garment lines", first.lines, words::kLinesHelp, parent);
  landmarks_ = flag("Landmarks", first.landmarks, words::kLandmarksHelp, parent);
  names_ = flag("Names", first.names, words::kNamesHelp, landmarks_);
  girths_ = flag("Girths", first.girths, words::kGirthsHelp, parent);
  model_ = flag("Body model", first.model, words::kModelHelp, parent);
  control_mesh_ = flag("Control mesh", first.control_mesh, words::kControlHelp, parent);
  members_ = flag("Struts and tensile parts", first.members, words::kMembersHelp, parent);

  pale_ = flag("Earlier scan", false, words::kPaleHelp, parent);
  pale_->setShouldBeSaved(false);

  auto* topics = new rviz::Property("Topics", QVariant(), words::kTopicsHelp, parent);
  body = topic<TriangleMesh>("Body", "body/mesh", words::kBodyHelp, topics, receiver, topics_changed);
  worn = topic<DeformedMesh>("Deformed", "body/deformed", words::kWornHelp, topics, receiver, topics_changed);
  landmarks = topic<Landmarks>("Landmarks", "body/landmarks", words::kLandmarksHelp, topics, receiver,
                               topics_changed);
  model = topic<BodyModel>("Body model", "body/model", words::kModelHelp, topics, receiver, topics_changed);
  control = topic<ControlMesh>("Control mesh", "control/mesh", words::kControlHelp, topics, receiver,
                               topics_changed);
  fit = topic<FitState>("Fit", "control/deformed", words::kLinesHelp, topics, receiver, topics_changed);
  bands = topic<BandShapes>("Bands", "control/bands", words::kLinesHelp, topics, receiver, topics_changed);
  members = topic<MemberForces>("Members", "tensegric/members", words::kMembersHelp, topics, receiver,
                                topics_changed);

  warnings =
      topic<FitWarnings>("Warnings", "body/warnings", words::kUnheldHelp, topics, receiver, topics_changed);

  auto* pointed = new rviz::Property("Pointed at", QVariant(), words::kPointedHelp, parent);
  value_ = answer("Value", words::kPointedHelp, pointed);
  position_ = answer("Position", words::kPositionHelp, pointed);
  nearest_ = answer("Nearest landmark", words::kPointedHelp, pointed);
}

Look LookProperties::look() const {
  Look look;
  look.show = static_cast<Show>(show_->getOptionInt());
  look.blend = blend_->getFloat();
  look.colour_by = static_cast<ColourBy>(colour_by_->getOptionInt());
  look.automatic_scale = scale_->getOptionInt() == 1;
  look.legend = legend_->getBool();
  look.opacity = opacity_->getFloat();
  look.landmarks = landmarks_->getBool();
  look.names = names_->getBool();
  look.girths = girths_->getBool();
  look.model = model_->getBool();
  look.control_mesh = control_mesh_->getBool();
  look.members = members_->getBool();
  look.lines = lines_->getBool();
  look.pale = pale_->getBool();
  return look;
}

void LookProperties::show_pointed(const Pointed* pointed) {
  const ColourBy by = static_cast<ColourBy>(colour_by_->getOptionInt());
  value_->setString(pointed == nullptr ? "" : text(words::value_there(by, pointed->value)));
  position_->setString(pointed == nullptr ? "" : text(words::position(pointed->position)));
  nearest_->setString(pointed == nullptr ? "" : text(words::nearest(pointed->landmark, pointed->distance)));
}

}  // namespace tensegric_fit::inspect
