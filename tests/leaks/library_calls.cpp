/// What the libraries that we use keep of each call: bytes of the heap (mallinfo2) after N calls and after
/// 2 N, of the same input.
///
///     library_calls [--calls N] [--only NAME] [--work DIR]
///
/// What is quick is called up to kMostCalls times, so that a short run sees a leak of kNothing there, too.
/// Exits with 1 where a call that is not known to leak keeps more than kNothing, with 2 where no call has
/// that name.
#include <fmt/format.h>
#include <malloc.h>
#include <pcl/PolygonMesh.h>
#include <pcl/point_types.h>
#include <pcl/surface/poisson.h>
#include <pcl_conversions/pcl_conversions.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <forward_list>
#include <fstream>
#include <functional>
#include <iostream>

#include "control_mesh/template.hpp"
#include "depth_cameras/camera_message.hpp"
#include "geometry/decimate.hpp"
#include "geometry/ply.hpp"
#include "geometry/shipped_files.hpp"
#include "inspect/composition.hpp"
#include "inspect/picture.hpp"
#include "mesh_files/glb.hpp"
#include "mesh_files/maker_files.hpp"
#include "reconstruction/poisson.hpp"
#include "ros/bag_check.hpp"
#include "scan_files/scan_file.hpp"
#include "virtual_body/polygonise.hpp"

namespace {

using namespace tensegric_fit;
using geometry::TriangleMesh;

constexpr double kNoise = 16384;  // bytes in all: by what the heap differs with the same content
constexpr int kSamples = 2000;    // points of a surface that was read
constexpr double kNothing = 16;   // bytes a call: what is left of the heap's own books
constexpr int kMostCalls = static_cast<int>(kNoise / kNothing);
constexpr double kPatience = 0.1;  // s that these may take
constexpr int kTried = 20;         // calls by which it is known how long one takes
constexpr int kUsage = 2;
constexpr char kPlanted[] = "planted";

/// A ball of 0.3 m, `count` vertices from pole to pole.
TriangleMesh ball(int count) {
  TriangleMesh mesh;
  const int around = 2 * count;
  const auto at = [&](int row, int column) {
    return row == 0 ? 0 : row == count ? 1 : 2 + (row - 1) * around + column % around;
  };
  mesh.vertices = {{0, 0, 0.3}, {0, 0, -0.3}};
  for (int row = 1; row < count; ++row)
    for (int column = 0; column < around; ++column) {
      const double polar = M_PI * row / count, turn = 2 * M_PI * column / around;
      mesh.vertices.push_back(0.3 * Eigen::Vector3d(std::sin(polar) * std::cos(turn),
                                                    std::sin(polar) * std::sin(turn), std::cos(polar)));
    }
  for (int row = 0; row < count; ++row)
    for (int column = 0; column < around; ++column) {
      const int a = at(row, column), b = at(row + 1, column), c = at(row + 1, column + 1),
                d = at(row, column + 1);
      if (row + 1 < count) mesh.triangles.emplace_back(a, b, c);
      if (row > 0) mesh.triangles.emplace_back(a, c, d);
    }
  return mesh;
}

/// For VTK's isosurfaces.
struct Egg : virtual_body::Implicit {
  double value(const Eigen::Vector3d& p) const override { return p.norm() - 0.3; }
  Eigen::AlignedBox3d half_box() const override {
    return {Eigen::Vector3d(-0.4, 0, -0.4), Eigen::Vector3d(0.4, 0.4, 0.4)};
  }
};

geometry::PointCloud points_on(const TriangleMesh& mesh) {
  geometry::PointCloud cloud;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    cloud.points.push_back(v);
    cloud.normals.push_back(v.normalized());
  }
  return cloud;
}

/// PCL's Poisson in this process; the product runs it in one of its own (poisson_worker).
void poisson_here(const geometry::PointCloud& points, int depth) {
  const auto input = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    pcl::PointNormal point;
    point.getVector3fMap() = points.points[i].cast<float>();
    point.getNormalVector3fMap() = points.normals[i].cast<float>();
    input->push_back(point);
  }
  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setDepth(depth);
  poisson.setThreads(1);
  poisson.setInputCloud(input);
  pcl::PointCloud<pcl::PointNormal> vertices;
  std::vector<pcl::Vertices> faces;
  poisson.performReconstruction(vertices, faces);
}

sensor_msgs::Image depth_image(sensor_msgs::CameraInfo& info) {
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(5, 0);
  image.width = info.width = 64;
  image.height = info.height = 48;
  image.encoding = "16UC1";
  image.step = 2 * image.width;
  image.data.assign(image.step * image.height, 3);
  info.distortion_model = "plumb_bob";
  info.D = {0.1, 0.01, 0, 0, 0};
  info.K = {60, 0, 32, 0, 60, 24, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {60, 0, 32, 0, 0, 60, 24, 0, 0, 0, 1, 0};
  return image;
}

std::string written(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
  return path.string();
}

std::string pcd_of(const geometry::PointCloud& cloud) {
  std::string text = fmt::format(
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 "
      "1 0 0 0\nPOINTS {0}\nDATA ascii\n",
      cloud.points.size());
  for (const Eigen::Vector3d& p : cloud.points) text += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
  return text;
}

struct Call {
  std::string name, libraries;
  std::function<void()> work;
  bool known = false;  ///< to leak: tests/leaks/README.md
};

std::vector<Call> calls_in(const std::filesystem::path& folder) {
  const TriangleMesh mesh = ball(24);
  const geometry::PointCloud cloud = points_on(mesh);
  const std::string ply = written(folder / "ball.ply", geometry::ply_bytes(mesh)),
                    pcd = written(folder / "ball.pcd", pcd_of(cloud)),
                    obj = written(folder / "ball.obj", mesh_files::obj_text(mesh, "ball")),
                    stl = written(folder / "ball.stl", mesh_files::stl_bytes(mesh));
  const std::string bag = TENSEGRIC_FIT_SOURCE_DIR "/tests/data/warnings_of_2026-11-24.bag",
                    pattern = geometry::shipped_folder("templates") + "/bust.yaml";
  const inspect::View view = inspect::front_view(Eigen::Isometry3d::Identity(), Eigen::Vector3d::Zero(), 0.8);
  sensor_msgs::CameraInfo info;
  const sensor_msgs::Image image = depth_image(info);
  return {
      {"ply", "PCL (PLYReader)", [=] { scan_files::read_scan_file(ply, kSamples); }},
      {"pcd", "PCL (PCDReader)", [=] { scan_files::read_scan_file(pcd); }},
      {"obj, stl", "ours",
       [=] {
         scan_files::read_scan_file(obj, kSamples);
         scan_files::read_scan_file(stl, kSamples);
       }},
      {"poisson in this process, depth 6", "PCL (Poisson)", [=] { poisson_here(cloud, 6); }, true},
      {"poisson, as we call it", "PCL in a child process",
       [=] { reconstruction::PoissonWorker().surface(cloud, 6); }},
      {"decimation", "OpenMesh", [=] { geometry::with_triangles(mesh, 800); }},
      {"picture", "OpenCV (draw), libpng",
       [=] { inspect::png_bytes(inspect::draw(mesh, {}, {}, view, 200, 200)); }},
      {"depth image", "OpenCV (undistort, remap)", [=] { node::rectified(image, info); }},
      {"bag", "rosbag, ros_msg conversions", [=] { node::check_bag(bag); }},
      {"template", "yaml-cpp", [=] { control_mesh::load_template(pattern); }},
      {"surface of a simulated body", "VTK (FlyingEdges3D)", [] { virtual_body::polygonise(Egg(), 0.02); }},
      {"model for pages", "nlohmann_json",
       [=] {
         mesh_files::glb_bytes({{"ball", mesh}});
       }},
  };
}

/// Keeps 32 bytes, to see that they are found: a node of 24, and what the heap writes beside it.
void keep_some() {
  static std::forward_list<std::array<char, 16>> kept;
  kept.emplace_front();
}

/// As often as is asked for, and of what is quick up to kMostCalls times.
int times_of(const Call& call, int asked) {
  const int tried = std::min(asked, kTried);
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < tried; ++i) call.work();
  const double each = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / tried;
  return std::max(asked, static_cast<int>(std::min<double>(kMostCalls, kPatience / each)));
}

double bytes_in_use() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What libraries keep of each call");
  int calls = 1000;
  std::string only;
  std::filesystem::path work = std::filesystem::temp_directory_path() / "tensegric_fit_leaks";
  app.add_option("--calls", calls, "of each at least, twice")->check(CLI::PositiveNumber);
  app.add_option("--only", only, "calls whose name begins so");
  app.add_option("--work", work, "folder for their inputs");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  }
  std::filesystem::create_directories(work);
  std::vector<Call> all = calls_in(work);
  if (only == kPlanted) all.push_back({kPlanted, "none: 32 bytes a call", keep_some});
  const auto is_other = [&](const Call& call) { return call.name.compare(0, only.size(), only) != 0; };
  all.erase(std::remove_if(all.begin(), all.end(), is_other), all.end());
  if (all.empty()) {
    std::cerr << "library_calls: no call's name begins with '" << only << "'\n";
    return kUsage;
  }
  bool fine = true;
  std::cout << "| call | libraries | calls | bytes kept per call |\n| --- | --- | --- | --- |\n";
  for (const Call& call : all) {
    const int times = times_of(call, calls);
    const auto repeat = [&] {
      for (int i = 0; i < times; ++i) call.work();
      return bytes_in_use();
    };
    const double before = repeat(),
                 kept = (repeat() - before) / times;  // the first round fills what is kept for good
    const bool leaks = !call.known && kept > kNothing && kept * times > kNoise;
    fine = fine && !leaks;
    std::cout << fmt::format("| {} | {} | {} | {:.1f} |{}\n", call.name, call.libraries, times, kept,
                             leaks ? " LEAKS" : "")
              << std::flush;
  }
  return fine ? 0 : 1;
}
