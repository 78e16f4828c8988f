#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "geometry/status.hpp"
#include "virtual_body/virtual_body.hpp"
#include "virtual_booth/virtual_scanner.hpp"

namespace tensegric_fit {
namespace {

using Eigen::Vector3d;
using virtual_booth::ScannerOptions;
using virtual_booth::VirtualScan;

const virtual_body::VirtualBody& scanned_body() {
  static const virtual_body::VirtualBody made = virtual_body::make_body({});
  return made;
}

// A ball whose distance is known exactly; its chords are less than 0.02 mm off.
constexpr double kRadius = 0.4;
const Vector3d kCentre(0, 0, 0.5);

const geometry::TriangleMesh& ball() {
  static const geometry::TriangleMesh mesh = [] {
    constexpr int rings = 150, sectors = 300;
    geometry::TriangleMesh m;
    for (int i = 0; i <= rings; ++i)
      for (int j = 0; j < sectors; ++j) {
        const double a = M_PI * (i + 0.5) / (rings + 1), b = 2 * M_PI * j / sectors;
        m.vertices.push_back(
            kCentre + kRadius * Vector3d(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
      }
    for (int i = 0; i < rings; ++i)
      for (int j = 0; j < sectors; ++j) {
        const int a = i * sectors + j, b = i * sectors + (j + 1) % sectors;
        m.triangles.emplace_back(a, a + sectors, b);
        m.triangles.emplace_back(b, a + sectors, b + sectors);
      }
    return m;
  }();
  return mesh;
}

ScannerOptions perfect() {
  ScannerOptions options;
  options.points = 20000;
  options.noise = options.outliers = options.misregistration = 0;
  return options;
}

double off_ball(const Vector3d& p) {
  return (p - kCentre).norm() - kRadius;
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

double nearest(const VirtualScan& scan, const Vector3d& p) {
  double distance = std::numeric_limits<double>::infinity();
  for (const Vector3d& q : scan.cloud.points) distance = std::min(distance, (p - q).norm());
  return distance;
}

TEST(VirtualScannerTest, SameSeedSameBitsOtherSeedOtherPoints) {
  ScannerOptions options;
  const VirtualScan a = virtual_booth::scan_body(scanned_body().mesh, options),
                    b = virtual_booth::scan_body(scanned_body().mesh, options);
  EXPECT_EQ(a.cloud.points, b.cloud.points);
  EXPECT_EQ(a.sensor, b.sensor);
  EXPECT_EQ(a.cloud.points.size(), 180000u);
  EXPECT_EQ(a.sensor.size(), a.cloud.points.size());
  EXPECT_EQ(std::set<int>(a.sensor.begin(), a.sensor.end()).size(), 12u);  // 4 columns of 3
  options.seed = 2;
  EXPECT_NE(a.cloud.points, virtual_booth::scan_body(scanned_body().mesh, options).cloud.points);
}

TEST(VirtualScannerTest, WithoutErrorsPointsLieOnTheSurfaceFacingTheirSensor) {
  const ScannerOptions options = perfect();
  const VirtualScan scan = virtual_booth::scan_body(ball(), options);
  for (std::size_t i = 0; i < scan.cloud.points.size(); ++i) {
    const Vector3d& p = scan.cloud.points[i];
    ASSERT_LT(std::abs(off_ball(p)), 0.00005);  // chords
    const double angle = M_PI / 4 + M_PI / 2 * (scan.sensor[i] / 3);
    const Vector3d sensor(1.40 * std::cos(angle), 1.40 * std::sin(angle),
                          0.9 / 3 * (scan.sensor[i] % 3 + 0.5));
    const double incidence = (p - kCentre).normalized().dot((sensor - p).normalized());
    ASSERT_GT(incidence, options.grazing - 0.03);  // the faces' normals are up to 0.02 rad off the ball's
  }
}

TEST(VirtualScannerTest, NoiseHasTheStatedDeviationAlongTheRay) {
  ScannerOptions options = perfect();
  options.noise = 0.002;
  options.grazing = 0.8;  // steep rays alone: there the distance is 0.8 to 1 of the error along the ray
  std::vector<double> distances;
  for (const Vector3d& p : virtual_booth::scan_body(ball(), options).cloud.points)
    distances.push_back(std::abs(off_ball(p)));
  const double median = quantile(distances, 0.5),
               expected = 0.6745 * options.noise;  // of a normal distribution
  EXPECT_GT(median, 0.80 * expected);
  EXPECT_LT(median, 1.02 * expected);
  EXPECT_GT(quantile(distances, 0.999),
            2.4 * options.noise);  // tails are there: 3.3 deviations at incidence 0.8 to 1
}

TEST(VirtualScannerTest, OutliersHaveTheStatedShare) {
  ScannerOptions options = perfect();
  options.outliers = 0.05;
  int off = 0;
  for (const Vector3d& p : virtual_booth::scan_body(ball(), options).cloud.points)
    off += std::abs(off_ball(p)) > 0.001;
  // 1000 wanted; a few per cent of them fall within 1 mm; three deviations of a count are 95
  EXPECT_NEAR(off, 960, 130);
}

TEST(VirtualScannerTest, MisregistrationShiftsWholeColumns) {
  ScannerOptions options = perfect();
  options.misregistration = 0.003;
  const VirtualScan scan = virtual_booth::scan_body(ball(), options);
  std::vector<std::vector<double>> of_column(4);
  for (std::size_t i = 0; i < scan.sensor.size(); ++i)
    of_column[scan.sensor[i] / 3].push_back(off_ball(scan.cloud.points[i]));
  double spread = 0;
  for (const auto& distances : of_column) spread = std::max(spread, std::abs(quantile(distances, 0.5)));
  EXPECT_GT(spread,
            0.0005);  // four normal shifts of 3 mm, all nearly along the surface: never with this seed
  EXPECT_LT(spread, 0.0120);  // four deviations
}

TEST(VirtualScannerTest, EachSensorsPointsLieBeforeItAndItsErrorIsKnown) {
  ScannerOptions options = perfect();
  options.misregistration = 0.003;
  const VirtualScan scan = virtual_booth::scan_body(ball(), options);
  const std::vector<virtual_booth::SensorScan> parts = virtual_booth::by_sensor(scan);
  ASSERT_EQ(parts.size(), 12u);  // 4 columns of 3
  std::size_t points = 0;
  for (std::size_t s = 0; s < parts.size(); ++s) {
    const virtual_booth::SensorPose& pose = parts[s].pose;
    EXPECT_EQ(pose.column, static_cast<int>(s) / 3);
    EXPECT_NEAR(pose.booth_from_sensor.linear().determinant(), 1, 1e-12);  // no mirror image
    // Without its error the sensor stands where the booth was built, upright
    const Eigen::Isometry3d built = pose.error.inverse() * pose.booth_from_sensor;
    EXPECT_NEAR(built.translation().head<2>().norm(), options.distance, 1e-12);
    EXPECT_NEAR(built.linear()(2, 1), -1, 1e-12);
    for (const Vector3d& p : parts[s].cloud.points) {
      ASSERT_LT(std::abs(off_ball(pose.error.inverse() * p)), 0.00005);  // chords
      ASSERT_GT((pose.booth_from_sensor.inverse() * p).z(), options.distance - kRadius - 0.02);
    }
    points += parts[s].cloud.points.size();
  }
  EXPECT_EQ(points, scan.cloud.points.size());
}

TEST(VirtualScannerTest, HiddenSkinHasNoPoints) {
  ScannerOptions options;
  options.outliers = 0;
  const VirtualScan scan = virtual_booth::scan_body(scanned_body().mesh, options);
  for (const char* name : {"crotch", "axilla_L", "axilla_R"})
    EXPECT_GT(nearest(scan, scanned_body().truth.landmark(name)), 0.004)
        << name;                                       // points are 3 mm apart where skin is seen
  EXPECT_GT(nearest(scan, {0.09, 0.11, 0.0}), 0.010);  // sole
  for (const char* name : {"bust_point_L", "bust_point_R", "buttock_L", "navel", "neck_front"})
    EXPECT_LT(nearest(scan, scanned_body().truth.landmark(name)), 0.006) << name;
}

TEST(VirtualScannerTest, FloorIsThereOnRequestOnly) {
  const auto floor_points = [](const VirtualScan& scan) {
    return std::count_if(scan.cloud.points.begin(), scan.cloud.points.end(), [](const Vector3d& p) {
      return std::abs(p.z()) < 0.005 && p.head<2>().norm() > 0.35;  // beyond the feet
    });
  };
  ScannerOptions options;
  EXPECT_EQ(floor_points(virtual_booth::scan_body(scanned_body().mesh, options)), 0);
  options.floor = true;
  const VirtualScan scan = virtual_booth::scan_body(scanned_body().mesh, options);
  EXPECT_GT(floor_points(scan), 10000);
  for (const Vector3d& p : scan.cloud.points) ASSERT_LT(p.head<2>().norm(), options.floor_radius + 0.2);
}

TEST(VirtualScannerTest, TheFrameIsSeenOnRequestOnly) {
  const auto frame_points = [](const VirtualScan& scan) {
    return std::count_if(scan.cloud.points.begin(), scan.cloud.points.end(),
                         [](const Vector3d& p) { return p.z() > 1.9 && p.head<2>().norm() > 0.7; });
  };
  ScannerOptions options;
  options.outliers = 0;
  EXPECT_EQ(frame_points(virtual_booth::scan_body(scanned_body().mesh, options)), 0);
  options.frame = true;
  EXPECT_GT(frame_points(virtual_booth::scan_body(scanned_body().mesh, options)), 1000);
}

TEST(VirtualScannerTest, DarkPatchesLoseTheirShareOfPoints) {
  ScannerOptions options = perfect();
  const auto on_top = [&options] {
    const VirtualScan scan = virtual_booth::scan_body(ball(), options);
    const auto count = std::count_if(scan.cloud.points.begin(), scan.cloud.points.end(),
                                     [](const Vector3d& p) { return p.z() > kCentre.z(); });
    return static_cast<double>(count) / static_cast<double>(scan.cloud.points.size());
  };
  const double before = on_top();
  // A box-like ellipsoid: all of the upper half, nothing of the lower one
  options.dark = {{kCentre + Vector3d(0, 0, 9), Vector3d(9, 9, 9), 0.75}};
  const double left = 0.25 * before;
  EXPECT_NEAR(on_top(), left / (left + 1 - before), 0.03);  // 20,000 points; the ellipsoid's curvature: 9 mm
}

TEST(VirtualScannerTest, AFractureShiftsWhatLaterColumnsSee) {
  ScannerOptions options = perfect();
  options.fracture = {kCentre, Vector3d::Constant(0.8), Vector3d(0, 0, 0.02), 2};
  // On the ball's skin, halfway to the edge of the ellipsoid
  const double expected = 0.02 * (1 - 0.25) * (1 - 0.25);
  const VirtualScan scan = virtual_booth::scan_body(ball(), options);
  for (std::size_t i = 0; i < scan.cloud.points.size(); ++i) {
    const Vector3d back = scan.cloud.points[i] - Vector3d(0, 0, scan.sensor[i] / 3 >= 2 ? expected : 0);
    ASSERT_LT(std::abs(off_ball(back)), 0.00006);  // chords
  }
}

TEST(VirtualScannerTest, OptionsOutOfRangeAreRefusedByName) {
  const auto refused = [](ScannerOptions options) {
    try {
      virtual_booth::scan_body(ball(), options);
    } catch (const geometry::Refusal& refusal) {
      return refusal.code() + " " + refusal.what();
    }
    return std::string("accepted");
  };
  ScannerOptions options;
  options.columns = 1;
  EXPECT_NE(refused(options).find("bad_option option 'columns'"), std::string::npos);
  options = {};
  options.noise = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refused(options).find("bad_option option 'noise'"), std::string::npos);
  options = {};
  options.points = -5;
  EXPECT_NE(refused(options).find("bad_option option 'points'"), std::string::npos);
  EXPECT_THROW(virtual_booth::scan_body({}, ScannerOptions()), geometry::Refusal);
}

TEST(VirtualScannerTest, ABoothThatLeansSeesItsFloorLeanToo) {
  ScannerOptions options = perfect();
  options.floor = true;
  options.sensors_per_column = 1;  // high enough to look down
  options.grazing = 0;
  options.booth_from_scan =
      Eigen::Translation3d(0.3, -0.2, 0.1) * Eigen::AngleAxisd(0.1, Vector3d(1, 2, 0).normalized());
  const Eigen::Isometry3d scan_from_booth = options.booth_from_scan.inverse();
  geometry::TriangleMesh mesh = ball();
  for (Vector3d& p : mesh.vertices) p = scan_from_booth * p;
  const VirtualScan scan = virtual_booth::scan_body(mesh, options);
  int on_floor = 0, on_ball = 0;
  for (const Vector3d& p : scan.cloud.points) {
    const Vector3d q = options.booth_from_scan * p;
    const bool floor = std::abs(q.z()) < 1e-9;  // rounding of metres
    on_floor += floor;
    on_ball += !floor && std::abs(off_ball(q)) < 1e-4;  // chords
  }
  EXPECT_EQ(on_floor + on_ball, static_cast<int>(scan.cloud.points.size()));
  EXPECT_GT(on_floor, 1000);
  EXPECT_GT(on_ball, 5000);
  for (const virtual_booth::SensorPose& sensor :
       scan.sensors) {  // upright in the booth, so leaning in the scan
    const Eigen::Isometry3d upright = options.booth_from_scan * sensor.booth_from_sensor;
    EXPECT_NEAR(upright.linear()(2, 1), -1, 1e-12);
  }
}

}  // namespace
}  // namespace tensegric_fit
