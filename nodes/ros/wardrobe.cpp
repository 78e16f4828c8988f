#include "ros/wardrobe.hpp"

#include <fmt/format.h>

#include <cmath>

#include "geometry/status.hpp"
#include "ros/shipped_files.hpp"

namespace tensegric_fit::node {
namespace {

using geometry::Refusal;

void set_ratio(tensegric::Garment& garment, const std::string& name, double ratio) {
  if (!(ratio > 0) || !std::isfinite(ratio))
    throw Refusal(geometry::refusal::kBadGarment,
                  fmt::format("ratio {} of line '{}' must be above 0", ratio, name));
  bool found = false;
  for (tensegric::GarmentLine& line : garment.lines) {
    if (!name.empty() && line.name != name) continue;
    line.ratio = ratio;
    found = true;
  }
  if (!found)
    throw Refusal(geometry::refusal::kUnknownLine,
                  fmt::format("garment '{}' has no line '{}'", garment.name, name));
}

}  // namespace

GarmentRequest Wardrobe::take(const std::string& word) const {
  return {tensegric::load_garment(shipped_file(folder_, word, geometry::refusal::kBadGarment)), ""};
}

GarmentRequest Wardrobe::take(const SetGarment::Request& request) const {
  GarmentRequest asked = request.name.empty() ? request_in(request.garment) : take(request.name);
  if (asked.garment.lines.empty())
    throw Refusal(geometry::refusal::kBadGarment,
                  "the request has neither a garment's name nor a garment with lines");
  if (request.lines.size() != request.ratios.size())
    throw Refusal(geometry::refusal::kBadGarment, "`lines` and `ratios` must have one entry for each other");
  for (std::size_t i = 0; i < request.lines.size(); ++i)
    set_ratio(asked.garment, request.lines[i], request.ratios[i]);
  return asked;
}

}  // namespace tensegric_fit::node
