#include "inspect/warning_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include "inspect/pointing.hpp"

namespace tensegric_fit::inspect::words {
namespace {

using geometry::FitWarning;

constexpr double kAt = 0.015;  // m: nearer than that is at it

std::string square_centimetres(double area) {
  return fmt::format("{:.0f} cm2", std::max(1.0, 1e4 * area));
}

std::string degrees(double radians) {
  return fmt::format("{:.0f} degrees", radians * 180 / M_PI);
}

std::string share(double ratio) {
  return fmt::format("{:.0f} %", 100 * ratio);
}

std::string loosen(const std::string& line) {
  return line.empty() ? " Ask for less." : " Loosen '" + line + "'.";
}

std::string lack_of(const FitWarning& warning, const std::string& where) {
  if (warning.lack == geometry::lack::kSlack)
    return fmt::format("'{}' is slack: it does not pull. Shorten it.", warning.line);
  if (warning.lack == geometry::lack::kWeak)
    return fmt::format("'{}' hardly pulls ({:.2f}). Shorten it.", warning.line, warning.value);
  return fmt::format("'{}' lifts off the skin{} over {} of its length: nothing is held there.", warning.line,
                     where, share(warning.value));
}

}  // namespace

const geometry::Landmark* nearest_landmark(const geometry::BodyMeasures& measures,
                                           const Eigen::Vector3d& point) {
  const auto& all = measures.landmarks;
  const auto nearest = std::min_element(all.begin(), all.end(), [&](const auto& a, const auto& b) {
    return (a.position - point).squaredNorm() < (b.position - point).squaredNorm();
  });
  return nearest == all.end() ? nullptr : &*nearest;
}

std::string place(const geometry::BodyMeasures& measures, const Eigen::Vector3d& point) {
  const geometry::Landmark* landmark = nearest_landmark(measures, point);
  if (landmark == nullptr) return "";
  // How far in front or behind is seen: what a clerk looks at is a body from the front or from behind.
  const Eigen::Vector2d way = (measures.body_from_scan.linear() * (point - landmark->position)).tail<2>();
  const std::string name = spoken(landmark->name);
  if (way.norm() < kAt) return "at the " + name;
  const bool upright = std::abs(way.y()) > std::abs(way.x());
  const char* side =
      upright ? (way.y() > 0 ? "above" : "below") : (way.x() > 0 ? "to her left of" : "to her right of");
  return fmt::format("{:.0f} cm {} the {}", 100 * way.norm(), side, name);
}

std::string warning(const FitWarning& warning, const geometry::BodyMeasures& measures) {
  const std::string near = place(measures, warning.at_rest), where = near.empty() ? "" : " " + near;
  const std::string area = square_centimetres(warning.area);
  if (warning.code == geometry::warning::kShelf)
    return fmt::format("The skin folds into a shelf{}: {} are turned by up to {}.{}", where, area,
                       degrees(warning.value), loosen(warning.line));
  if (warning.code == geometry::warning::kTurnedOver)
    return fmt::format("Skin turns over{}: {}. What is shown there is not to be trusted.{}", where, area,
                       loosen(warning.line));
  if (warning.code == geometry::warning::kSkinCrosses)
    return fmt::format(
        "Skin passes through skin{}: {:.0f} mm and more. What is shown there is not to be trusted.{}", where,
        1e3 * warning.value, loosen(warning.line));
  if (warning.code == geometry::notice::kSkinTurns)
    return fmt::format("The skin turns sharply{}: {} by up to {}. Tighter, and it folds.", where, area,
                       degrees(warning.value));
  if (warning.code == geometry::notice::kOverStretched)
    return fmt::format("The skin is drawn to {} of its length{} ({}), more than skin bears.{}",
                       share(warning.value), where, area, loosen(warning.line));
  if (warning.code == geometry::notice::kPressedTogether)
    return fmt::format("The skin is pressed to {} of its width{} ({}): it would crease.{}",
                       share(warning.value), where, area, loosen(warning.line));
  if (warning.code == geometry::notice::kSkinOverLine)
    return fmt::format(
        "The skin comes {:.0f} mm through '{}'{}: in the simulation a line presses only on skin that it "
        "touches at "
        "rest; the real one would hold this skin back, too.",
        1e3 * warning.value, warning.line, where);
  if (warning.code == geometry::notice::kNotScanned)
    return fmt::format(
        "The scan did not see the skin under '{}' ({} of its length): what is shown there is made up.",
        warning.line, share(warning.value));
  return lack_of(warning, where);
}

std::string missing(const geometry::BodyMeasures& measures) {
  constexpr std::size_t kNamed = 8;
  const std::vector<geometry::Missing> parts = geometry::missing_parts(measures);
  std::string words;
  for (std::size_t i = 0; i < std::min(kNamed, parts.size()); ++i)
    words += (i > 0 ? ", " : "Missing: ") + with_names_spoken(parts[i].name);
  return words + (parts.size() > kNamed ? fmt::format(" and {} more", parts.size() - kNamed) : "");
}

std::string with_names_spoken(const std::string& words) {
  const auto is_of_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  std::string result;
  for (auto at = words.begin(); at != words.end();) {
    const auto end = is_of_name(*at) ? std::find_if_not(at, words.end(), is_of_name) : at + 1;
    const std::string word(at, end);
    result += word == "crown" ? "top of the head" : word.find('_') != std::string::npos ? spoken(word) : word;
    at = end;
  }
  return result;
}

}  // namespace tensegric_fit::inspect::words
