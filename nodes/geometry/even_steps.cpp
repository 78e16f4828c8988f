#include "geometry/even_steps.hpp"

#include <algorithm>

#include "geometry/section.hpp"

namespace tensegric_fit::geometry {

std::vector<Eigen::Vector3d> between_ends(const std::vector<Eigen::Vector3d>& line, int count) {
  const double length = length_of(line, false);
  std::vector<Eigen::Vector3d> points;
  double behind = 0;
  std::size_t s = 0;
  for (int i = 1; i <= count; ++i) {
    const double target = length * i / (count + 1);
    double step = (line[s + 1] - line[s]).norm();
    while (s + 2 < line.size() && behind + step < target) {
      behind += step;
      ++s;
      step = (line[s + 1] - line[s]).norm();
    }
    points.push_back(line[s] +
                     (line[s + 1] - line[s]) * (step > 0 ? std::min(1.0, (target - behind) / step) : 0.0));
  }
  return points;
}

std::vector<std::pair<std::size_t, double>> even_places(const std::vector<Eigen::Vector3d>& line, int count) {
  std::vector<double> at{0};
  for (std::size_t i = 1; i < line.size(); ++i) at.push_back(at.back() + (line[i] - line[i - 1]).norm());
  std::vector<std::pair<std::size_t, double>> places;
  std::size_t segment = 0;
  for (int k = 0; k < count; ++k) {
    const double wanted = at.back() * k / (count - 1);
    while (segment + 2 < line.size() && at[segment + 1] < wanted) ++segment;
    const double length = at[segment + 1] - at[segment];
    places.emplace_back(segment, length > 0 ? std::min(1.0, (wanted - at[segment]) / length) : 0);
  }
  return places;
}

}  // namespace tensegric_fit::geometry
