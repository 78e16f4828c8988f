#include "rviz/fit_panel.hpp"

#include <QTimer>
#include <algorithm>
#include <iterator>
#include <pluginlib/class_list_macros.hpp>
#include <utility>

#include "geometry/status.hpp"
#include "inspect/panel_words.hpp"
#include "ros/body_messages.hpp"
#include "ros/flat.hpp"
#include "ros/log_words.hpp"
#include "ros/parameters.hpp"
#include "ros/stage_report_message.hpp"
#include "rviz/qt_text.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr int kTick = 250;  // milliseconds
constexpr std::chrono::milliseconds kOwnEcho{
    400};  // after an answer: what was asked for is still coming back
constexpr std::chrono::seconds kPatience{3};
constexpr std::size_t kMostLines = 256;  // of a garment: each is a row of widgets
constexpr double kKeepOld = 120;         // s that it stays
constexpr geometry::Range kKeepOldRange{0, 1e9};

double seconds(std::chrono::steady_clock::time_point time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

std::vector<AskedLine> lines_in(const Garment& garment) {
  std::vector<AskedLine> lines;
  for (const GarmentLine& line : garment.lines) lines.push_back({line.name, line.ratio, ""});
  return lines;
}

// By points: on this body's skin and no other's.
bool lies_on_skin(const Garment& garment) {
  return std::any_of(garment.lines.begin(), garment.lines.end(),
                     [](const GarmentLine& line) { return !line.points.empty(); });
}

}  // namespace

FitPanel::~FitPanel() = default;

void FitPanel::onInitialize() {
  view_->set_manager(vis_manager_);
  try {
    keep_old_ = node::Parameters(ros::NodeHandle("~")).number("keep_previous_body", kKeepOld, kKeepOldRange);
  } catch (const geometry::Refusal& refusal) {
    keep_old_ = kKeepOld;
    answer(words::default_taken(refusal.what(), kKeepOld));
  }
  client_ = std::make_unique<FitClient>();
  client_->on_garment = [this](const Garment& garment) { take_garment(garment); };
  client_->on_fit = [this](const FitState& fit) { take_fit(fit); };
  client_->on_forces = [this](const LineForces& forces) { take_forces(forces); };
  client_->on_deformed = [this](const DeformedMesh& deformed) { take_deformed(deformed); };
  client_->on_warnings = [this](const FitWarnings& warnings) { take_warnings(warnings); };
  client_->on_body = [this](const TriangleMesh& body) { take_body(body); };
  client_->on_landmarks = [this](const Landmarks& landmarks) { take_landmarks(landmarks); };
  client_->on_control = [this](const ControlMesh& control) {
    control_ = control;
    show_outcome();
  };
  client_->on_label = [this](const ScanLabel& label) { take_label(label); };
  client_->on_diagnostics = [this](const auto& status) { take_diagnostics(status); };
  client_->on_worn = [this](bool done, const std::string& words) { take_answer(done, words); };
  client_->on_exported = [this](bool done, const std::string& words) {
    exporting_ = false;
    allow_name_and_export();
    answer(done ? words : words::not_exported(words), done);
  };
  forgetting_ =
      std::make_unique<Forgetting>(*vis_manager_, [this](const std::string& id) { return forget(id); });
  auto* timer = new QTimer(this);
  connect(timer, &QTimer::timeout, this, [this] {
    show_state();
    show_girths();
    follow_pipeline();
  });
  timer->start(kTick);
}

void FitPanel::choose(const QString& garment) {
  SetGarment::Request request;
  const int listed = garment_->findText(garment, Qt::MatchExactly);
  request.name = (listed < 0 ? garment.trimmed() : garment_->itemData(listed).toString()).toStdString();
  if (request.name.empty()) return;
  typing_ = false;
  session_.settle();
  show_garment_fully();
  changed_here_ = false;
  worn_asked(request);
}

void FitPanel::ask(const QString& line, double ratio) {
  if (!session_.ask(line.toStdString(), ratio)) return;
  show_lines();
  send();
}

void FitPanel::undo() {
  take_step(session_.undo());
}

void FitPanel::redo() {
  take_step(session_.redo());
}

void FitPanel::take_step(bool taken) {
  if (!taken) return;
  build_lines();
  build_regions();
  send();
}

void FitPanel::send() {
  const Wish& wish = session_.now();
  const auto known = known_.find(wish.garment);
  if (known == known_.end()) return answer(words::kOfAnotherBody);
  SetGarment::Request request;
  request.garment = known->second;
  auto& lines = request.garment.lines;
  lines.clear();
  for (const AskedLine& asked : wish.worn())
    for (const GarmentLine& line : known->second.lines)
      if (line.name == asked.name) {
        lines.push_back(line);
        lines.back().ratio = asked.ratio;
      }
  auto& regions = request.garment.regions;
  regions.erase(std::remove_if(regions.begin(), regions.end(),
                               [&](const std::string& region) { return wish.off.count(region) != 0; }),
                regions.end());
  changed_here_ = true;
  worn_asked(request);
}

void FitPanel::worn_asked(const SetGarment::Request& request) {
  asked_at_ = Clock::now();
  answer("");
  client_->wear(request);
}

void FitPanel::take_answer(bool done, const std::string& words) {
  asked_at_ = Clock::now();
  if (done) return answer("");
  answer(words::not_accepted(words));
  if (worn_) adopt_worn();
  build_lines();
  build_regions();
}

void FitPanel::take_garment(const Garment& garment) {
  if (garment.lines.size() > kMostLines) return answer(words::kTooManyLines);
  worn_ = std::make_shared<const Garment>(garment);
  remember(garment);
  follow_pipeline();
}

// The newest of each line. Lines that are known and not worn are those of regions that are off.
void FitPanel::remember(const Garment& garment) {
  const auto [known, is_new] = known_.emplace(garment.name, garment);
  if (is_new) return;
  if (garment.lines.size() >= known->second.lines.size()) {
    known->second = garment;
    return;
  }
  std::vector<GarmentLine> lines = known->second.lines;
  for (const GarmentLine& line : garment.lines) {
    const auto same = std::find_if(lines.begin(), lines.end(),
                                   [&line](const GarmentLine& other) { return other.name == line.name; });
    if (same == lines.end()) {
      known->second = garment;
      return;
    }
    *same = line;
  }
  known->second.lines = std::move(lines);
  known->second.solver = garment.solver;
}

// What she wore is nobody's step back, and what lay on her skin fits no other.
void FitPanel::forget_customer() {
  session_.forget_steps();
  for (auto known = known_.begin(); known != known_.end();)
    known = lies_on_skin(known->second) ? known_.erase(known) : std::next(known);
}

bool FitPanel::forget(const std::string& scan_id) {
  const ScanLabel label = labels_.of(scan_id);
  bool held = !label.customer.empty() || !label.source.empty();
  labels_.drop(scan_id);
  client_->forget_label(scan_id);
  if (fitted_ && fitted_->scan_id == scan_id) {
    held = true;
    fitted_.reset();
    courses_.clear();
  }
  if (forces_.scan_id == scan_id) forces_ = {};
  if (warnings_.scan_id == scan_id) warnings_ = {};
  if (control_.scan_id == scan_id) control_ = {};
  if (measured_scan_ == scan_id) {
    held = true;
    measured_scan_.clear();
    measures_ = {};
  }
  held |= body_.forget(scan_id);
  if (!held || !body_.empty()) return held;
  clear_figures();
  view_->clear();
  forget_customer();
  forgot_her_ = true;
  if (worn_ && lies_on_skin(*worn_)) worn_.reset();
  answer("");  // it may name where an export lies
  show_whose();
  return held;
}

// They are of the body that was shown.
void FitPanel::clear_figures() {
  customer_->setModified(false);
  customer_->clearFocus();
  table_->setRowCount(0);
  forget_outcome();
}

// True where something changed.
bool FitPanel::adopt_worn() {
  const bool is_known = known_.count(session_.now().garment) != 0;
  if (!session_.adopt(worn_->name, lines_in(*worn_))) return false;
  // The pipeline took off what lay on the last customer's skin, or what she wore who was forgotten.
  if (std::exchange(forgot_her_, false) || !is_known) session_.forget_steps();
  return true;
}

void FitPanel::follow_pipeline() {
  const bool held =
      std::any_of(rows_.begin(), rows_.end(), [](const LineRow* row) { return row->is_held(); });
  const bool coming_back = changed_here_ && Clock::now() - asked_at_ < kOwnEcho;
  if (!worn_ || held || coming_back || client_->is_asking()) return;
  const std::string garment = session_.now().garment;
  if (!adopt_worn()) return;
  const std::vector<AskedLine>& lines = session_.now().lines;
  const bool same_lines =
      std::equal(rows_.begin(), rows_.end(), lines.begin(), lines.end(),
                 [](const LineRow* row, const AskedLine& line) { return row->line() == line.name; });
  if (!same_lines) build_lines();
  if (garment != session_.now().garment) show_garment_fully();
  show_outcome();
}

void FitPanel::take_fit(const FitState& fit) {
  if (fit.lines.size() > kMostLines) return answer(words::kTooManyLines);
  if (fit.status == FitState::SOLVING) {
    if (!body_.empty() && fit.scan_id != body_.scan_id()) return;
    fit_->say(words::solving(static_cast<int>(fit.iteration)));
    const std::vector<AskedLine> worn = session_.now().worn();
    for (std::size_t i = 0; i < std::min(worn.size(), fit.line_ratios.size()); ++i)
      for (LineRow* row : rows_)
        if (row->line() == worn[i].name) row->set_ratio_now(fit.line_ratios[i]);
    return;
  }
  std::vector<Eigen::Vector3d> courses;
  try {
    for (const LineResult& line : fit.lines) {
      const std::vector<Eigen::Vector3d> course = node::points_in(line.course);
      courses.insert(courses.end(), course.begin(), course.end());
    }
  } catch (const geometry::Refusal& refusal) {
    answer(refusal.what());
    return;
  }
  fitted_ = std::make_shared<const FitState>(fit);
  courses_ = std::move(courses);
  show_outcome();
  new_girths_ = true;  // and the view, once the body is there
}

void FitPanel::take_forces(const LineForces& forces) {
  forces_ = forces;
  show_outcome();
}

void FitPanel::take_warnings(const FitWarnings& warnings) {
  warnings_ = warnings;
  show_outcome();
}

void FitPanel::take_label(const ScanLabel& label) {
  labels_.add(label);
  show_whose();
}

void FitPanel::show_whose() {
  const ScanLabel label = labels_.of(body_.scan_id());
  allow_name_and_export();
  customer_->setPlaceholderText(text(label.source));
  customer_->setToolTip(text(words::customer_help(label.source)));
  if (!customer_->isModified()) customer_->setText(text(label.customer));
}

void FitPanel::take_body(const TriangleMesh& body) {
  try {
    const bool another = body.scan_id != body_.scan_id(), had_one = !body_.empty();
    forgot_her_ = false;
    body_.take_body(body.scan_id, node::mesh_in(body));
    new_girths_ = true;
    if (another) {
      if (had_one) forget_customer();
      clear_figures();
    }
    show_whose();
    show_outcome();
  } catch (const geometry::Refusal& refusal) {
    answer(refusal.what());
  }
}

void FitPanel::take_landmarks(const Landmarks& landmarks) {
  try {
    measures_ = node::measures_in(landmarks);
    measured_scan_ = landmarks.scan_id;
    measured_frame_ = landmarks.header.frame_id;
    new_girths_ = true;
  } catch (const geometry::Refusal& refusal) {
    answer(refusal.what());
  }
}

void FitPanel::take_deformed(const DeformedMesh& deformed) {
  if (deformed.status == FitState::SOLVING) return;  // figures are those of fits that have ended
  try {
    body_.take_worn({deformed.scan_id,
                     deformed.garment,
                     node::points_in(deformed.vertices),
                     {deformed.distortion.begin(), deformed.distortion.end()}});
    new_girths_ = true;
  } catch (const geometry::Refusal& refusal) {
    answer(refusal.what());
  }
}

void FitPanel::take_diagnostics(const diagnostic_msgs::DiagnosticStatus& status) {
  // Another booth's stages are no concern of ours.
  if (const auto report = node::stage_report_in(status, ros::this_node::getNamespace()))
    watch_.hear(*report, seconds(Clock::now()));
}

void FitPanel::show_lines() {
  for (LineRow* row : rows_)
    for (const AskedLine& line : session_.now().lines)
      if (line.name == row->line()) {
        row->set_asked(line.ratio, session_.length(line.name));
        row->set_enabled(session_.now().off.count(line.region) == 0);
      }
  undo_->setEnabled(session_.can_undo());
  redo_->setEnabled(session_.can_redo());
  linked_->setEnabled(session_.has_pairs());
}

void FitPanel::answer(const std::string& words, bool done) {
  if (answer_->toolTip() == text(words)) return;
  answer_->say(words);
  answer_->setStyleSheet(done ? "" : "color: #8a4b00");
  if (!words.empty()) ROS_INFO("fit panel: %s", node::log_words(words).c_str());
}

// While the next scan is worked on, and after one was refused, the body before is not taken for hers: it is
// pale, and goes after a while.
void FitPanel::show_age() {
  const bool old = shows_earlier_scan();
  if (old != old_since_.has_value()) {
    set_display("Earlier scan", old);
    table_->setEnabled(!old);
    if (old)
      old_since_ = Clock::now();
    else
      old_since_.reset();
    if (old) {
      customer_->clearFocus();  // before it is disabled: else the folder's field gets what is typed on
      say_whose();              // not: what is half typed may be the next one's
    }
    allow_name_and_export();
  }
  const bool gone =
      old && keep_old_ > 0 && Clock::now() - *old_since_ > std::chrono::duration<double>(keep_old_);
  if (gone == old_gone_) return;
  old_gone_ = gone;
  table_->setVisible(!gone);
  enable_display(!gone);
}

bool FitPanel::shows_earlier_scan() const {
  const std::string newest = watch_.state(seconds(Clock::now())).newest_scan;
  return !body_.empty() && !newest.empty() && newest != body_.scan_id();
}

// A body that is shown pale is not of her who stands before the clerk.
void FitPanel::allow_name_and_export() {
  customer_->setEnabled(!body_.empty() && !old_since_);
  export_->setEnabled(!exporting_ && !old_since_);
}

void FitPanel::show_state() {
  const PipelineWatch::State state = watch_.state(seconds(Clock::now()));
  show_age();
  if (state.trouble && said_ != state.words) ROS_WARN("fit panel: %s", node::log_words(state.words).c_str());
  said_ = state.words;
  pipeline_->say(state.words + (!old_since_ ? "" : old_gone_ ? words::kOldBodyGone : words::kOldBody));
  pipeline_->setStyleSheet(state.trouble ? "color: #b2182b" : "");
  const QString garment = text(session_.now().garment);
  const int listed = garment_->findData(garment);
  if (!(typing_ && garment_->hasFocus()) && !client_->is_asking() &&
      (garment_->currentText() != garment || garment_->currentIndex() != listed)) {
    garment_->setCurrentIndex(listed);  // its picture; none of others'
    garment_->setEditText(garment);
  }
  const QSignalBlocker quiet(marks_);
  marks_->setChecked(marks_shown());
  progress_->setMaximum(state.all);
  progress_->setValue(state.done);
  if (client_->is_asking() && Clock::now() - asked_at_ > kPatience) answer(words::kNoAnswer);
}

}  // namespace tensegric_fit::inspect

PLUGINLIB_EXPORT_CLASS(tensegric_fit::inspect::FitPanel, rviz::Panel)
