#include "tffd/under_constriction.hpp"

#include <algorithm>

#include "geometry/status.hpp"
#include "tffd/line_over_skin.hpp"

namespace tensegric_fit::tffd {
namespace {

using Eigen::Vector3d;
using geometry::FitWarning;

constexpr double kShorter = 1e-3;    // of the neutral length
constexpr double kNoTension = 1e-6;  // pseudo force: below what solvers settle to

bool is_off(const LineOverSkin& line, std::size_t i) {
  return line.heights[i] > kOffSkin;
}

double share_off(const LineOverSkin& line) {
  double count = 0;
  for (std::size_t i = 0; i < line.heights.size(); ++i) count += is_off(line, i) ? 1 : 0;
  return line.heights.empty() ? 0 : count / static_cast<double>(line.heights.size());
}

void take_skin(const LineOverSkin& line, const WornSkin& skin, FitWarning& warning) {
  const bool parts = warning.lack == geometry::lack::kLiftsOff;
  std::vector<Vector3d> feet;
  for (std::size_t i = 0; i < line.feet.size(); ++i)
    if (!parts || is_off(line, i)) feet.push_back(line.feet[i]);
  take_place(triangles_below(line, feet, skin.triangles, skin.worn, kHeldSkin), skin, warning);
}

}  // namespace

std::vector<FitWarning> under_constricted(const WornSkin& skin, const std::vector<WornLine>& lines,
                                          const HoldOptions& options) {
  if (skin.worn.size() != skin.rest.size())
    throw geometry::Refusal(geometry::refusal::kBadMesh, "skin check: not one worn place a vertex");
  std::vector<FitWarning> all;
  for (const WornLine& line : lines) {
    FitWarning warning;
    warning.code = geometry::notice::kUnderConstricted;
    warning.line = line.name;
    warning.value = line.tension;
    const LineOverSkin worn = line_over_skin(line.worn, skin.triangles, skin.worn);
    if (line.tension <= kNoTension || line.final < (1 - kShorter) * line.neutral) {
      warning.lack = geometry::lack::kSlack;
    } else if (line.tension < options.least_pull) {
      warning.lack = geometry::lack::kWeak;
    } else if (share_off(worn) > kLiftedShare) {
      const double lifted =
          share_off(worn) - share_off(line_over_skin(line.at_rest, skin.triangles, skin.rest));
      if (lifted <= kLiftedShare) continue;
      warning.lack = geometry::lack::kLiftsOff;
      warning.value = lifted;
    } else {
      continue;
    }
    take_skin(worn, skin, warning);
    all.push_back(std::move(warning));
  }
  return all;
}

std::vector<int> under_constricted_skin(const std::vector<FitWarning>& warnings) {
  std::vector<int> vertices;
  for (const FitWarning& warning : warnings)
    if (warning.code == geometry::notice::kUnderConstricted)
      vertices.insert(vertices.end(), warning.vertices.begin(), warning.vertices.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace tensegric_fit::tffd
