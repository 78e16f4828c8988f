#include "inspect/pressure_words.hpp"

#include <fmt/format.h>

#include "geometry/checked_yaml.hpp"
#include "geometry/shipped_files.hpp"

namespace tensegric_fit::inspect::words {
namespace {

constexpr double kOneDigit = 9.95;  // from here on no tenths

std::string figure(double value, double of) {
  return fmt::format("{:.{}f}", value, of < kOneDigit ? 1 : 0);
}

double load_pull_uncertainty() {
  const std::string path = geometry::shipped_folder("tissue") + "/newtons.yaml";
  const std::string code = geometry::refusal::kBadOption;
  const YAML::Node root = geometry::load_yaml_map(path, code);
  geometry::check_keys(root, {"made", "control_triangles", "cases", "within", "half_width", "ratios"}, path,
                       code);
  return geometry::number_in(root, "half_width", 0.01, 0.99, path, code);
}

}  // namespace

double pull_uncertainty() {
  static const double half_width = load_pull_uncertainty();
  return half_width;
}

std::string pull(double newtons) {
  return figure(newtons, newtons) + " N";
}

std::string pressure(double kilopascals) {
  return kilopascals > 0 ? figure(kilopascals, kilopascals) + " kPa" : "";
}

std::string with_uncertainty(double value) {
  return figure(value, value) + " \u00b1 " + figure(pull_uncertainty() * value, value);
}

std::string pressure_meaning(double kilopascals) {
  if (kilopascals <= 0) return "";
  if (kilopascals < kUsualPressure)
    return fmt::format("less than a waistband shortened by 5 % ({} kPa)", kUsualPressure);
  if (kilopascals <= kComplaints)
    return fmt::format(
        "more than a waistband shortened by 5 % ({} kPa), less than what wearers complain of ({} kPa)",
        kUsualPressure, kComplaints);
  return fmt::format("wearers complain above {} kPa", kComplaints);
}

std::string pull_help(double newtons, double kilopascals) {
  std::string words = "The line pulls with " + with_uncertainty(newtons) + " N";
  if (kilopascals > 0)
    words += " and presses with up to " + with_uncertainty(kilopascals) +
             " kPa: " + pressure_meaning(kilopascals) + ". Older women bear less";
  return words + ". Checked against a finer model of tissue, not on people.";
}

std::string pressure_warning(double kilopascals) {
  if (kilopascals <= kComplaints) return "";
  return fmt::format("Presses with an estimated {}: {}.", pressure(kilopascals),
                     pressure_meaning(kilopascals));
}

}  // namespace tensegric_fit::inspect::words
