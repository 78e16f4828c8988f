#include "tensegric/wardrobe.hpp"

#include "geometry/status.hpp"

namespace tensegric_fit::node {

using geometry::Refusal;

GarmentRequest Wardrobe::take(const std::string& word) const {
  return {tensegric::take_garment(word, folder_), ""};
}

GarmentRequest Wardrobe::take(const SetGarment::Request& request) const {
  if (request.name.empty() && request.garment.lines.empty())
    throw Refusal(geometry::refusal::kBadGarment,
                  "the request has neither a garment's name nor a garment with lines");
  GarmentRequest asked = request.name.empty() ? request_in(request.garment) : take(request.name);
  if (request.lines.size() != request.ratios.size())
    throw Refusal(geometry::refusal::kBadGarment, "`lines` and `ratios` must have one entry for each other");
  for (std::size_t i = 0; i < request.lines.size(); ++i)
    tensegric::set_ratio(asked.garment, request.lines[i], request.ratios[i]);
  return asked;
}

}  // namespace tensegric_fit::node
