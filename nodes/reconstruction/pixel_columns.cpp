#include "reconstruction/pixel_columns.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numeric>
#include <optional>
#include <unsupported/Eigen/FFT>

#include "geometry/halves.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using Points = std::vector<Eigen::Vector3d>;
using Parameters = Eigen::Matrix<double, 7, 1>;

constexpr double kSkin = 1.8;   // m^2
constexpr double kPatch = 320;  // points of all sensors in the patch that a search starts from
constexpr double kSmallest = 0.02, kLargest = 0.07;  // m; its radius
constexpr std::size_t kFewest = 60;                  // free points of a patch
constexpr int kTurns = 45;                           // directions of sight over half a turn
constexpr std::array<double, 5> kRolls = {-0.05, -0.025, 0, 0.025, 0.05};
constexpr int kBins = 512;                             // across four radii
constexpr double kFinest = 0.0018, kCoarsest = 0.009;  // m between columns of pixels on the skin
constexpr float kClear = 14;                           // power of a peak; the highest of noise is 10
constexpr double kGrowth = 1.5;                        // of the radius, from one fit to the next
constexpr double kWholeBody = 2.2;                     // m
constexpr double kFar = 0.15;                          // m; within it every point is used
constexpr std::size_t kOfSearch = 40000, kOfAFit = 3000, kOfLastFit = 12000;  // points
constexpr double kSignificant = 6;                                            // standard deviations
constexpr double kExact = 0.002;               // pixels from the middle of a column, of a sensor's points
constexpr std::size_t kFewestOfASensor = 100;  // of those of a search
constexpr int kTries = 120, kTriesWithoutGain = 20, kMostSensors = 32;
constexpr double kRest = 0.01;  // share of points that need no sensor

/// Column of pixels of a point of one sensor: (a.q + a0) / (b.q + 1), q from `origin`; whole numbers are
/// middles.
struct PixelColumns {
  Eigen::Vector3d origin;
  Parameters parameters;  // a, a0, b

  double depth(const Eigen::Vector3d& p) const { return 1 + parameters.tail<3>().dot(p - origin); }
  double column(const Eigen::Vector3d& p) const {
    return (parameters.head<3>().dot(p - origin) + parameters[3]) / depth(p);
  }
  /// From the nearest column's middle; half a pixel behind the sensor.
  double off(const Eigen::Vector3d& p) const {
    constexpr double kMostColumns = 1e6;
    if (depth(p) <= 0) return 0.5;
    const double c = column(p) + kMostColumns;
    return c > 0 && c < 2 * kMostColumns ? c - static_cast<int>(c + 0.5) : 0.5;
  }
};

/// Where the planes of a sensor's columns meet: a nearly upright line through it.
struct Axis {
  Eigen::Vector3d point, direction;

  explicit Axis(const PixelColumns& sensor) {
    const Eigen::Vector3d a = sensor.parameters.head<3>(), b = sensor.parameters.tail<3>();
    direction = a.cross(b);
    Eigen::Matrix3d rows;
    rows << a.transpose(), b.transpose(), direction.transpose();
    point = sensor.origin + rows.inverse() * Eigen::Vector3d(-sensor.parameters[3], -1, 0);
  }
  /// Level, unit.
  Eigen::Vector3d seen_from(const Eigen::Vector3d& p) const {
    return (point + direction * ((p.z() - point.z()) / direction.z()) - p).normalized();
  }
};

/// Up to `most` of them, evenly from the whole list.
std::vector<int> some(std::vector<int> points, std::size_t most) {
  if (points.size() <= most) return points;
  for (std::size_t k = 0; k < most; ++k) points[k] = points[k * points.size() / most];
  points.resize(most);
  return points;
}

/// Up to `most` of the points within `radius` of `centre`, evenly from the whole list.
std::vector<int> around(const Points& points, const std::vector<int>& free, const Eigen::Vector3d& centre,
                        double radius, std::size_t most) {
  std::vector<int> near;
  for (int i : free)
    if ((points[i] - centre).squaredNorm() < radius * radius) near.push_back(i);
  return some(std::move(near), most);
}

/// The most even planes in a patch: their normal, as long as there are planes in a metre.
std::optional<Eigen::Vector3d> even_planes(const Points& points, const std::vector<int>& patch,
                                           const Eigen::Vector3d& centre, double radius) {
  const double window = 4 * radius;
  const int lowest = static_cast<int>(window / kCoarsest), highest = static_cast<int>(window / kFinest);
  Eigen::FFT<float> transform;
  transform.SetFlag(Eigen::FFT<float>::HalfSpectrum);
  std::vector<float> count(kBins);
  std::vector<std::complex<float>> spectrum;
  float best = kClear * static_cast<float>(patch.size());
  std::optional<Eigen::Vector3d> normal;
  for (double roll : kRolls) {
    for (int turn = 0; turn < kTurns; ++turn) {
      const double angle = M_PI * turn / kTurns;
      const Eigen::Vector3d across(std::cos(angle) * std::cos(roll), std::sin(angle) * std::cos(roll),
                                   std::sin(roll));
      std::fill(count.begin(), count.end(), 0.0F);
      for (int i : patch)
        ++count[static_cast<std::size_t>((across.dot(points[i] - centre) / window + 0.5) * kBins)];
      transform.fwd(spectrum, count);
      for (int k = lowest; k < highest; ++k) {
        if (std::norm(spectrum[k]) <= best) continue;
        best = std::norm(spectrum[k]);
        normal = across * (k / window);
      }
    }
  }
  return normal;
}

/// One step of least squares on the points within `gate` pixels of a column's middle, lengths in `radius`.
bool fit(PixelColumns& sensor, const Points& points, const std::vector<int>& near, double gate, double radius,
         bool perspective) {
  Eigen::Matrix<double, 7, 7> squares = Eigen::Matrix<double, 7, 7>::Zero();
  Parameters right = Parameters::Zero();
  std::size_t count = 0;
  for (int i : near) {
    const double off = sensor.off(points[i]);
    if (std::abs(off) > gate) continue;
    const double depth = sensor.depth(points[i]);
    const Eigen::Vector3d q = (points[i] - sensor.origin) / (radius * depth);
    Parameters row;
    row << q, 1 / depth, -sensor.column(points[i]) * q;
    squares.selfadjointView<Eigen::Lower>().rankUpdate(row);
    right -= off * row;
    ++count;
  }
  if (count < kFewest / 2) return false;
  squares = Eigen::Matrix<double, 7, 7>(squares.selfadjointView<Eigen::Lower>());
  if (!perspective) {
    squares.bottomRows<3>().setZero();
    squares.rightCols<3>().setZero();
    right.tail<3>().setZero();
  }
  squares.diagonal().array() += 1e-9 * squares.trace();
  Parameters step = squares.ldlt().solve(right);
  step.head<3>() /= radius;
  step.tail<3>() /= radius;
  sensor.parameters += step;
  const double planes =
      (sensor.parameters.head<3>() - sensor.parameters[3] * sensor.parameters.tail<3>()).norm();
  return planes > 1 / kCoarsest && planes < 1 / kFinest;  // false for NaN
}

std::size_t count_within(const PixelColumns& sensor, const Points& points, const std::vector<int>& of,
                         double gate) {
  return std::count_if(of.begin(), of.end(), [&](int i) { return std::abs(sensor.off(points[i])) < gate; });
}

/// More points in columns than by chance.
bool significant(const PixelColumns& sensor, const Points& points, const std::vector<int>& near) {
  constexpr double kGate = 0.03;
  const double chance = 2 * kGate * static_cast<double>(near.size());
  return static_cast<double>(count_within(sensor, points, near, kGate)) >
         chance + kSignificant * std::sqrt(chance);
}

/// Most points that are nearly in the middle of a column are exactly there.
bool exact(const PixelColumns& sensor, const Points& points, const std::vector<int>& free) {
  const std::size_t inner = count_within(sensor, points, free, kExact);
  if (inner <= kFewestOfASensor) return false;
  const std::size_t outer = count_within(sensor, points, free, 4 * kExact) - inner;
  return inner > 3 * outer;
}

/// The sensor that sees most of a patch, fitted from there outward.
std::optional<PixelColumns> sensor_from(const Points& points, const std::vector<int>& free,
                                        const Eigen::Vector3d& centre, double radius) {
  std::vector<int> near = around(points, free, centre, radius, points.size());
  if (near.size() < kFewest) return std::nullopt;
  const std::optional<Eigen::Vector3d> planes = even_planes(points, near, centre, radius);
  if (!planes) return std::nullopt;
  std::complex<double> mean = 0;
  for (int i : near) mean += std::polar(1.0, 2 * M_PI * planes->dot(points[i] - centre));
  PixelColumns sensor{centre, Parameters::Zero()};
  sensor.parameters.head<3>() = *planes;
  sensor.parameters[3] = -std::arg(mean) / (2 * M_PI);
  for (double gate : {0.25, 0.2, 0.15})
    if (!fit(sensor, points, near, gate, radius, false)) return std::nullopt;
  const std::vector<int> search = some(free, kOfSearch);
  while (radius < kWholeBody) {
    radius *= kGrowth;
    near = around(points, radius < kFar ? free : search, centre, radius, kOfAFit);
    for (double gate : {0.2, 0.12, 0.06, 0.03, 0.03})
      if (!fit(sensor, points, near, gate, radius, true)) return std::nullopt;
    if (!significant(sensor, points, near)) return std::nullopt;
  }
  near = some(search, kOfLastFit);
  for (double gate : {0.03, 0.03, 0.03, 0.015, 0.008, 0.004, kExact, kExact})
    if (!fit(sensor, points, near, gate, 1, true)) return std::nullopt;
  if (!exact(sensor, points, search)) return std::nullopt;
  return sensor;
}

std::vector<PixelColumns> find_sensors(const Points& points) {
  const double radius = std::clamp(std::sqrt(kPatch * kSkin / (M_PI * static_cast<double>(points.size()))),
                                   kSmallest, kLargest);
  std::vector<int> free(points.size());
  std::iota(free.begin(), free.end(), 0);
  const auto rest = static_cast<std::size_t>(kRest * static_cast<double>(points.size()));
  std::vector<PixelColumns> sensors;
  const auto sensor_of_try = [&](int i) {
    const double golden = std::fmod(0.5 + i * 0.61803398875, 1.0);
    const int start = free[static_cast<std::size_t>(golden * static_cast<double>(free.size()))];
    return sensor_from(points, free, points[start], radius);
  };
  std::optional<PixelColumns> ahead;  // of try `ahead_of`, made beside the one before
  int without_gain = 0, ahead_of = -1;
  for (int i = 0;
       i < kTries && without_gain < kTriesWithoutGain && free.size() > rest && sensors.size() < kMostSensors;
       ++i) {
    std::optional<PixelColumns> sensor;
    if (i == ahead_of) {
      sensor = ahead;
    } else if (without_gain == 0) {
      sensor = sensor_of_try(i);
    } else {  // where one found nothing, the next one mostly finds nothing, too
      ahead_of = i + 1;
      geometry::in_halves(2, [&](std::size_t half, std::size_t, int) {
        (half == 0 ? sensor : ahead) = sensor_of_try(i + static_cast<int>(half));
      });
    }
    ++without_gain;
    if (!sensor) continue;
    without_gain = 0;
    ahead_of = -1;  // fewer points are free now
    sensors.push_back(*sensor);
    free.erase(std::remove_if(free.begin(), free.end(),
                              [&](int p) { return std::abs(sensor->off(points[p])) < kExact; }),
               free.end());
  }
  return sensors;
}

/// The sensor in the middle of whose columns each point is best; -1 where it is in none.
std::vector<int> best_of(const std::vector<PixelColumns>& sensors, const Points& points) {
  std::vector<int> best(points.size(), -1);
  geometry::in_halves(points.size(), [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t i = begin; i < end; ++i) {
      double least = kExact;
      for (std::size_t s = 0; s < sensors.size(); ++s) {
        const double off = std::abs(sensors[s].off(points[i]));
        if (off >= least) continue;
        least = off;
        best[i] = static_cast<int>(s);
      }
    }
  });
  return best;
}

}  // namespace

Sightings sightings_of(const Points& points) {
  if (points.empty()) return {};
  const std::vector<PixelColumns> found = find_sensors(points);
  std::vector<int> sensor = best_of(found, points);
  // One that was found twice has but a few points the second time.
  std::vector<PixelColumns> sensors;
  for (std::size_t s = 0; s < found.size(); ++s)
    if (static_cast<double>(std::count(sensor.begin(), sensor.end(), static_cast<int>(s))) >
        kRest * static_cast<double>(points.size()))
      sensors.push_back(found[s]);
  if (sensors.empty()) return {};
  if (sensors.size() < found.size()) sensor = best_of(sensors, points);
  const std::vector<Axis> axes(sensors.begin(), sensors.end());
  std::vector<Eigen::Vector3d> towards(points.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (sensor[i] >= 0) towards[i] = axes[sensor[i]].seen_from(points[i]);
  return {std::move(sensor), std::move(towards)};
}

}  // namespace tensegric_fit::reconstruction
