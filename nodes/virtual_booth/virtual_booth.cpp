/// virtual_booth: makes a body and scans it. Writes scan.ply, scan.bag, body.ply and truth.json, on request
/// sensors.bag, cameras.bag, body.obj, body.stl, body.glb; or shape.ply and fixed.yaml of an example shape.
/// Same arguments, same bytes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "files/whole_folder.hpp"
#include "geometry/ply.hpp"
#include "geometry/status.hpp"
#include "mesh_files/glb.hpp"
#include "mesh_files/maker_files.hpp"
#include "scan_files/scan_bag.hpp"
#include "virtual_body/example_shape.hpp"
#include "virtual_body/virtual_body.hpp"
#include "virtual_booth/random_body.hpp"
#include "virtual_booth/sensor_bag.hpp"
#include "virtual_booth/truth_file.hpp"
#include "virtual_booth/virtual_scanner.hpp"

namespace {

using namespace tensegric_fit;

constexpr int kUsage = 2, kRefused = 3;

/// What is written on request.
struct Extras {
  bool each_sensor = false;
  int cameras = 0;
  std::vector<std::string> formats;  // of the body: obj, stl, glb
};

/// What a booth of so many depth cameras on four columns sees of her.
void write_cameras(const virtual_body::VirtualBody& subject, virtual_booth::ScannerOptions scanner,
                   int cameras, const std::filesystem::path& out, std::chrono::nanoseconds stamp) {
  scanner.sensors_per_column = cameras / scanner.columns;
  const std::vector<virtual_booth::DepthPicture> pictures =
      virtual_booth::depth_pictures(subject.mesh, scanner, virtual_booth::kWideLens);
  virtual_booth::write_camera_bag(out / "cameras.bag", pictures, "booth", stamp);
  virtual_booth::write_camera_poses(out / "cameras.yaml", pictures);
}

/// As booths deliver meshes: OBJ and STL in millimetres, y up, GLB in metres, y up.
void write_meshes(const geometry::TriangleMesh& body, const std::vector<std::string>& formats,
                  const std::filesystem::path& out) {
  for (const std::string& format : formats)
    files::write_whole_file(out / ("body." + format), format == "obj" ? mesh_files::obj_text(body, "body")
                                                      : format == "stl"
                                                          ? mesh_files::stl_bytes(body)
                                                          : mesh_files::glb_bytes({{"body", body}}));
}

void write_scan(const virtual_body::VirtualBody& subject, const virtual_booth::ScannerOptions& scanner,
                const Extras& extras, const std::filesystem::path& out) {
  const virtual_booth::VirtualScan scan = virtual_booth::scan_body(subject.mesh, scanner);
  std::filesystem::create_directories(out);
  if (std::filesystem::exists(
          out / "truth.json"))  // an earlier scan's folder: what is not written again is of another
    for (const char* file :
         {"sensors.bag", "cameras.bag", "cameras.yaml", "body.obj", "body.stl", "body.glb"})
      std::filesystem::remove(out / file);
  geometry::write_ply_mesh(out / "body.ply", subject.mesh);
  geometry::write_ply_mesh(out / "scan.ply", {scan.cloud.points, {}});
  // Any fixed time will do, as long as no two seeds share one.
  const std::chrono::seconds stamp(1000000000 + scanner.seed % 1000000000);
  scan_files::write_bag_scan(out / "scan.bag", scan.cloud, "booth", stamp);
  if (extras.each_sensor)
    virtual_booth::write_sensor_bag(out / "sensors.bag", virtual_booth::by_sensor(scan), "booth", stamp);
  if (extras.cameras > 0) write_cameras(subject, scanner, extras.cameras, out, stamp);
  write_meshes(subject.mesh, extras.formats, out);
  virtual_booth::write_truth(out / "truth.json", subject, scanner);
  std::cout << fmt::format("{}: {} points of a body of {} triangles\n", out.string(),
                           scan.cloud.points.size(), subject.mesh.triangles.size());
}

// For `fit --mesh shape.ply --fixed fixed.yaml`.
void write_shape(const std::string& name, const std::filesystem::path& out) {
  const virtual_body::ExampleShape shape = virtual_body::make_example_shape(name);
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

struct Request {
  std::string family = "model", out = "virtual_booth", shape;
  std::uint64_t customer = 0;
  bool is_customer = false;
  Extras extras;
  virtual_body::BodyParameters body;  // of the implicit family; what was asked for of the model's, too
  virtual_booth::ScannerOptions scanner;
  std::vector<std::string> asked;  // options of the body that were given
};

/// A woman of the model drawn at random, with what was asked for in place of what was drawn.
virtual_body::VirtualBody model_body(const Request& request) {
  virtual_body::ModelBodyParameters body =
      virtual_booth::random_model_body(request.scanner.seed, virtual_body::shipped_model());
  for (const std::string& option : request.asked) {
    if (option == "--stature") body.stature = request.body.stature;
    if (option == "--arm-angle") body.arms = {request.body.arm_angle, request.body.arm_angle};
  }
  body.yaw = request.body.yaw;
  body.tilt = request.body.tilt;
  return virtual_body::make_body(virtual_body::shipped_model(), body);
}

void run(const Request& request) {
  if (!request.shape.empty()) return write_shape(request.shape, request.out);
  const virtual_booth::Family family = virtual_booth::family_named(request.family);
  const virtual_body::VirtualBody subject =
      request.is_customer                      ? virtual_booth::random_customer(family, request.customer)
      : family == virtual_booth::Family::model ? model_body(request)
                                               : virtual_body::make_body(request.body);
  write_scan(subject,
             request.is_customer ? virtual_booth::random_scanner(request.customer, subject) : request.scanner,
             request.extras, request.out);
}

/// All options of the program. \throw CLI::ParseError
void parse(int argc, char** argv, CLI::App& app, Request& request) {
  virtual_body::BodyParameters& body = request.body;
  virtual_booth::ScannerOptions& scanner = request.scanner;
  app.option_defaults()->always_capture_default();
  const CLI::Option* out = app.add_option("--out", request.out, "directory for the files");
  const CLI::Option* family =
      app.add_option("--family", request.family,
                     "where the body comes from: the product's own body model, or implicit shapes")
          ->check(CLI::IsMember(virtual_booth::families()));
  CLI::Option* shape =
      app.add_option(
             "--shape", request.shape,
             "write this shape and which part of it to hold, in place of a scan; only --out goes with it")
          ->check(CLI::IsMember(virtual_body::example_shapes()));
  const CLI::Option* sensors = app.add_flag("--sensors", request.extras.each_sensor,
                                            "write sensors.bag, too: each sensor's cloud and tf");
  app.add_option("--depth-cameras", request.extras.cameras,
                 "write cameras.bag, too: depth images and CameraInfo of so many cameras with lenses, and "
                 "cameras.yaml, where they stand")
      ->check(CLI::IsMember({0, 4, 8, 12, 16}));
  const CLI::Option* formats =
      app.add_option(
             "--export", request.extras.formats,
             "write the body as a booth's mesh, too: obj, stl (millimetres, y up), glb (metres, y up)")
          ->delimiter(',')
          ->check(CLI::IsMember({"obj", "stl", "glb"}));
  CLI::Option* customer = app.add_option(
      "--customer", request.customer,
      "body and booth number N, drawn at random; only --family, --out, --export and --sensors go with it");
  // Of either family, and of the implicit one alone.
  const std::vector<CLI::Option*> common = {
      app.add_option("--stature", body.stature,
                     "height of the body; of the model family drawn at random where not given"),
      app.add_option("--arm-angle", body.arm_angle, "between the upper arms and the vertical; likewise"),
      app.add_option("--yaw", body.yaw, "her facing in the scan's frame, from x towards y"),
      app.add_option("--tilt", body.tilt, "her lean forward")};
  const std::vector<CLI::Option*> implicit = {
      app.add_option("--bust", body.bust, "size of the breasts, as a length relative to the default"),
      app.add_option("--firmness", body.firmness,
                     "of the breasts, -0.8 to 1; below 0 they hang over their folds"),
      app.add_option("--asymmetry", body.asymmetry, "by how much the left breast is larger than the right"),
      app.add_option("--waist", body.waist, "thickness at the waist relative to the default"),
      app.add_option("--build", body.build, "thickness of trunk and limbs relative to the default"),
      app.add_option("--belly", body.belly, "how round the belly is, 0 to 1"),
      app.add_option("--stoop", body.stoop, "how far the spine bends forward"),
      app.add_option("--hip", body.hip, "thickness at the hips relative to the default")};
  app.add_option("--seed", scanner.seed,
                 "of noise, outliers, misregistration and point order; of the model family's body, too");
  app.add_option("--points", scanner.points, "of the scan");
  app.add_option("--noise", scanner.noise, "standard deviation along the ray");
  app.add_option("--outliers", scanner.outliers, "share of points that lie off the surface");
  app.add_option("--misregistration", scanner.misregistration, "standard deviation of each column's shift");
  app.add_flag("--floor", scanner.floor, "let the sensors see the floor");
  app.add_flag("--frame", scanner.frame, "let the sensors see the booth's frame");
  for (CLI::Option* option : app.get_options())
    if (option != customer && option != sensors && option != out && option != family && option != formats &&
        option->get_name() != "--help")
      customer->excludes(option);
  for (CLI::Option* option : app.get_options())
    if (option != shape && option != out && option->get_name() != "--help") shape->excludes(option);
  app.parse(argc, argv);
  request.is_customer = customer->count() > 0;
  for (const CLI::Option* option : implicit)
    if (option->count() > 0 && request.family != "implicit")
      throw CLI::ValidationError(option->get_name(), "goes with --family implicit");
  for (const CLI::Option* option : common)
    if (option->count() > 0) request.asked.push_back(option->get_name());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    CLI::App app("Scans a virtual body with virtual depth sensors. Metres, radians.");
    Request request;
    try {
      parse(argc, argv, app, request);
    } catch (const CLI::ParseError& error) {
      return app.exit(error) == 0 ? 0 : kUsage;
    }
    run(request);
    return 0;
  } catch (const geometry::Refusal& refusal) {
    std::cerr << "virtual_booth: " << refusal.code() << ": " << refusal.what() << '\n';
    return kRefused;
  } catch (const std::exception& error) {
    std::cerr << "virtual_booth: " << error.what() << '\n';
    return 1;
  }
}
