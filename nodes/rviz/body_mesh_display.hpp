/// rviz display `tensegric_fit/BodyMesh`: a body before and under a garment.
#pragma once

#include <memory>

#ifndef Q_MOC_RUN
#include <ros/ros.h>
#include <rviz/display.h>
#include <tensegric_fit/BandShapes.h>
#include <tensegric_fit/BodyModel.h>
#include <tensegric_fit/ControlMesh.h>
#include <tensegric_fit/DeformedMesh.h>
#include <tensegric_fit/FitState.h>
#include <tensegric_fit/FitWarnings.h>
#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/MemberForces.h>
#include <tensegric_fit/TriangleMesh.h>

#include "rviz/body_scene.hpp"
#include "rviz/forgetting.hpp"
#include "rviz/look_properties.hpp"
#include "rviz/second_view.hpp"
#endif

namespace tensegric_fit::inspect {

/// Every message is checked when it comes; one that does not fit is named in the display's status, and what
/// was shown before stays. Drawn at most once a frame.
class BodyMeshDisplay : public rviz::Display {
  Q_OBJECT
 public:
  BodyMeshDisplay();
  ~BodyMeshDisplay() override;

  void update(float wall_dt, float ros_dt) override;
  void reset() override;
  void setTopic(const QString& topic, const QString& datatype) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private Q_SLOTS:
  void change_topics();
  void change_look();

 private:  // NOLINT(readability-redundant-access-specifiers): what comes are no slots
  template <typename Message>
  void subscribe(rviz::RosTopicProperty* topic, void (BodyMeshDisplay::*take)(const Message&));
  void take_body(const TriangleMesh& message);
  void take_worn(const DeformedMesh& message);
  void take_landmarks(const Landmarks& message);
  void take_model(const BodyModel& message);
  void take_control(const ControlMesh& message);
  void take_fit(const FitState& message);
  void take_bands(const BandShapes& message);
  void take_warnings(const FitWarnings& message);
  void take_members(const MemberForces& message);

  bool forget(const std::string& scan_id);

  void make_scene();
  void place();
  void part_view(const Look& look);
  std::vector<int> unheld_skin() const;
  std::vector<int> with_rim(const std::vector<int>& skin) const;
  void point(const QPoint& pixel);

  std::unique_ptr<LookProperties> properties_;
  std::vector<ros::Subscriber> subscribers_;
  BodyView body_;
  Overlays overlays_;
  std::unique_ptr<BodyScene> scene_;
  std::unique_ptr<SecondView> second_;
  std::unique_ptr<Forgetting> forgetting_;
  BodyScene::Parts parts_{};
  FitWarnings warnings_;
  std::string frame_;
  std::string place_;  // what the status says of it
  bool new_body_ = false, changed_ = false, listens_to_bands_ = false, listens_to_members_ = false,
       listens_to_model_ = false;
  QPoint pressed_at_;
};

}  // namespace tensegric_fit::inspect
