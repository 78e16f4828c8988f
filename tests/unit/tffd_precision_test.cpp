#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "geometry/status.hpp"
#include "point_lists.hpp"
#include "tffd/binding.hpp"
#include "tffd_shapes.hpp"

namespace tensegric_fit::tffd {
namespace {

using Points = std::vector<Eigen::Vector3d>;

double farthest_node(const geometry::ControlMesh& control, const Moved& moved) {
  return std::max(farthest(control.outer, moved.outer), farthest(control.inner, moved.inner));
}

// An affine map of a closed control mesh, and of the body: both settings of precision must carry it.
Points doubled_and_sheared(const Points& points) {
  Eigen::Matrix3d a;
  a << 2, 0.3, 0, 0, 2, -0.2, 0.1, 0, 2;
  Points image;
  for (const Eigen::Vector3d& p : points) image.push_back(a * p);
  return image;
}

TEST(FastPrecision, StaysWithinAHundredthOfAMillimetre) {
  const geometry::TriangleMesh body = slab(121);
  const geometry::ControlMesh control = patch();
  const Moved moved = squeezed(control, 0.03);
  Options fast;
  fast.precision = Precision::fast;
  const Points exact = Binding(body, control, {}).deform(moved.outer, moved.inner);
  const Points quick = Binding(body, control, fast).deform(moved.outer, moved.inner);
  ASSERT_GT(farthest(body.vertices, exact), 0.01);
  // Single precision has 24 bits; of 0.03 m that leaves 2e-9 m, and some thirty terms are summed.
  EXPECT_LT(farthest(exact, quick), 1e-7);
}

TEST(FastPrecision, LeavesABodyAtRestBitForBit) {
  const geometry::TriangleMesh body = slab(61);
  const geometry::ControlMesh control = patch();
  Options fast;
  fast.precision = Precision::fast;
  const Points after = Binding(body, control, fast).deform(control.outer, control.inner);
  for (std::size_t v = 0; v < after.size(); ++v) EXPECT_TRUE(after[v] == body.vertices[v]);
}

TEST(FastPrecision, DoesNotLoseWhatIsFarFromTheOrigin) {
  geometry::TriangleMesh body = slab(61);
  geometry::ControlMesh control = patch();
  const Eigen::Vector3d far(1e4, -1e4, 1e4);
  for (Points* points : {&body.vertices, &control.outer, &control.inner})
    for (Eigen::Vector3d& p : *points) p += far;
  Moved moved{control.outer, control.inner};
  const Moved near = squeezed(patch(), 0.03);
  for (std::size_t i = 0; i < moved.outer.size(); ++i)
    moved.outer[i] = near.outer[i] + far, moved.inner[i] = near.inner[i] + far;
  Options fast;
  fast.precision = Precision::fast;
  const Points exact = Binding(body, control, {}).deform(moved.outer, moved.inner);
  EXPECT_LT(farthest(exact, Binding(body, control, fast).deform(moved.outer, moved.inner)), 1e-7);
}

TEST(Truncation, StaysAffineExact) {
  const geometry::ControlMesh control = ball();
  Options options;
  options.truncation = 0.05;
  for (const double radius : {0.05, 0.1, 0.14}) {
    const geometry::TriangleMesh body = sphere(radius, 20);
    const Points after = Binding(body, control, options)
                             .deform(doubled_and_sheared(control.outer), doubled_and_sheared(control.inner));
    EXPECT_LT(farthest(after, doubled_and_sheared(body.vertices)), 1e-12) << radius;
  }
}

TEST(Truncation, SavesEntriesAndKeepsItsWordOnTheError) {
  const geometry::TriangleMesh body = slab(61);
  const geometry::ControlMesh control = patch();
  const Binding full(body, control, {});
  EXPECT_EQ(full.truncation_error(), 0);
  double entries = static_cast<double>(full.weights().nodes.nonZeros()), error = 0;
  for (const double truncation : {1e-4, 1e-3, 1e-2, 1e-1}) {
    Options options;
    options.truncation = truncation;
    const Binding cut(body, control, options);
    EXPECT_LT(static_cast<double>(cut.weights().nodes.nonZeros()), entries);
    EXPECT_GT(cut.truncation_error(), error);
    entries = static_cast<double>(cut.weights().nodes.nonZeros());
    error = cut.truncation_error();

    std::mt19937 random(7);
    std::normal_distribution<double> shift(0, 0.01);
    for (int trial = 0; trial < 5; ++trial) {
      Moved moved{control.outer, control.inner};
      for (Points* nodes : {&moved.outer, &moved.inner})
        for (Eigen::Vector3d& p : *nodes) p += Eigen::Vector3d(shift(random), shift(random), shift(random));
      const double off =
          farthest(full.deform(moved.outer, moved.inner), cut.deform(moved.outer, moved.inner));
      EXPECT_LE(off, error * farthest_node(control, moved)) << "seed 7, trial " << trial;
    }
  }
}

TEST(Precision, RefusesByName) {
  const geometry::TriangleMesh body = slab(21);
  const geometry::ControlMesh control = patch();
  const auto refuses = [&](const Options& options) {
    try {
      Binding(body, control, options);
    } catch (const geometry::Refusal& refusal) {
      return refusal.code() == geometry::refusal::kBadOption;
    }
    return false;
  };
  Options options;
  for (const double truncation : {-1e-9, 0.11, std::nan("")}) {
    options.truncation = truncation;
    EXPECT_TRUE(refuses(options)) << truncation;
  }
  options = {};
  options.setting = Setting::paper;
  options.truncation = 0.01;
  EXPECT_TRUE(refuses(options));
  options.truncation = 0;
  options.precision = Precision::fast;
  EXPECT_TRUE(refuses(options));
}

}  // namespace
}  // namespace tensegric_fit::tffd
