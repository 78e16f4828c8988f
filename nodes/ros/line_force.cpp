#include "ros/line_force.hpp"

#include <cmath>

namespace tensegric_fit::node {

std::optional<LineForce> force_of(const LineForces& forces, const FitState& fit, std::size_t line) {
  const std::size_t count = fit.lines.size();
  const bool whole = forces.lines.size() == count && forces.tension.size() == count &&
                     forces.newtons.size() == count && forces.kilopascals.size() == count;
  if (!whole || forces.scan_id != fit.scan_id || forces.garment != fit.garment) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i)
    if (forces.lines[i] != fit.lines[i].name || forces.tension[i] != fit.lines[i].tension)
      return std::nullopt;
  const LineForce force{forces.newtons.at(line), forces.kilopascals.at(line)};
  if (!std::isfinite(force.newtons) || !std::isfinite(force.kilopascals)) return std::nullopt;
  return force;
}

}  // namespace tensegric_fit::node
