#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>

#include "assembler/assembler.hpp"
#include "assembler/column_pairs.hpp"
#include "geometry/status.hpp"
#include "virtual_body/virtual_body.hpp"
#include "virtual_booth/virtual_scanner.hpp"

namespace tensegric_fit {
namespace {

using assembler::AssemblerOptions;
using assembler::Assembly;
using assembler::Capture;
using assembler::RegistrationStatus;
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A scan as the sensors would send it, each in its own frame.
struct Booth {
  Capture capture;
  std::vector<Isometry3d> booth_from_sensor;
  std::vector<virtual_booth::SensorPose> truth;
};

const geometry::TriangleMesh& body() {
  static const geometry::TriangleMesh mesh = virtual_body::make_body({}).mesh;
  return mesh;
}

Booth scanned(const virtual_booth::ScannerOptions& options) {
  Booth result;
  for (const virtual_booth::SensorScan& scan :
       virtual_booth::by_sensor(virtual_booth::scan_body(body(), options))) {
    assembler::SensorCloud cloud{5, "", {}};
    for (const Vector3d& p : scan.cloud.points)
      cloud.cloud.points.push_back(scan.pose.booth_from_sensor.inverse() * p);
    result.capture.clouds.push_back(std::make_shared<const assembler::SensorCloud>(cloud));
    result.booth_from_sensor.push_back(scan.pose.booth_from_sensor);
    result.truth.push_back(scan.pose);
  }
  return result;
}

virtual_booth::ScannerOptions options_off_by(double misregistration) {
  virtual_booth::ScannerOptions options;
  options.points = 60000;
  options.misregistration = misregistration;
  return options;
}

const Booth& off_by(double misregistration) {
  static std::map<double, Booth> booths;
  const auto found = booths.find(misregistration);
  if (found != booths.end()) return found->second;
  return booths[misregistration] = scanned(options_off_by(misregistration));
}

AssemblerOptions by_column() {
  AssemblerOptions options;
  options.sensors_per_column = 3;  // as in ScannerOptions
  return options;
}

/// Root mean square distance, over the body's height, between where columns put a point: what one column says
/// against the mean of all.
double disagreement(const Booth& booth, const std::vector<Isometry3d>& corrections) {
  double sum = 0;
  int count = 0;
  for (const Vector3d& corner : {Vector3d(0.2, 0.2, 0.2), Vector3d(-0.2, 0.2, 1), Vector3d(0.2, -0.2, 1.6)}) {
    std::vector<Vector3d> places;
    Vector3d mean = Vector3d::Zero();
    for (std::size_t c = 0; c < corrections.size(); ++c) {
      places.push_back(corrections[c] * (booth.truth[3 * c].error * corner));
      mean += places.back() / static_cast<double>(corrections.size());
    }
    for (const Vector3d& place : places) sum += (place - mean).squaredNorm();
    count += static_cast<int>(places.size());
  }
  return std::sqrt(sum / count);
}

double before(const Booth& booth) {
  return disagreement(booth, std::vector<Isometry3d>(4, Isometry3d::Identity()));
}

TEST(AssemblerTest, EveryPointIsWhereItsSensorSawItAndItsNormalLooksBack) {
  const Booth& booth = off_by(0);
  AssemblerOptions options = by_column();
  options.refine = false;
  const Assembly assembly = assemble(booth.capture, booth.booth_from_sensor, options);
  EXPECT_FALSE(assembly.registration);
  ASSERT_EQ(assembly.cloud.points.size(), assembly.cloud.sensor.size());
  ASSERT_EQ(assembly.cloud.points.size(), assembly.cloud.normals.size());
  std::vector<std::size_t> next(booth.capture.clouds.size());
  int facing = 0;
  for (std::size_t i = 0; i < assembly.cloud.sensor.size(); ++i) {
    const int sensor = assembly.cloud.sensor[i];
    const Isometry3d& pose = booth.booth_from_sensor[sensor];
    const Vector3d& p = assembly.cloud.points[i];
    ASSERT_LT((p - pose * booth.capture.clouds[sensor]->cloud.points[next[sensor]++]).norm(), 1e-12);
    const Vector3d& n = assembly.cloud.normals[i];
    ASSERT_NEAR(n.norm(), 1, 1e-9);
    ASSERT_GE(n.dot(pose.translation() - p), 0);
    facing += n.dot(pose.translation() - p) > 0;
  }
  EXPECT_GT(facing, 59000);
  for (std::size_t s = 0; s < next.size(); ++s)
    EXPECT_EQ(next[s], booth.capture.clouds[s]->cloud.points.size());
}

TEST(AssemblerTest, PointsThatAreNotFiniteAndSensorsThatAreMissingAreLeftOut) {
  Booth booth = off_by(0);
  assembler::SensorCloud holed = *booth.capture.clouds[0];
  holed.cloud.points[3].y() = std::numeric_limits<double>::quiet_NaN();
  booth.capture.clouds[0] = std::make_shared<const assembler::SensorCloud>(holed);
  booth.capture.clouds[4] = nullptr;
  const Assembly assembly = assemble(booth.capture, booth.booth_from_sensor, by_column());
  EXPECT_EQ(std::count(assembly.cloud.sensor.begin(), assembly.cloud.sensor.end(), 0),
            holed.cloud.points.size() - 1);
  EXPECT_EQ(std::count(assembly.cloud.sensor.begin(), assembly.cloud.sensor.end(), 4), 0);
  for (std::size_t i = 0; i < assembly.cloud.sensor.size(); ++i)
    ASSERT_TRUE(assembly.cloud.points[i].allFinite() && assembly.cloud.normals[i].allFinite());
}

std::string refused(const Booth& booth) {
  try {
    assemble(booth.capture, booth.booth_from_sensor, by_column());
  } catch (const geometry::Refusal& refusal) {
    return refusal.code() + ": " + refusal.what();
  }
  return "";
}

void blind(Booth& booth, int sensor) {  // what a depth camera sends that sees nothing
  assembler::SensorCloud cloud = *booth.capture.clouds[sensor];
  for (Vector3d& p : cloud.cloud.points) p.setConstant(std::numeric_limits<double>::quiet_NaN());
  booth.capture.clouds[sensor] = std::make_shared<const assembler::SensorCloud>(cloud);
}

TEST(AssemblerTest, ASensorThatStandsNowhereNearTheBoothIsRefusedByItsFrame) {
  for (const double far : {1e38, std::numeric_limits<double>::infinity()}) {
    Booth booth = off_by(0);
    assembler::SensorCloud named = *booth.capture.clouds[3];
    named.frame_id = "camera 3";
    booth.capture.clouds[3] = std::make_shared<const assembler::SensorCloud>(named);
    booth.booth_from_sensor[3].translation().x() = far;
    EXPECT_EQ(refused(booth).rfind("no_transform: no point of the cloud in frame 'camera 3'", 0), 0u)
        << refused(booth);
    blind(booth, 3);
    EXPECT_EQ(refused(booth), "");
    booth.capture.clouds[3] = nullptr;
    EXPECT_EQ(refused(booth), "");
  }
}

TEST(AssemblerTest, SensorsThatSawNothingAreLeftOutUnlessNoneSawAnything) {
  Booth booth = off_by(0);
  const int sensors = static_cast<int>(booth.capture.clouds.size());
  for (int sensor = 0; sensor < sensors - 1; ++sensor) blind(booth, sensor);
  EXPECT_EQ(refused(booth), "");
  blind(booth, sensors - 1);
  EXPECT_EQ(refused(booth).rfind("empty_cloud", 0), 0u) << refused(booth);
}

TEST(AssemblerTest, ColumnsThatAreOffAreBroughtTogether) {
  for (const double off : {0.0005, 0.002}) {
    const Booth& booth = off_by(off);
    const Assembly assembly = assemble(booth.capture, booth.booth_from_sensor, by_column());
    ASSERT_TRUE(assembly.registration);
    EXPECT_EQ(assembly.registration->status, RegistrationStatus::refined);
    EXPECT_LT(assembly.registration->residual_after, assembly.registration->residual_before);
    // With 60,000 points of 0.8 mm noise; 0.1 to 0.2 were measured
    EXPECT_LT(disagreement(booth, assembly.registration->corrections), 0.0003) << off;
    EXPECT_GT(before(booth), 0.9 * off);
  }
}

TEST(AssemblerTest, WhatMovedBetweenTwoColumnsDoesNotPull) {
  virtual_booth::ScannerOptions options = options_off_by(0.001);
  // The left arm, 15 mm forward for half of the columns
  options.fracture = {Vector3d(0, 0.45, 1.1), Vector3d(0.3, 0.25, 0.4), Vector3d(0.015, 0, 0), 2};
  const Booth booth = scanned(options);
  const Assembly assembly = assemble(booth.capture, booth.booth_from_sensor, by_column());
  EXPECT_EQ(assembly.registration->status, RegistrationStatus::refined);
  EXPECT_LT(disagreement(booth, assembly.registration->corrections), 0.3 * before(booth));
}

TEST(AssemblerTest, ColumnsThatFitAreLeftAlone) {
  const Booth& booth = off_by(0);
  const Assembly assembly = assemble(booth.capture, booth.booth_from_sensor, by_column());
  EXPECT_LT(disagreement(booth, assembly.registration->corrections), 0.0002);  // half of what can be found
}

TEST(AssemblerTest, CorrectionsHaveNoMotionInCommonAndAreTheSameEveryTime) {
  const Booth& booth = off_by(0.001);
  const Assembly a = assemble(booth.capture, booth.booth_from_sensor, by_column()),
                 b = assemble(booth.capture, booth.booth_from_sensor, by_column());
  EXPECT_EQ(a.cloud.points, b.cloud.points);
  EXPECT_EQ(a.cloud.normals, b.cloud.normals);
  Vector3d centre = Vector3d::Zero(), shift = Vector3d::Zero();
  for (const Vector3d& p : a.cloud.points) centre += p / static_cast<double>(a.cloud.points.size());
  for (const Isometry3d& correction : a.registration->corrections) shift += correction * centre - centre;
  EXPECT_LT(shift.norm(), 1e-4);  // against 1 mm of each; the centre is that of the corrected points
}

/// The clouds of the first sensors as a driver would send them that puts all into the booth's frame.
Booth with_clouds_put_together(Booth booth, std::size_t sensors) {
  for (std::size_t s = 0; s < booth.capture.clouds.size(); ++s) {
    assembler::SensorCloud sent = *booth.capture.clouds[s];
    sent.frame_id = s < sensors ? "booth" : "sensor_" + std::to_string(s);
    if (s < sensors) {
      for (Vector3d& p : sent.cloud.points) p = booth.booth_from_sensor[s] * p;
      booth.booth_from_sensor[s] = Isometry3d::Identity();
    }
    booth.capture.clouds[s] = std::make_shared<const assembler::SensorCloud>(std::move(sent));
  }
  return booth;
}

TEST(AssemblerTest, CloudsInOneFrameHaveNoNormalsAndAreBroughtTogetherAllTheSame) {
  for (const int sensors : {12, 6}) {  // all, or those of two columns
    const Booth booth = with_clouds_put_together(off_by(0.002), sensors);
    const Assembly assembly = assemble(booth.capture, booth.booth_from_sensor, by_column(),
                                       assembler::shared_frames(booth.capture, "booth"));
    for (std::size_t i = 0; i < assembly.cloud.normals.size(); ++i) {
      const int sensor = assembly.cloud.sensor[i];
      ASSERT_NEAR(assembly.cloud.normals[i].norm(), sensor < sensors ? 0 : 1, 1e-9) << sensor;
    }
    EXPECT_EQ(assembly.registration->status, RegistrationStatus::refined) << sensors;
    EXPECT_LT(disagreement(booth, assembly.registration->corrections), 0.0005) << sensors;
  }
}

TEST(ColumnPairsTest, SearchesAreSharedByColumnsThatAreNearEachOther) {
  // 5 mm between neighbours; the last one is empty
  const auto in_a_row = [](int count) {
    std::vector<geometry::PointCloud> columns(count + 1);
    for (int c = 0; c < count; ++c)
      columns[c].points = {Vector3d(0.05 * c, 0, 0), Vector3d(0.05 * c + 0.045, 0.1, 1)};
    return assembler::column_pairs(columns, 0.01);
  };
  const assembler::ColumnPairs many = in_a_row(64), few = in_a_row(12);
  EXPECT_EQ(many.pairs.size(), 2u * 63);  // of 4,032
  for (const auto& [a, b] : many.pairs) EXPECT_EQ(std::abs(a - b), 1);
  EXPECT_EQ(many.searches, 60000u / (2 * 63));
  EXPECT_EQ(few.pairs.size(), 2u * 11);
  EXPECT_EQ(few.searches, 60000u / (12 * 11)) << "few columns are matched as ever";
}

TEST(RegistrationTest, ColumnsThatAreFarOffOrSeeNothingInCommonAreLeftAsTheyAre) {
  const auto identity = [](const assembler::Registration& registration) {
    for (const Isometry3d& correction : registration.corrections)
      if (!correction.matrix().isIdentity(0)) return false;
    return registration.residual_after == registration.residual_before;
  };
  const Booth& booth = off_by(0.002);
  AssemblerOptions strict = by_column();
  strict.registration.max_shift = 0.0005;
  const auto far = assemble(booth.capture, booth.booth_from_sensor, strict).registration;
  EXPECT_EQ(far->status, RegistrationStatus::too_far);
  EXPECT_GE(far->farthest, 0);
  EXPECT_GT(far->farthest_shift, 0.0005);
  EXPECT_LT(far->farthest_shift, 0.006);
  EXPECT_TRUE(identity(*far));

  geometry::PointCloud one{{{0, 0, 0}, {0, 0, 0.001}}, {{1, 0, 0}, {1, 0, 0}}};
  for (const auto& columns : {std::vector<geometry::PointCloud>{}, {one}, {one, one}, {one, {}}}) {
    const assembler::Registration none = assembler::register_columns(columns, {});
    EXPECT_EQ(none.status, RegistrationStatus::no_overlap);
    EXPECT_EQ(none.corrections.size(), columns.size());
    EXPECT_TRUE(identity(none));
  }
}

TEST(AssemblerTest, OptionsOutOfRangeAreRefused) {
  const Booth& booth = off_by(0);
  AssemblerOptions options;
  options.sensors_per_column = 5;
  EXPECT_THROW(assemble(booth.capture, booth.booth_from_sensor, options), geometry::Refusal);
  options.sensors_per_column = 0;
  EXPECT_THROW(assemble(booth.capture, booth.booth_from_sensor, options), geometry::Refusal);
  options = by_column();
  options.registration.max_turn = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(assemble(booth.capture, booth.booth_from_sensor, options), geometry::Refusal);
}

}  // namespace
}  // namespace tensegric_fit
