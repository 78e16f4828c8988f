#include "virtual_booth/hidden_figures.hpp"

#include <algorithm>

#include "geometry/point_tree.hpp"

namespace tensegric_fit::virtual_booth {
namespace {

constexpr double kSpacing = 0.002;  // m between places: half of the least that figures may be off

struct Place {
  const char* figure;
  double allowed;  ///< m, of ISO 20685-1:2018, table 1
  std::vector<const char*> landmarks;
};

const std::vector<Place>& places() {
  static const std::vector<Place> places{{"height bust", 0.004, {"bust_point_L", "bust_point_R"}},
                                         {"height underbust", 0.004, {"fold_lowest_L", "fold_lowest_R"}},
                                         {"height hip", 0.004, {"buttock_L", "buttock_R"}},
                                         {"height crotch", 0.004, {"crotch"}},
                                         {"point crotch", 0.010, {"crotch"}},
                                         {"point bust_point_L", 0.005, {"bust_point_L"}},
                                         {"point bust_point_R", 0.005, {"bust_point_R"}},
                                         {"point axilla_L", 0.010, {"axilla_L"}},
                                         {"point axilla_R", 0.010, {"axilla_R"}},
                                         {"point shoulder_L", 0.010, {"shoulder_L"}},
                                         {"point shoulder_R", 0.010, {"shoulder_R"}}};
  return places;
}

}  // namespace

std::vector<std::string> hidden_figures(const virtual_body::VirtualBody& body,
                                        const ScannerOptions& options) {
  const geometry::PointTree seen(seen_places(body.mesh, options, kSpacing));
  const auto is_hidden = [&](const char* landmark, double allowed) {
    const geometry::Landmark* found = body.truth.find_landmark(landmark);
    return found != nullptr && seen.distance(found->position) > allowed;
  };
  std::vector<std::string> hidden;
  for (const Place& place : places())
    if (std::any_of(place.landmarks.begin(), place.landmarks.end(),
                    [&](const char* landmark) { return is_hidden(landmark, place.allowed); }))
      hidden.emplace_back(place.figure);
  return hidden;
}

virtual_body::Doubts doubts_in_booth(const virtual_body::VirtualBody& body, const ScannerOptions& options) {
  virtual_body::Doubts doubts = body.doubts;
  for (const std::string& figure : hidden_figures(body, options))
    if (std::find(doubts.hidden.begin(), doubts.hidden.end(), figure) == doubts.hidden.end())
      doubts.hidden.push_back(figure);
  return doubts;
}

}  // namespace tensegric_fit::virtual_booth
