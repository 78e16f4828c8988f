/// rviz panel `tensegric_fit/FitPanel`: garment, lines, regions, girths, export.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QSlider>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#ifndef Q_MOC_RUN
#include <rviz/panel.h>

#include "geometry/body_measures.hpp"
#include "inspect/body_view.hpp"
#include "inspect/fit_session.hpp"
#include "inspect/pipeline_watch.hpp"
#include "ros/scan_labels.hpp"
#include "rviz/fit_client.hpp"
#include "rviz/forgetting.hpp"
#include "rviz/girth_table.hpp"
#include "rviz/line_row.hpp"
#include "rviz/sentence.hpp"
#include "rviz/view_row.hpp"
#endif

class QVBoxLayout;

namespace tensegric_fit::inspect {

/// What is on it is what the pipeline wears, whoever asked for it; only while this panel's own request is on
/// its way, or a slider is held, does it show that request.
class FitPanel : public rviz::Panel {
  Q_OBJECT
 public:
  explicit FitPanel(QWidget* parent = nullptr);
  ~FitPanel() override;

  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private:
  // What the panel is made of.
  void build_garment(QVBoxLayout* layout);
  void build_buttons(QVBoxLayout* layout);
  void build_export(QVBoxLayout* layout);
  void build_lines();
  void build_regions();
  void order_tabs();

  // What the clerk does.
  void choose(const QString& garment);
  void ask(const QString& line, double ratio);
  void undo();
  void redo();
  void take_step(bool taken);
  void show_garment_fully();  // the blend from scan to garment
  void send();
  void worn_asked(const SetGarment::Request& request);
  void blend(int per_cent);
  void compare();
  void show_marks(bool on);
  bool marks_shown() const;
  void set_display(const char* property, const QVariant& value);
  void enable_display(bool on);
  void start_export();
  void say_whose();

  // What the pipeline says.
  void take_garment(const Garment& garment);
  void take_fit(const FitState& fit);
  void take_forces(const LineForces& forces);
  void take_body(const TriangleMesh& body);
  void take_landmarks(const Landmarks& landmarks);
  void take_deformed(const DeformedMesh& deformed);
  void take_warnings(const FitWarnings& warnings);
  void take_label(const ScanLabel& label);
  void take_diagnostics(const diagnostic_msgs::DiagnosticStatus& status);
  void take_answer(bool done, const std::string& words);

  void follow_pipeline();  // unless a request is on its way
  bool adopt_worn();
  void remember(const Garment& garment);
  void forget_customer();
  bool forget(const std::string& scan_id);
  void clear_figures();
  void show_outcome();
  void forget_outcome();
  void say_warnings(std::string& which, const std::string& words);  // of folds_ and tightness_
  void show_warnings(const std::vector<std::string>& pressing,
                     const std::vector<std::string>& lacking);  // of lines
  std::string lack_of(const LineResult& line) const;            // "" where the line holds
  void show_lines();
  void show_girths();
  void show_whose();
  void follow_view();
  void show_state();
  void show_age();
  bool shows_earlier_scan() const;  // than the newest that came, whatever became of it
  void allow_name_and_export();
  std::vector<Eigen::Vector3d> without_posture(const std::vector<Eigen::Vector3d>& worn) const;
  std::string extreme_skin(bool tightest) const;             // a sentence, "" where it bears it
  void answer(const std::string& words, bool done = false);  // to the clerk, and to the log

  using Clock = std::chrono::steady_clock;

  FitSession session_;
  PipelineWatch watch_{std::chrono::duration<double>(Clock::now().time_since_epoch()).count()};
  std::map<std::string, Garment> known_;  // whole garments by name: laws and courses of their lines
  std::shared_ptr<const Garment> worn_;
  std::shared_ptr<const FitState> fitted_;  // the last that has ended
  std::vector<Eigen::Vector3d> courses_;    // of its lines
  LineForces forces_;
  FitWarnings warnings_;  // of the last that has ended, or the one before
  ControlMesh control_;
  node::ScanLabels labels_;
  BodyView body_;
  std::string measured_scan_, measured_frame_;
  geometry::BodyMeasures measures_;
  bool new_girths_ = false, forgot_her_ = false;
  Clock::time_point asked_at_{};
  bool changed_here_ = false;                   // what was asked for last is on the panel already
  bool typing_ = false;                         // a garment's name
  bool exporting_ = false;                      // an export is on its way
  std::optional<Clock::time_point> old_since_;  // what is shown is of an earlier scan since then
  bool old_gone_ = false;
  std::string said_;     // of the pipeline, last
  double keep_old_ = 0;  // s; 0: for good

  QComboBox* garment_;
  Sentence *pipeline_, *fit_, *answer_, *warned_, *volumes_;
  std::string folds_, tightness_;  // what is warned of
  QProgressBar* progress_;
  QWidget *lines_box_, *regions_box_;
  std::vector<LineRow*> rows_;
  QPushButton *put_on_, *undo_, *redo_, *reset_, *export_;
  QCheckBox *linked_, *marks_;
  QComboBox* compare_;
  QSlider* blend_;
  ViewRow* view_;
  GirthTable* table_;
  QLineEdit *customer_, *folder_;
  std::unique_ptr<FitClient> client_;       // after all of the above, which it calls
  std::unique_ptr<Forgetting> forgetting_;  // as this does
};

}  // namespace tensegric_fit::inspect
