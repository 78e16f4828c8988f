/// When the answers to a change of garment come over topics, and how near each is to the reference: by body,
/// the coarse one and the last. live_answers CASES.yaml (of reference_cases.py), with pipeline.launch
/// running.
#include <fmt/format.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "calibration/reference_field.hpp"
#include "geometry/ply.hpp"
#include "geometry/shipped_files.hpp"
#include "ros/body_messages.hpp"
#include "ros/flat.hpp"
#include "tensegric/fit_messages.hpp"

namespace {

using namespace tensegric_fit;
using Clock = std::chrono::steady_clock;

constexpr double kPatience = 60;  // seconds

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Arrival {
  double milliseconds;
  DeformedMesh::ConstPtr skin;
};

class Booth {
 public:
  Booth() : bodies_(node_.advertise<TriangleMesh>("body/mesh", 1, true)) {
    const auto prompt = ros::TransportHints().tcpNoDelay();
    control_in_ = node_.subscribe("control/mesh", 1, &Booth::on_control, this, prompt);
    skins_in_ = node_.subscribe("body/deformed", 8, &Booth::on_skin, this, prompt);
  }

  /// Shows the body to the chain. False: it came to no control mesh and no fit.
  bool enter(const std::string& name, const geometry::TriangleMesh& body) {
    node::ScanTag tag;
    tag.header.stamp = ros::Time::now();
    tag.header.frame_id = "booth";
    tag.scan_id = scan_id_ = name;
    arrivals_.clear();
    bodies_.publish(node::to_message(tag, body, {}));
    return wait([this] { return control_id_ == scan_id_ && ended(); });
  }

  /// What came up to the end; nothing where the end stayed out.
  std::vector<Arrival> wear(const tensegric::Garment& garment) {
    SetGarment call;
    call.request.garment = node::to_message({}, {garment, ""});
    arrivals_.clear();
    start_ = Clock::now();
    if (!ros::service::call("set_garment", call) || !call.response.accepted) {
      fmt::print(stderr, "{}: {}\n", garment.name, call.response.message);
      return {};
    }
    return wait([this] { return ended(); }) ? arrivals_ : std::vector<Arrival>();
  }

 private:
  void on_control(const ControlMesh::ConstPtr& control) { control_id_ = control->scan_id; }
  void on_skin(const DeformedMesh::ConstPtr& skin) {
    if (skin->scan_id == scan_id_) arrivals_.push_back({milliseconds_since(start_), skin});
  }
  bool ended() const { return !arrivals_.empty() && arrivals_.back().skin->status != FitState::SOLVING; }

  template <typename Condition>
  static bool wait(const Condition& condition) {
    const auto start = Clock::now();
    while (ros::ok() && milliseconds_since(start) < 1000 * kPatience) {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
      if (condition()) return true;
    }
    return false;
  }

  ros::NodeHandle node_;
  ros::Publisher bodies_;
  ros::Subscriber control_in_, skins_in_;
  std::string scan_id_, control_id_;
  std::vector<Arrival> arrivals_;
  Clock::time_point start_;
};

void print(const std::string& what, const std::vector<Arrival>& came,
           const calibration::ReferenceField& reference, const geometry::TriangleMesh& body) {
  const double still = calibration::tissue_error(reference, body, body.vertices);
  fmt::print("{:24s} {:6.2f}", what, 1e3 * still);
  const std::size_t shown = came.size() < 2 ? 1 : 2;
  if (came.size() < 2) fmt::print("  {:>7s} {:>5s}", "-", "-");
  for (std::size_t i = 0; i < shown; ++i) {
    const Arrival& one = i + 1 == shown ? came.back() : came.front();
    const double error = calibration::tissue_error(reference, body, node::points_in(one.skin->vertices));
    fmt::print("  {:7.1f} {:5.2f}", one.milliseconds, 1e3 * error);
  }
  fmt::print("  {} {}\n", came.back().skin->status, came.size());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "live_answers", ros::init_options::AnonymousName);
  if (argc != 2) {
    fmt::print(stderr, "live_answers CASES.yaml\n");
    return 2;
  }
  Booth booth;
  fmt::print("{:24s} {:>6s}  {:>7s} {:>5s}  {:>7s} {:>5s}  end, skins that came\n", "rms mm, ms", "still",
             "first", "rms", "last", "rms");
  const std::filesystem::path folder = std::filesystem::path(argv[1]).parent_path();
  const tensegric::Garment usual = tensegric::take_garment("B2", geometry::shipped_folder("garments"));
  int visit = 0;
  for (const YAML::Node& entry : YAML::LoadFile(argv[1])["bodies"]) {
    const auto name = entry["name"].as<std::string>();
    const geometry::TriangleMesh body = geometry::read_ply_mesh(entry["mesh"].as<std::string>());
    if (!booth.enter(fmt::format("{}-{}", name, ++visit), body)) {
      fmt::print(stderr, "{}: no fit came\n", name);
      return 1;
    }
    std::string worn;  // by points that lie on this body alone
    for (const YAML::Node& one : entry["references"]) {
      const auto file = one["garment"].as<std::string>();
      tensegric::Garment garment = tensegric::take_garment(file, geometry::shipped_folder("garments"));
      tensegric::set_ratio(garment, "", one["ratio"].as<double>());
      const std::vector<Arrival> came = booth.wear(garment);
      if (came.empty()) return 1;
      const std::string change = file == worn ? "slider" : "garment";  // its lines lie there already
      worn = file;
      print(fmt::format("{} {} {:.2f} {}", name, garment.name, one["ratio"].as<double>(), change), came,
            calibration::read_reference(folder / one["file"].as<std::string>(), body), body);
    }
    if (booth.wear(usual).empty()) return 1;
  }
  return 0;
}
