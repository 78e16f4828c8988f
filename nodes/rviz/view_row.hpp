/// A row of the panel that turns rviz's view: front, her left, back, her right, all of her.
#pragma once

#include <QCheckBox>
#include <QString>
#include <QWidget>
#include <optional>
#include <string>
#include <vector>

#ifndef Q_MOC_RUN
#include <rviz/visualization_manager.h>

#include "inspect/framing.hpp"
#endif

namespace tensegric_fit::inspect {

/// The view follows the garment: to where it acts, when another is worn, unless that is switched off; and the
/// person, from the front, when the first one comes or one who stands elsewhere. Else it stays as the clerk
/// has it. Works with rviz's Orbit view.
class ViewRow : public QWidget {
  Q_OBJECT
 public:
  ViewRow();

  void set_manager(rviz::VisualizationManager* manager) { manager_ = manager; }
  /// Frame, in which she stands so; her skin, m.
  void set_body(const std::string& frame, const Eigen::Isometry3d& body_from_scan,
                std::vector<Eigen::Vector3d> skin);
  /// Nobody is there any more.
  void clear();
  /// Where the lines of the garment run, m, in the same frame.
  void set_garment(const std::string& garment, std::vector<Eigen::Vector3d> lines);

  /// The controls in the order of the Tab key.
  std::vector<QWidget*> controls() const { return controls_; }

 Q_SIGNALS:
  /// By a button; a sentence.
  void not_turned(const QString& why);

 private:
  void turn(From from, bool whole);
  std::string look(From from, bool whole);  // why it could not, else ""
  void look_at_garment();

  rviz::VisualizationManager* manager_ = nullptr;
  std::string frame_, garment_;
  std::optional<Eigen::Isometry3d> body_from_scan_;
  std::vector<Eigen::Vector3d> skin_, lines_;
  bool whole_ = false;
  From from_ = From::front;
  QCheckBox* follow_;
  std::vector<QWidget*> controls_;
};

}  // namespace tensegric_fit::inspect
