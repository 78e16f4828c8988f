#include <algorithm>

#include "geometry/fit_warning.hpp"
#include "geometry/moved_skin.hpp"
#include "geometry/status.hpp"
#include "inspect/panel_words.hpp"
#include "inspect/pointing.hpp"
#include "inspect/pressure_words.hpp"
#include "ros/body_messages.hpp"
#include "ros/line_force.hpp"
#include "ros/log_words.hpp"
#include "rviz/fit_panel.hpp"
#include "rviz/qt_text.hpp"

namespace tensegric_fit::inspect {
namespace {

// The region in which the middle of a line lies.
std::string region_of(const LineResult& line, const ControlMesh& control) {
  if (line.nodes.empty()) return "";
  const std::uint32_t node = line.nodes[line.nodes.size() / 2];
  for (const ControlRegion& region : control.regions)
    for (const std::uint32_t t : region.triangles)
      for (int corner = 0; corner < 3; ++corner)
        if (3 * t + corner < control.triangles.size() && control.triangles[3 * t + corner] == node)
          return region.name;
  return "";
}

}  // namespace

// Figures are of the body that is shown, or there are none.
void FitPanel::forget_outcome() {
  session_.forget_lengths();
  for (LineRow* row : rows_) row->forget_outcome();
  for (Sentence* label : {fit_, volumes_}) label->say("");
  say_warnings(folds_, "");
  say_warnings(tightness_, "");
  build_regions();
  show_lines();
}

void FitPanel::show_outcome() {
  if (!fitted_) return;
  const FitState& fit = *fitted_;
  if (!body_.empty() && fit.scan_id != body_.scan_id()) return forget_outcome();
  const std::string ended = words::fit_ended(fit.garment, fit.status, fit.note, fit.milliseconds);
  fit_->say(words::without_details(ended), ended);
  std::map<std::string, std::string> regions;
  std::vector<std::string> pressing, lacking;
  const std::string& asked = session_.now().garment;
  const bool is_of_asked = asked.empty() || fit.garment == asked;  // else that one's fit is on its way
  if (!is_of_asked)
    for (LineRow* row : rows_) row->forget_outcome();
  for (std::size_t i = 0; is_of_asked && i < fit.lines.size(); ++i) {
    const LineResult& line = fit.lines[i];
    session_.set_length(line.name, line.initial);
    if (fit.scan_id == control_.scan_id) regions[line.name] = region_of(line, control_);
    const words::LineOutcome outcome{line.request, line.ratio, line.tension, line.reachable,
                                     fit.status == FitState::INFEASIBLE};
    std::string warning = words::line_warning(outcome);
    if (!warning.empty()) lacking.push_back("'" + line.name + "': " + warning);
    if (warning.empty()) warning = lack_of(line);
    const auto force = node::force_of(forces_, fit, i);
    const std::string pressed = force ? words::pressure_warning(force->kilopascals) : "";
    if (!pressed.empty()) pressing.push_back("'" + line.name + "': " + pressed);
    if (warning.empty()) warning = pressed;
    for (LineRow* row : rows_)
      if (row->line() == line.name) {
        row->set_outcome(line.ratio, warning);
        if (force)
          row->set_force(words::pull(force->newtons), words::pressure(force->kilopascals),
                         words::pull_help(force->newtons, force->kilopascals));
        else
          row->set_force("", "", "");
      }
  }
  session_.place(regions);
  if (is_of_asked)
    show_warnings(pressing, lacking);
  else
    say_warnings(folds_, "");
  QStringList volumes;
  for (const RegionResult& region : fit.regions)
    volumes << text(words::volume(region.name, region.volume_before, region.volume_after));
  volumes_->say(volumes.join(" \u00b7 ").toStdString());
  build_regions();
  show_lines();
}

void FitPanel::say_warnings(std::string& which, const std::string& words) {
  which = words;
  warned_->say(folds_ + (folds_.empty() || tightness_.empty() ? "" : " ") + tightness_);
}

// What presses comes before skin that folds, and that before lines that do not hold: few are shown.
void FitPanel::show_warnings(const std::vector<std::string>& pressing,
                             const std::vector<std::string>& lacking) {
  std::vector<std::string> messages = pressing;
  const FitWarnings none;
  const bool are_of_it = warnings_.scan_id == fitted_->scan_id && warnings_.garment == fitted_->garment;
  const FitWarnings& known = are_of_it ? warnings_ : none;
  for (const FitWarning& warning : known.warnings) messages.push_back(warning.message);
  messages.insert(messages.end(), lacking.begin(), lacking.end());
  const auto is_said = [messages](const std::string& line) {  // of the line, by its figures
    return std::any_of(messages.begin(), messages.end(),
                       [&](const std::string& message) { return message.rfind("'" + line + "': ", 0) == 0; });
  };
  for (const FitWarning& notice : known.notices)
    if (notice.code == geometry::notice::kOverStretched ||
        notice.code == geometry::notice::kPressedTogether || notice.code == geometry::notice::kNotScanned ||
        (notice.code == geometry::notice::kUnderConstricted && !is_said(notice.line)))
      messages.push_back(notice.message);
  const std::string words = words::warnings(messages);
  if (!words.empty() && folds_ != words) ROS_WARN("fit panel: %s", node::log_words(words).c_str());
  say_warnings(folds_, words);
}

std::string FitPanel::lack_of(const LineResult& line) const {
  if (!fitted_ || warnings_.scan_id != fitted_->scan_id || warnings_.garment != fitted_->garment) return "";
  for (const FitWarning& notice : warnings_.notices)
    if (notice.code == geometry::notice::kUnderConstricted && notice.line == line.name) return notice.message;
  return "";
}

void FitPanel::show_girths() {
  if (!new_girths_ || body_.empty() || measured_scan_ != body_.scan_id()) return;
  new_girths_ = false;
  follow_view();
  const std::vector<Eigen::Vector3d> worn = without_posture(body_.vertices(1));
  table_->show_measures(measures_, {body_.mesh(), worn}, body_.is_worn());

  const std::string pressed = extreme_skin(true), stretched = extreme_skin(false);
  say_warnings(tightness_, pressed + (pressed.empty() || stretched.empty() ? "" : " ") + stretched);
}

// As in the scan's posture: what the garment alone does.
std::vector<Eigen::Vector3d> FitPanel::without_posture(const std::vector<Eigen::Vector3d>& worn) const {
  if (!fitted_ || fitted_->scan_id != body_.scan_id()) return worn;
  if (worn == body_.mesh().vertices) return worn;  // nothing is worn yet
  try {
    return geometry::in_scan_posture(body_.mesh(), worn, node::bones_of(*fitted_, measures_));
  } catch (const geometry::Refusal&) {  // it cannot be of these measures
    return worn;
  }
}

std::string FitPanel::extreme_skin(bool tightest) const {
  const std::vector<double> distortion = body_.values(ColourBy::distortion, 1);
  const auto extreme = tightest ? std::min_element(distortion.begin(), distortion.end())
                                : std::max_element(distortion.begin(), distortion.end());
  const Eigen::Vector3d place = body_.mesh().vertices[extreme - distortion.begin()];
  const auto& landmarks = measures_.landmarks;
  const auto nearest =
      std::min_element(landmarks.begin(), landmarks.end(), [&](const auto& a, const auto& b) {
        return (a.position - place).squaredNorm() < (b.position - place).squaredNorm();
      });
  return words::over_constriction(*extreme, nearest == landmarks.end() ? "" : spoken(nearest->name));
}

void FitPanel::follow_view() {
  view_->set_body(measured_frame_, measures_.body_from_scan, body_.mesh().vertices);
  if (!fitted_ || fitted_->scan_id != measured_scan_) return;
  view_->set_garment(fitted_->garment, courses_);
}

}  // namespace tensegric_fit::inspect
