#include "correlation/correlate.hpp"

#include <fmt/format.h>

#include "geometry/status.hpp"

namespace tensegric_fit::correlation {
namespace {

constexpr double kLeastCompared =
    0.5;  // share of the skin under the garment; of less, no figure stands for it

std::vector<int> still_vertices(const std::vector<SkinPart>& parts) {
  std::vector<int> still;
  for (std::size_t v = 0; v < parts.size(); ++v)
    if (parts[v] == SkinPart::still) still.push_back(static_cast<int>(v));
  return still;
}

}  // namespace

Correlation correlate(const SimulatedBody& body, const WornBody& worn, const Options& options) {
  geometry::check_option("thickness", options.thickness, kThickness);
  check(body);
  const SeenSurface surface(worn.mesh, worn.filled);

  Correlation result;
  result.parts = parts_of(body);
  result.alignment = align(patch_of(body, still_vertices(result.parts)), surface, by_body_frames(body, worn));
  if (result.alignment.status != AlignmentStatus::converged &&
      result.alignment.status != AlignmentStatus::capped)
    throw geometry::Refusal(geometry::refusal::kTooFewData,
                            "the skin outside the garment does not fix the position of the scan");
  result.likeness = likeness_of(body, result.parts, worn, surface, result.alignment);
  check_same(result.likeness);
  result.map = distance_map(body, result.parts, surface, result.alignment.patch_from_scan, options.thickness);
  result.covered = summary_of(result.map, body, result.parts, SkinPart::covered);
  if (result.covered.median > kThickCloth)
    throw geometry::Refusal(
        geometry::refusal::kCoatOn,
        fmt::format(
            "under the garment the worn surface lies {:.0f} mm outside the simulated one, more than {:.0f}: "
            "there is more on than a garment of {:.1f} mm",
            1e3 * result.covered.median, 1e3 * kThickCloth, 1e3 * options.thickness));
  result.compared = compared_share(result.map, body, result.parts);
  if (result.compared < kLeastCompared)
    throw geometry::Refusal(
        geometry::refusal::kTooFewData,
        fmt::format("of the skin under the garment only {:.0f} % can be compared: the rest is not in the "
                    "scan, faces otherwise there or lies more than {:.0f} mm away",
                    100 * result.compared, 1e3 * kFarthest));
  result.still = summary_of(result.map, body, result.parts, SkinPart::still);
  return result;
}

}  // namespace tensegric_fit::correlation
