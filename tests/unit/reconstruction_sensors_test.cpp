#include <gtest/gtest.h>

#include <algorithm>

#include "reconstruction/registration.hpp"
#include "reconstruction_figure.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using Eigen::Vector3d;

/// Depth images of the figure, one cloud of all sensors.
struct Capture {
  std::vector<Vector3d> points, truth;  // as the booth believes, and on the skin apart from noise
  std::vector<int> sensor;
};

constexpr int kSquare = 4;              // sensors
constexpr double kAlongTheRay = 0.001;  // m, noise

/// Four sensors in a square round the figure, a pixel every 4 mm of skin; each is up to 2 mm and 2 mrad off.
Capture capture() {
  constexpr double kFar = 1.2, kPixel = 0.004 / kFar;
  std::mt19937 random(5);
  Capture result;
  for (int s = 0; s < kSquare; ++s) {
    const double turn = M_PI / 4 + M_PI / 2 * s;
    const Vector3d outward(std::cos(turn), std::sin(turn), 0), across(-outward.y(), outward.x(), 0);
    const Vector3d eye = kFar * outward + 0.8 * Vector3d::UnitZ();
    const Vector3d shift = 0.001 * figure::direction(random), axis = figure::direction(random);
    const Eigen::Isometry3d error = Eigen::Translation3d(2 * shift) * Eigen::AngleAxisd(0.001, axis);
    for (int row = -230; row <= 240; ++row) {
      for (int column = -110; column <= 110; ++column) {
        const Vector3d ray = (-outward + kPixel * (column * across + row * Vector3d::UnitZ())).normalized();
        double depth = 0.7, distance = 1;
        for (int step = 0; step < 60 && distance > 1e-5 && depth < 2; ++step)
          depth += distance = figure::distance(eye + depth * ray);
        const Vector3d hit = eye + depth * ray;
        if (distance > 1e-5 || hit.z() < 0.01) continue;
        result.truth.push_back(hit);
        // As a scan file keeps it.
        result.points.push_back(
            (error * (hit + kAlongTheRay * figure::gaussian(random) * ray)).cast<float>().cast<double>());
        result.sensor.push_back(s);
      }
    }
  }
  return result;
}

TEST(ReconstructionSensors, SensorsThatAreOffAreBroughtTogether) {
  const Capture scan = capture();
  std::vector<Vector3d> points = scan.points;
  register_sensors(points, scan.sensor);
  // How far the sensors are apart: their mean errors against the mean of these.
  const auto apart = [&](const std::vector<Vector3d>& of) {
    std::vector<Vector3d> sum(kSquare, Vector3d::Zero());
    std::vector<double> count(kSquare);
    for (std::size_t i = 0; i < of.size(); ++i) {
      sum[scan.sensor[i]] += of[i] - scan.truth[i];
      ++count[scan.sensor[i]];
    }
    Vector3d mean = Vector3d::Zero();
    for (int s = 0; s < kSquare; ++s) mean += sum[s] / count[s] / kSquare;
    double most = 0;
    for (int s = 0; s < kSquare; ++s) most = std::max(most, (sum[s] / count[s] - mean).norm());
    return most;
  };
  EXPECT_GT(apart(scan.points), 0.0015);
  EXPECT_LT(apart(points),
            0.0003);  // noise of 1 mm over thousands of points, upright capsules hold little in z
}

TEST(ReconstructionSensors, SensorsThatWereBroughtTogetherStayWhereTheyAre) {
  const Capture scan = capture();
  std::vector<Vector3d> once = scan.points;
  register_sensors(once, scan.sensor);
  std::vector<Vector3d> twice = once;
  register_sensors(twice, scan.sensor);
  EXPECT_EQ(twice, once);
}

// Farther off a sensor is not worn but wrong, and what it agrees with may be other skin.
TEST(ReconstructionSensors, NoSensorMovesByMoreThanTenMillimetres) {
  const Capture scan = capture();
  const Vector3d outward = Vector3d(1, 1, 0).normalized();  // of sensor 0
  for (const double off : {0.010, 0.014, 0.018, 0.022}) {
    std::vector<Vector3d> before = scan.points;
    for (std::size_t i = 0; i < before.size(); ++i)
      if (scan.sensor[i] == 0) before[i] += off * outward;
    std::vector<Vector3d> points = before;
    register_sensors(points, scan.sensor);
    std::vector<Vector3d> sum(kSquare, Vector3d::Zero());
    std::vector<double> count(kSquare);
    for (std::size_t i = 0; i < points.size(); ++i) {
      sum[scan.sensor[i]] += points[i] - before[i];
      ++count[scan.sensor[i]];
    }
    for (int s = 0; s < kSquare; ++s)
      EXPECT_LT((sum[s] / count[s]).norm(), 0.0105)
          << off;  // the mean turns by 0.01 about the middle at most
  }
}

// They share the rims of what they see alone, which bend away from both.
TEST(ReconstructionSensors, SensorsAcrossFromEachOtherStayWhereTheyAre) {
  const Capture scan = capture();
  std::vector<Vector3d> before;
  std::vector<int> sensor;
  for (std::size_t i = 0; i < scan.points.size(); ++i)
    if (scan.sensor[i] % 2 == 0) {
      before.push_back(scan.points[i]);
      sensor.push_back(scan.sensor[i]);
    }
  std::vector<Vector3d> points = before;
  register_sensors(points, sensor);
  EXPECT_EQ(points, before);
}

TEST(ReconstructionSensors, OneSensorStaysWhereItIs) {
  const Capture scan = capture();
  std::vector<Vector3d> points = scan.points;
  register_sensors(points, std::vector<int>(points.size(), 0));
  EXPECT_EQ(points, scan.points);
}

}  // namespace
}  // namespace tensegric_fit::reconstruction
