#include "inspect/panel_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "inspect/colour_scale.hpp"

namespace tensegric_fit::inspect::words {
namespace {

std::string stage_name(const std::string& stage) {
  static const std::map<std::string, std::string> names{{"reconstruction", "surface of the body"},
                                                        {"landmarks", "landmarks and girths"},
                                                        {"control_mesh", "control mesh"},
                                                        {"tensegric", "fit of the garment"},
                                                        {"tffd", "shape of the body"}};
  const auto found = names.find(stage);
  return found == names.end() ? stage : found->second;
}

// Never -0.0.
double shown(double value, double half_digit) {
  return std::abs(value) < half_digit ? 0 : value;
}

std::string sentence(std::string words) {
  if (!words.empty() && words.back() != '.') words += '.';
  return words;
}

}  // namespace

std::string silent(const std::string& stage) {
  return fmt::format("No sign of life from: {}. What is shown is the last good state.", stage_name(stage));
}

std::string stage_refused(const std::string& stage, const std::string& message) {
  return sentence(fmt::format("Refused ({}): {}", stage_name(stage), message));
}

std::string working(const std::string& stage) {
  return fmt::format("Working: {} ...", stage_name(stage));
}

std::string solving(int iteration) {
  return fmt::format("Fitting, step {} ...", iteration);
}

std::string not_accepted(const std::string& message) {
  return sentence("Not put on: " + message);
}

std::string exported(int files, const std::string& folder) {
  return fmt::format("Wrote {} files into {}", files, folder);
}

std::string customer_help(const std::string& source) {
  return (source.empty() ? "" : "From " + source + ". ") +
         "Your own id of her: type it and press Enter. It goes into exports, and `history` finds her by it.";
}

std::string not_exported(const std::string& message) {
  return sentence("Nothing was exported: " + message);
}

std::string unknown_frame(const std::string& frame) {
  return fmt::format("The view is not turned: from rviz's fixed frame tf knows no way to the frame '{}'.",
                     frame);
}

std::string default_taken(const std::string& why, double seconds) {
  return sentence(fmt::format("{}; {:.0f} s are taken", why, seconds));
}

std::string fit_ended(const std::string& garment, const std::string& status, const std::string& note,
                      double milliseconds) {
  static const std::map<std::string, std::string> said{
      {"converged", "fits"},
      {"infeasible", "cannot become as tight as asked; this is the nearest shape"},
      {"capped", "the solver ran out of steps; this is the best so far"},
      {"oscillating", "the solver swings and does not settle"},
      {"diverged", "the solver gave up; ask for less"}};
  const auto found = said.find(status);
  std::string words =
      fmt::format("{}: {} ({:.0f} ms).", garment, found == said.end() ? status : found->second, milliseconds);
  if (!note.empty()) words += " " + sentence(note);
  return words;
}

std::string without_details(std::string words) {
  for (std::size_t at = 0; (at = words.find(" (Details: ", at)) != std::string::npos;) {
    const std::size_t end = words.find(')', at);
    words.erase(at, end == std::string::npos ? end : end + 1 - at);
  }
  return words;
}

std::string line_warning(const LineOutcome& line) {
  constexpr double kReached = 1e-3;
  if (line.infeasible && line.ratio > line.request + kReached)
    return fmt::format("Over-constricted: cannot become shorter than {} ({}).", centimetres(line.reachable),
                       per_cent(line.ratio));
  if (line.tension <= 0 && line.ratio < line.request - kReached) return "Slack: it does not pull.";
  return "";
}

std::string over_constriction(double area, const std::string& landmark) {
  const std::string near = landmark.empty() ? "" : " near the " + landmark;
  if (area < kOverConstricted)
    return fmt::format("Over-constricted{}: the skin is drawn together to {} of its area.", near,
                       per_cent(area));
  if (area > kOverStretched)
    return fmt::format("Over-stretched{}: the skin is drawn out to {} of its area.", near, per_cent(area));
  return "";
}

std::string warnings(const std::vector<std::string>& messages) {
  constexpr std::size_t kShown = 2;
  std::string words;
  for (std::size_t i = 0; i < std::min(kShown, messages.size()); ++i)
    words += (i == 0 ? "" : " ") + messages[i];
  if (const std::size_t more = messages.size() - std::min(kShown, messages.size()); more > 0)
    words += fmt::format(" And {} more {}.", more, more == 1 ? "place" : "places");
  return words;
}

std::string sizes(const std::vector<BraSize>& sizes) {
  std::string words = sizes.empty() ? kNoSize : "";
  for (const BraSize& size : sizes) words += (words.empty() ? "" : " or ") + size.label();
  return words;
}

std::string volume(const std::string& region, double before, double after) {
  return fmt::format("{}: {:.2f} l, {:+.2f} %", region, 1e3 * before,
                     shown(100 * (after / before - 1), 0.005));
}

std::string centimetres(double metres) {
  return fmt::format("{:.1f} cm", 100 * metres);
}

std::string rise(double metres) {
  return fmt::format("{:+.0f} mm", shown(1e3 * metres, 0.5));
}

std::string change(double metres) {
  return fmt::format("{:+.1f} cm", shown(100 * metres, 0.05));
}

std::string per_cent(double ratio) {
  return fmt::format("{:.1f} %", 100 * ratio);
}

}  // namespace tensegric_fit::inspect::words
