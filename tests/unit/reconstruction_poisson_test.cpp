// PCL's Poisson reconstruction in a process of its own.
#include <gtest/gtest.h>
#include <malloc.h>
#include <signal.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <thread>

#include "geometry/status.hpp"
#include "reconstruction/poisson.hpp"

namespace tensegric_fit {
namespace {

using geometry::PointCloud;
using geometry::TriangleMesh;
using reconstruction::PoissonWorker;

constexpr int kDepth = 6;

/// Evenly on the unit sphere (Fibonacci's spiral).
PointCloud sphere(int points) {
  PointCloud cloud;
  const double turn = M_PI * (3 - std::sqrt(5.0));
  for (int i = 0; i < points; ++i) {
    const double z = 1 - (2 * i + 1.0) / points, r = std::sqrt(1 - z * z);
    cloud.points.emplace_back(r * std::cos(turn * i), r * std::sin(turn * i), z);
  }
  cloud.normals = cloud.points;
  return cloud;
}

TriangleMesh surface(const PointCloud& cloud, int depth = kDepth) {
  return PoissonWorker().surface(cloud, depth);
}

std::string refusal_of(PoissonWorker& worker, const PointCloud& cloud, std::string* message = nullptr) {
  try {
    worker.surface(cloud, kDepth);
    return "none";
  } catch (const geometry::Refusal& refusal) {
    if (message != nullptr) *message = refusal.what();
    return refusal.code();
  }
}

/// Process numbers of this process's children, also of those that nobody waited for.
std::vector<pid_t> children() {
  std::vector<pid_t> found;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream file(task.path() / "children");
    for (pid_t child = 0; file >> child;) found.push_back(child);
  }
  return found;
}

std::size_t descriptors() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

TEST(Poisson, SurfaceOfASphere) {
  const TriangleMesh mesh = surface(sphere(20000));
  ASSERT_GT(mesh.triangles.size(), 1000u);
  // A cell is 1.1 * 2 / 2^6 wide.
  for (const Eigen::Vector3d& v : mesh.vertices) EXPECT_NEAR(v.norm(), 1, 0.017);
}

TEST(Poisson, SameBitsTwoAtOnce) {
  const PointCloud cloud = sphere(20000);
  const TriangleMesh alone = surface(cloud);
  auto other = std::async(std::launch::async, [&] { return surface(cloud); });
  const TriangleMesh one = surface(cloud), two = other.get();
  EXPECT_EQ(one.vertices, alone.vertices);
  EXPECT_EQ(two.vertices, alone.vertices);
  EXPECT_EQ(two.triangles, alone.triangles);
}

// In this process each surface would leave 4 MB behind.
TEST(Poisson, LeavesNothingBehind) {
  const PointCloud cloud = sphere(5000);
  surface(cloud, 9);
  const std::size_t before = mallinfo2().uordblks, open = descriptors();
  for (int i = 0; i < 5; ++i) surface(cloud, 9);
  EXPECT_LT(mallinfo2().uordblks, before + (1u << 20));
  EXPECT_EQ(descriptors(), open);
  EXPECT_TRUE(children().empty());
}

// As where a supervisor starts it so.
TEST(Poisson, IgnoredEndsOfChildrenAreHeard) {
  signal(SIGCHLD, SIG_IGN);
  EXPECT_GT(surface(sphere(5000)).triangles.size(), 100u);
  EXPECT_EQ(signal(SIGCHLD, SIG_DFL), SIG_DFL);
}

TEST(Poisson, PrintsNothing) {
  testing::internal::CaptureStdout();
  surface(sphere(5000));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(Poisson, ACrashIsARefusal) {
  const PointCloud cloud = sphere(20000);
  for (const int signal : {SIGSEGV, SIGKILL}) {
    PoissonWorker worker;
    const std::vector<pid_t> process = children();
    ASSERT_EQ(process.size(), 1u);
    ASSERT_EQ(kill(process[0], signal), 0);
    std::string message;
    EXPECT_EQ(refusal_of(worker, cloud, &message), "surface_failed");
    EXPECT_NE(message.find("signal " + std::to_string(signal)), std::string::npos) << message;
  }
  EXPECT_GT(surface(cloud).triangles.size(), 1000u);  // the next scan
}

TEST(Poisson, AHangIsARefusal) {
  PoissonWorker worker({0.2, std::size_t{8} << 30});
  const std::vector<pid_t> process = children();
  ASSERT_EQ(process.size(), 1u);
  ASSERT_EQ(kill(process[0], SIGSTOP), 0);
  std::string message;
  EXPECT_EQ(refusal_of(worker, sphere(200000), &message), "surface_failed");  // more than the channel holds
  EXPECT_NE(message.find("0.2 s"), std::string::npos) << message;
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(Poisson, TooMuchMemoryIsARefusal) {
  PoissonWorker worker({60, 1});
  std::string message;
  EXPECT_EQ(refusal_of(worker, sphere(200000), &message), "surface_failed");
  EXPECT_NE(message.find("memory"), std::string::npos) << message;
}
#endif

TEST(Poisson, AWorkerThatIsNotNeededGoes) {
  { const PoissonWorker worker; }
  EXPECT_TRUE(children().empty());
}

}  // namespace
}  // namespace tensegric_fit
