#include "geometry/even_steps.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/points.hpp"
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

std::vector<Eigen::Vector3d> even_steps(const std::vector<Eigen::Vector3d>& line, double step,
                                        double length) {
  std::vector<Eigen::Vector3d> even{line.front()};
  double left = step;  // to go to the next point
  for (std::size_t i = 1; i < line.size() && static_cast<double>(even.size()) * step < length; ++i) {
    const Eigen::Vector3d way = line[i] - line[i - 1];
    const double whole = way.norm();
    double gone = 0;
    while (whole - gone >= left) {
      gone += left;
      even.push_back(line[i - 1] + gone / whole * way);
      left = step;
    }
    left -= whole - gone;
  }
  return even;
}

std::vector<Eigen::Vector3d> first_harmonics(std::vector<Eigen::Vector3d> loop, int harmonics, int count) {
  loop.push_back(loop.front());
  const double whole = length_of(loop, false);
  if (!(whole > 0)) return std::vector<Eigen::Vector3d>(count, loop.front());
  loop = even_steps(loop, whole / count, whole);
  loop.resize(count, loop.front());  // rounding may add the first one again, or leave out the last
  const Eigen::Vector3d middle = mean_of(loop);
  std::vector<Eigen::Vector3d> smooth(count, middle);
  for (int h = 1; h <= harmonics; ++h) {
    Eigen::Vector3d even = Eigen::Vector3d::Zero(), odd = Eigen::Vector3d::Zero();
    for (int i = 0; i < count; ++i) {
      even += std::cos(2 * M_PI * h * i / count) * (loop[i] - middle) * 2 / count;
      odd += std::sin(2 * M_PI * h * i / count) * (loop[i] - middle) * 2 / count;
    }
    for (int i = 0; i < count; ++i)
      smooth[i] += std::cos(2 * M_PI * h * i / count) * even + std::sin(2 * M_PI * h * i / count) * odd;
  }
  return smooth;
}

}  // namespace tensegric_fit::geometry
