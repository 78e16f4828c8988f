/// Scans that are no whole standing body, or that much is wrong with: refused by name, or measured right.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <ctime>
#include <functional>
#include <random>
#include <set>

#include "body_model/missing_parts.hpp"
#include "geometry/status.hpp"
#include "measured_body.hpp"
#include "virtual_body/model_body.hpp"
#include "virtual_booth/virtual_scanner.hpp"

namespace tensegric_fit {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

constexpr double kLargeGirth = 0.009, kHeight = 0.004;  // ISO 20685

/// A woman who holds her arms out, so that a cut takes them off; she faces x.
const virtual_body::VirtualBody& arms_out() {
  static const virtual_body::VirtualBody body = [] {
    virtual_body::ModelBodyParameters parameters;
    parameters.arms = {1.05, 1.05};
    parameters.elbows = {0, 0};
    return virtual_body::make_body(virtual_body::shipped_model(), parameters);
  }();
  return body;
}

const Points& scan() {
  static const Points points = [] {
    virtual_booth::ScannerOptions options;
    options.points = 80000;
    options.floor = true;
    return virtual_booth::scan_body(arms_out().mesh, options).cloud.points;
  }();
  return points;
}

Points kept(const Points& points, const std::function<bool(const Vector3d&)>& keep) {
  Points result;
  std::copy_if(points.begin(), points.end(), std::back_inserter(result), keep);
  return result;
}

Points moved(Points points, const Eigen::Affine3d& by) {
  for (Vector3d& p : points) p = by * p;
  return points;
}

/// Without its floor.
Points body_alone() {
  return kept(scan(), [](const Vector3d& p) { return p.z() > 0.01; });
}

double girth_of(const geometry::BodyMeasures& measures, const std::string& name) {
  for (const geometry::Measure& girth : measures.girths)
    if (girth.name == name) return girth.metres;
  return std::nan("");
}

struct Outcome {
  std::string refusal;
  geometry::BodyMeasures measures;
  std::set<std::string> missing;  ///< parts of the body
  int persons = 0;                ///< beside her
};

Outcome measure(const Points& points, int poisson_depth = 7) {
  reconstruction::Options options;
  options.body_triangles = 20000;
  options.poisson_depth = poisson_depth;
  try {
    const reconstruction::Reconstruction scanned = test::reconstructed({points, {}}, options);
    Outcome outcome{"", test::measured(scanned), {}, 0};
    for (const body_model::Unexplained& thing : scanned.model.unexplained) outcome.persons += thing.person;
    for (const geometry::Missing& part : body_model::missing_parts(scanned.model))
      outcome.missing.insert(part.name);
    return outcome;
  } catch (const geometry::Refusal& refusal) {
    return {refusal.code(), {}, {}, 0};
  }
}

void expect_measured_right(const Points& points, int persons = 0) {
  const Outcome outcome = measure(points);
  ASSERT_EQ(outcome.refusal, "");
  for (const char* girth : {"bust", "waist", "hip"})
    EXPECT_NEAR(girth_of(outcome.measures, girth), girth_of(arms_out().truth, girth), kLargeGirth) << girth;
  EXPECT_NEAR(outcome.measures.height("crotch"), arms_out().truth.height("crotch"), kHeight);
  EXPECT_EQ(outcome.persons, persons);
}

TEST(ReconstructionBadInput, AWholeBodyIsMeasured) {
  expect_measured_right(scan());
}

TEST(ReconstructionBadInput, OfPartsOfABodyTheRestIsNamed) {
  const Points body = body_alone();
  const auto expect_missing = [&](const char* what, const std::function<bool(const Vector3d&)>& keep,
                                  const std::vector<std::string>& parts) {
    const Outcome outcome = measure(kept(body, keep));
    EXPECT_EQ(outcome.refusal, "") << what;
    for (const std::string& part : parts) EXPECT_EQ(outcome.missing.count(part), 1u) << what << ": " << part;
  };
  // What hangs on a missing part is in its reason.
  expect_missing("left half", [](const Vector3d& p) { return p.y() > 0; }, {"upper_arm_R", "thigh_R"});
  expect_missing("upper half", [](const Vector3d& p) { return p.z() > 0.95; }, {"thigh_L", "thigh_R"});
  expect_missing("legs", [](const Vector3d& p) { return p.z() < 0.75; },
                 {"head", "trunk", "upper_arm_L", "upper_arm_R"});
}

// Cells of 60 mm do not resolve a wrist: the hands are pieces of their own, which are left out.
TEST(ReconstructionBadInput, LimbsThatTheSurfaceLostAreNamedThoughTheyWereScanned) {
  EXPECT_EQ(measure(body_alone(), 5).missing, std::set<std::string>({"hand_L", "hand_R"}));
}

TEST(ReconstructionBadInput, AWholeBodyLacksNothing) {
  EXPECT_TRUE(measure(body_alone()).missing.empty());
}

TEST(ReconstructionBadInput, ABodyThatDoesNotStandIsRefused) {
  const Eigen::Affine3d over(Eigen::AngleAxisd(M_PI, Vector3d::UnitX()));
  const Eigen::Affine3d lying(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY()));
  EXPECT_EQ(measure(moved(body_alone(), over)).refusal, "not_a_body");
  EXPECT_EQ(measure(moved(body_alone(), lying)).refusal, "not_a_body");
}

TEST(ReconstructionBadInput, AMannequinWithoutHeadAndArmsIsMeasured) {
  const double neck = arms_out().truth.height("neck") - 0.02;
  const Outcome outcome = measure(
      kept(body_alone(), [neck](const Vector3d& p) { return p.z() < neck && std::abs(p.y()) < 0.24; }));
  ASSERT_EQ(outcome.refusal, "");
  for (const char* girth : {"bust", "waist", "hip"})
    EXPECT_NEAR(girth_of(outcome.measures, girth), girth_of(arms_out().truth, girth), kLargeGirth) << girth;
}

TEST(ReconstructionBadInput, OfTwoPeopleTheNearerSeenIsMeasuredAndTheOtherNamed) {
  // The other stands apart and is seen by half the points.
  const Points other = moved(scan(), Eigen::Affine3d(Eigen::Translation3d(1.0, 0, 0)));
  Points both = scan();
  for (std::size_t i = 0; i < other.size(); i += 2) both.push_back(other[i]);
  expect_measured_right(both, 1);
}

/// Evenly on the sides of a box.
void add_box(const Vector3d& low, const Vector3d& high, int count, std::mt19937& random, Points& points) {
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < count; ++i) {
    Vector3d p(unit(random), unit(random), unit(random));
    p[i % 3] = (i / 3) % 2;
    points.push_back(low + p.cwiseProduct(high - low));
  }
}

TEST(ReconstructionBadInput, AFishAndFurnitureAreRefused) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(-1, 1);
  Points fish, sofa, chair, wardrobe;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d n = Vector3d(normal(random), normal(random), normal(random)).normalized();
    fish.emplace_back(0.14 * n.x(), 0.10 * n.y(), 0.9 + 0.55 * n.z());
  }
  for (int i = 0; i < 5000; ++i)  // its tail
    fish.emplace_back(0.2 * unit(random), 0.01 * normal(random), 0.23 + 0.15 * unit(random));
  add_box({-0.9, -0.4, 0.1}, {0.9, 0.4, 0.45}, 30000, random, sofa);
  add_box({-0.9, 0.2, 0.45}, {0.9, 0.4, 0.9}, 20000, random, sofa);
  add_box({-0.35, -0.4, 0.1}, {0.35, 0.4, 0.45}, 30000, random, chair);
  add_box({-0.35, 0.2, 0.45}, {0.35, 0.4, 1.1}, 20000, random, chair);
  add_box({-0.3, -0.25, 0}, {0.3, 0.25, 1.8}, 20000, random, wardrobe);
  for (const Points* thing : {&fish, &sofa, &chair, &wardrobe})
    EXPECT_EQ(measure(*thing).refusal, "not_a_body");
  const Eigen::Affine3d lying(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY()));
  EXPECT_EQ(measure(moved(fish, lying)).refusal, "not_a_body");
}

TEST(ReconstructionBadInput, AThirdOfStrayPointsInTheWholeBoothDoNotMatter) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  Points points = scan();
  for (std::size_t i = scan().size() * 3 / 7; i > 0; --i)  // below the floor too
    points.emplace_back(unit(random), unit(random), 0.85 + 1.05 * unit(random));
  expect_measured_right(points);
}

TEST(ReconstructionBadInput, AThirdOfPointsOffTheSkinDoNotMatter) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  Points points = scan();
  for (Vector3d& p : points) {
    const Vector3d ray = Vector3d(p.x(), p.y(), 0).normalized();
    if (unit(random) < 0.3) p += (0.1 * unit(random) - 0.05) * ray;
  }
  expect_measured_right(points);
}

TEST(ReconstructionBadInput, FiveMillionPointsStayWithinTimeAndMemory) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0, 0.0008);
  Points points;
  points.reserve(5000000);
  while (points.size() < 5000000)
    points.push_back(scan()[random() % scan().size()] +
                     Vector3d(noise(random), noise(random), noise(random)));
  const std::clock_t start = std::clock();
  expect_measured_right(points);
  double most_seconds = 20, most_memory = 2;
#if defined(__SANITIZE_ADDRESS__)  // which takes three times as long
  most_seconds = 100;
#elif defined(__SANITIZE_THREAD__)  // 148 s and 3.0 GB where 14 s and 0.7 GB were measured without
  most_seconds = 500, most_memory = 4;
#endif
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, most_seconds);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  EXPECT_LT(usage.ru_maxrss, most_memory * 1024 * 1024);  // KiB
}

TEST(ReconstructionBadInput, CoordinatesThatFloat32CannotResolveAreRefused) {
  Points far = scan();
  for (Vector3d& p : far) p = (p + Vector3d(1e6, -1e6, 50)).cast<float>().cast<double>();  // steps of 62 mm
  EXPECT_EQ(measure(far).refusal, "too_few_points");
}

}  // namespace
}  // namespace tensegric_fit
