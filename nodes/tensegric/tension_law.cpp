#include "tensegric/tension_law.hpp"

#include <algorithm>

namespace tensegric_fit::tensegric {
namespace {

constexpr double kSteep = 100;  // tension per stretch; the tissue's own is about 1

std::size_t table_segment(const TensionLaw& law, double stretch) {
  std::size_t i = 0;
  while (i + 2 < law.table.size() && stretch > law.table[i + 1].first) ++i;
  return i;
}

std::size_t segment_by_tension(const TensionLaw& law, double tension) {
  std::size_t i = 0;
  while (i + 2 < law.table.size() && std::max(0.0, tension) >= law.table[i + 1].second) ++i;
  return i;
}

double slope_of_segment(const TensionLaw& law, std::size_t i) {
  return (law.table[i + 1].second - law.table[i].second) / (law.table[i + 1].first - law.table[i].first);
}

}  // namespace

// A table with a level part beyond its first tension has no stretch by tension.
bool is_steep(const TensionLaw& law) {
  if (law.kind == TensionLaw::Kind::rigid) return true;
  if (law.kind == TensionLaw::Kind::stiffness) return law.stiffness >= kSteep;
  double steepest = 0;
  for (std::size_t i = 0; i + 1 < law.table.size(); ++i) {
    const double slope = slope_of_segment(law, i);
    if (slope == 0 && (law.table[i].second > 0 || i + 2 == law.table.size())) return false;
    steepest = std::max(steepest, slope);
  }
  return steepest >= kSteep;
}

double law_tension(const TensionLaw& law, double stretch) {
  if (law.kind == TensionLaw::Kind::stiffness) return law.stiffness * std::max(0.0, stretch - 1);
  if (stretch <= law.table.front().first) return 0;
  const std::size_t i = table_segment(law, stretch);
  return law.table[i].second + law_slope(law, stretch) * (stretch - law.table[i].first);
}

double law_slope(const TensionLaw& law, double stretch) {
  if (law.kind == TensionLaw::Kind::stiffness) return stretch > 1 ? law.stiffness : 0;
  if (stretch <= law.table.front().first) return 0;
  return slope_of_segment(law, table_segment(law, stretch));
}

double law_work(const TensionLaw& law, double stretch) {
  if (law.kind == TensionLaw::Kind::stiffness) {
    const double beyond = std::max(0.0, stretch - 1);
    return law.stiffness * beyond * beyond / 2;
  }
  double work = 0;
  for (std::size_t i = 0; i + 1 < law.table.size() && stretch > law.table[i].first; ++i) {
    const bool last = i + 2 == law.table.size();
    const double end = last ? stretch : std::min(stretch, law.table[i + 1].first);
    work += (law.table[i].second + law_tension(law, end)) / 2 * (end - law.table[i].first);
  }
  return work;
}

double law_stretch(const TensionLaw& law, double tension) {
  if (law.kind == TensionLaw::Kind::rigid) return 1;
  if (law.kind == TensionLaw::Kind::stiffness) return 1 + tension / law.stiffness;
  const std::size_t i = segment_by_tension(law, tension);
  return law.table[i].first + law_compliance(law, tension) * (tension - law.table[i].second);
}

double law_compliance(const TensionLaw& law, double tension) {
  if (law.kind == TensionLaw::Kind::rigid) return 0;
  if (law.kind == TensionLaw::Kind::stiffness) return 1 / law.stiffness;
  return 1 / slope_of_segment(law, segment_by_tension(law, tension));
}

double law_work_by_tension(const TensionLaw& law, double tension) {
  if (law.kind == TensionLaw::Kind::rigid) return 0;
  if (law.kind == TensionLaw::Kind::stiffness || tension <= 0)
    return law_compliance(law, tension) * tension * tension / 2;
  return law_work(law, law_stretch(law, tension));
}

}  // namespace tensegric_fit::tensegric
