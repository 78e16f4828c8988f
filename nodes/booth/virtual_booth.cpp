/// virtual_booth: makes a body and scans it. Writes scan.ply, scan.bag, body.ply and truth.json, on request
/// sensors.bag; or shape.ply and fixed.yaml of an example shape. Same arguments, same bytes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "booth/example_shape.hpp"
#include "booth/random_body.hpp"
#include "booth/scan_bag.hpp"
#include "booth/sensor_bag.hpp"
#include "booth/truth_file.hpp"
#include "booth/virtual_body.hpp"
#include "booth/virtual_scanner.hpp"
#include "geometry/ply.hpp"
#include "geometry/status.hpp"

namespace {

using namespace tensegric_fit;

constexpr int kUsage = 2, kRefused = 3;

void run(const booth::VirtualBody& subject, const booth::BodyParameters& body,
         const booth::ScannerOptions& scanner, bool each_sensor, const std::filesystem::path& out) {
  const booth::VirtualScan scan = booth::scan_body(subject.mesh, scanner);
  std::filesystem::create_directories(out);
  geometry::write_ply_mesh(out / "body.ply", subject.mesh);
  geometry::write_ply_mesh(out / "scan.ply", {scan.cloud.points, {}});
  // Any fixed time will do, as long as no two seeds share one.
  const ros::Time stamp(static_cast<std::uint32_t>(1000000000 + scanner.seed % 1000000000), 0);
  booth::write_bag_scan(out / "scan.bag", scan.cloud, "booth", stamp);
  if (each_sensor) booth::write_sensor_bag(out / "sensors.bag", booth::by_sensor(scan), "booth", stamp);
  booth::write_truth(out / "truth.json", subject, body, scanner);
  std::cout << fmt::format("{}: {} points of a body of {} triangles\n", out.string(),
                           scan.cloud.points.size(), subject.mesh.triangles.size());
}

// For `fit --mesh shape.ply --fixed fixed.yaml`.
void write_shape(const std::string& name, const std::filesystem::path& out) {
  const booth::ExampleShape shape = booth::make_example_shape(name);
  std::filesystem::create_directories(out);
  geometry::write_ply_mesh(out / "shape.ply", shape.mesh);
  const Eigen::Vector3d low = shape.held.min(), high = shape.held.max();
  std::ofstream file(out / "fixed.yaml");
  file << fmt::format("boxes:\n  - {{min: [{}, {}, {}], max: [{}, {}, {}]}}\n", low.x(), low.y(), low.z(),
                      high.x(), high.y(), high.z());
  file.flush();
  if (!file) throw std::runtime_error((out / "fixed.yaml").string() + ": cannot be written");
  std::cout << fmt::format("{}: {} of {} triangles\n", out.string(), name, shape.mesh.triangles.size());
}

}  // namespace

int main(int argc, char** argv) {
  booth::BodyParameters body;
  booth::ScannerOptions scanner;
  std::string out = "virtual_booth", shape;
  std::uint64_t customer = 0;
  bool each_sensor = false;
  CLI::App app("Scans a parametric body with virtual depth sensors. Metres, radians.");
  app.option_defaults()->always_capture_default();
  app.add_option("--out", out, "directory for the files");
  app.add_option("--shape", shape, "write this shape and which part of it to hold, in place of a scan")
      ->check(CLI::IsMember(booth::example_shapes()));
  CLI::Option* by_sensor =
      app.add_flag("--sensors", each_sensor, "write sensors.bag, too: each sensor's cloud and tf");
  CLI::Option* by_lot = app.add_option(
      "--customer", customer, "draw body and booth by lot; all options but --out and --sensors are drawn");
  app.add_option("--stature", body.stature, "height of the body");
  app.add_option("--bust", body.bust, "size of the breasts, as a length relative to the default");
  app.add_option("--firmness", body.firmness,
                 "of the breasts, -0.8 to 1; below 0 they hang over their folds");
  app.add_option("--asymmetry", body.asymmetry, "by how much the left breast is larger than the right");
  app.add_option("--waist", body.waist, "thickness at the waist relative to the default");
  app.add_option("--build", body.build, "thickness of trunk and limbs relative to the default");
  app.add_option("--belly", body.belly, "how round the belly is, 0 to 1");
  app.add_option("--stoop", body.stoop, "how far the spine bends forward");
  app.add_option("--hip", body.hip, "thickness at the hips relative to the default");
  app.add_option("--arm-angle", body.arm_angle, "between the upper arms and the vertical");
  app.add_option("--yaw", body.yaw, "her facing in the scan's frame, from x towards y");
  app.add_option("--tilt", body.tilt, "her lean forward");
  app.add_option("--seed", scanner.seed, "of noise, outliers, misregistration and point order");
  app.add_option("--points", scanner.points, "of the scan");
  app.add_option("--noise", scanner.noise, "standard deviation along the ray");
  app.add_option("--outliers", scanner.outliers, "share of points that lie off the surface");
  app.add_option("--misregistration", scanner.misregistration, "standard deviation of each column's shift");
  app.add_flag("--floor", scanner.floor, "let the sensors see the floor");
  app.add_flag("--frame", scanner.frame, "let the sensors see the booth's frame");
  for (CLI::Option* option : app.get_options())
    if (option != by_lot && option != by_sensor && option->get_name() != "--help" &&
        option->get_name() != "--out")
      by_lot->excludes(option);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  }
  try {
    if (!shape.empty()) {
      write_shape(shape, out);
    } else if (by_lot->count() > 0) {
      body = booth::random_body(customer);
      const booth::VirtualBody subject = booth::make_body(body);
      run(subject, body, booth::random_scanner(customer, subject), each_sensor, out);
    } else {
      run(booth::make_body(body), body, scanner, each_sensor, out);
    }
  } catch (const geometry::Refusal& refusal) {
    std::cerr << "virtual_booth: " << refusal.code() << ": " << refusal.what() << '\n';
    return kRefused;
  } catch (const std::exception& error) {
    std::cerr << "virtual_booth: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
