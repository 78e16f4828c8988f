#include "inspect/pressure_words.hpp"

#include <fmt/format.h>

namespace tensegric_fit::inspect::words {
namespace {

constexpr double kOneDigit = 9.95;  // from here on no tenths

std::string figure(double value, double of) {
  return fmt::format("{:.{}f}", value, of < kOneDigit ? 1 : 0);
}

}  // namespace

std::string pull(double newtons) {
  return figure(newtons, newtons) + " N";
}

std::string pressure(double kilopascals) {
  return kilopascals > 0 ? figure(kilopascals, kilopascals) + " kPa" : "";
}

std::string with_uncertainty(double value) {
  return figure(value, value) + " \u00b1 " + figure(kPullUncertainty * value, value);
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
