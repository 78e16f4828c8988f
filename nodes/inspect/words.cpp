#include "inspect/words.hpp"

#include <fmt/format.h>

#include <cmath>

#include "inspect/pointing.hpp"

namespace tensegric_fit::inspect::words {

std::string of_scan(const std::string& scan_id) {
  return "scan " + scan_id;
}

std::string refused(const std::string& code, const std::string& message) {
  return fmt::format("{} ({}); what was shown before stays", message, code);
}

std::string no_transform(const std::string& frame, const std::string& fixed_frame) {
  return fmt::format("tf does not know where '{}' is in '{}'", frame, fixed_frame);
}

const ScaleWords& scale_words(ColourBy by) {
  static const ScaleWords distortion{"skin area", "pressed together", "stretched"},
      stretch{"skin length", "shorter", "longer"}, displacement{"moved", "", ""}, plain{"", "", ""};
  switch (by) {
    case ColourBy::distortion:
      return distortion;
    case ColourBy::stretch:
      return stretch;
    case ColourBy::displacement:
      return displacement;
    case ColourBy::plain:
      break;
  }
  return plain;
}

std::string value_there(ColourBy by, double value) {
  const ScaleWords& said = scale_words(by);
  if (by == ColourBy::plain) return "";
  if (by == ColourBy::displacement) return fmt::format("{} {:.1f} mm", said.title, 1e3 * value);
  const std::string way = std::lround(100 * value) == 100 ? "unchanged" : value < 1 ? said.low : said.high;
  return fmt::format("{} {:.0f} %: {}", said.title, 100 * value, way);
}

std::string position(const Eigen::Vector3d& place) {
  const auto way = [](double metres, const char* to, const char* from) {
    return fmt::format("{:.1f} cm {}", std::abs(100 * metres), metres < 0 ? from : to);
  };
  return way(place.x(), "forward", "back") + ", " + way(place.y(), "to her left", "to her right") + ", " +
         way(place.z(), "up", "down");
}

std::string nearest(const std::string& landmark, double distance) {
  return landmark.empty() ? "" : fmt::format("{:.1f} cm from the {}", 100 * distance, landmark);
}

std::string pointed(ColourBy by, double value, const std::string& landmark, double distance) {
  const std::string said = value_there(by, value), near = nearest(landmark, distance);
  return said + (said.empty() || near.empty() ? "" : ", ") + near;
}

std::string measure(const std::string& name, const std::string& kind) {
  return spoken(name) + (kind.empty() || name == "stature" ? "" : " " + kind);
}

std::string centimetre_change(double metres) {
  const double millimetres = std::round(1e3 * metres);
  return millimetres == 0 ? "0" : fmt::format("{:+.1f}", millimetres / 10);
}

std::string centimetre_change(double from, double to) {
  const auto shown = [](double metres) { return std::stod(fmt::format("{:.1f}", 100 * metres)) / 100; };
  return centimetre_change(shown(to) - shown(from));
}

}  // namespace tensegric_fit::inspect::words
