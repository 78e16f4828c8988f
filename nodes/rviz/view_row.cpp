#include "rviz/view_row.hpp"

#include <rviz/frame_manager.h>
#include <rviz/properties/property.h>
#include <rviz/properties/vector_property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>

#include <QHBoxLayout>
#include <QPushButton>
#include <QShortcut>

#include "inspect/panel_words.hpp"
#include "rviz/qt_text.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr double kAround = 0.12;     // m about what is shown
constexpr double kAngle = M_PI / 4;  // rad: rviz's field of view

}  // namespace

ViewRow::ViewRow() {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(4);
  const auto button = [&](const char* name, const char* key, auto act) {
    auto* made = new QPushButton(name);
    made->setToolTip(QString(words::kViewHelp) + " (" + key + ")");
    made->setMinimumWidth(40);
    row->addWidget(made, 1);
    controls_.push_back(made);
    connect(made, &QPushButton::clicked, this, act);
    const auto* shortcut = new QShortcut(QKeySequence(key), this, nullptr, nullptr, Qt::ApplicationShortcut);
    connect(shortcut, &QShortcut::activated, this, act);
  };
  button(words::kViewFront, "F5", [this] { turn(From::front, whole_); });
  button(words::kViewLeft, "F6", [this] { turn(From::her_left, whole_); });
  button(words::kViewBack, "F7", [this] { turn(From::back, whole_); });
  button(words::kViewRight, "F8", [this] { turn(From::her_right, whole_); });
  button(words::kViewAll, "F9", [this] { turn(from_, !whole_); });
  follow_ = new QCheckBox(words::kViewFollows);
  follow_->setToolTip(words::kViewFollowsHelp);
  follow_->setChecked(true);
  row->addWidget(follow_);
  controls_.push_back(follow_);
}

void ViewRow::set_body(const std::string& frame, const Eigen::Isometry3d& body_from_scan,
                       std::vector<Eigen::Vector3d> skin) {
  const bool elsewhere = !body_from_scan_ || frame != frame_ || is_moved(body_from_scan, *body_from_scan_);
  frame_ = frame;
  skin_ = std::move(skin);
  body_from_scan_ = body_from_scan;
  if (!elsewhere) return;
  lines_.clear();  // they were those of the one before
  garment_.clear();
  look(From::front, false);
}

void ViewRow::clear() {
  frame_.clear();
  garment_.clear();
  body_from_scan_.reset();
  skin_.clear();
  lines_.clear();
}

void ViewRow::set_garment(const std::string& garment, std::vector<Eigen::Vector3d> lines) {
  const bool other = garment != garment_;
  lines_ = std::move(lines);
  garment_ = garment;
  if (other && follow_->isChecked()) look_at_garment();
}

void ViewRow::look_at_garment() {
  if (skin_.empty() || lines_.empty() || !body_from_scan_) return;
  look(lie_behind(lines_, skin_, *body_from_scan_) ? From::back : From::front, false);
}

void ViewRow::turn(From from, bool whole) {
  const std::string why = look(from, whole);
  if (!why.empty()) Q_EMIT not_turned(text(why));
}

std::string ViewRow::look(From from, bool whole) {
  from_ = from;
  whole_ = whole;
  if (!manager_ || !body_from_scan_ || skin_.empty()) return "";  // nobody is there to look at
  const bool all = whole || lines_.empty();
  const OrbitView view = framed(all ? skin_ : lines_, *body_from_scan_, from, all ? 0 : kAround, kAngle);
  rviz::ViewController* controller = manager_->getViewManager()->getCurrent();
  Ogre::Vector3 place;
  Ogre::Quaternion rotation;
  if (!controller || controller->getClassId() != "rviz/Orbit") return words::kNoOrbit;
  if (!manager_->getFrameManager()->getTransform(frame_, ros::Time(), place, rotation))
    return words::unknown_frame(frame_);
  const Ogre::Vector3 focus =
      place + rotation * Ogre::Vector3(static_cast<float>(view.focus.x()), static_cast<float>(view.focus.y()),
                                       static_cast<float>(view.focus.z()));
  const Ogre::Vector3 forward = rotation * Ogre::Vector3::UNIT_X;
  if (auto* point = dynamic_cast<rviz::VectorProperty*>(controller->subProp("Focal Point")))
    point->setVector(focus);
  controller->subProp("Distance")->setValue(view.distance);
  controller->subProp("Yaw")->setValue(view.yaw + std::atan2(forward.y, forward.x));
  controller->subProp("Pitch")->setValue(view.pitch);
  return "";
}

}  // namespace tensegric_fit::inspect
