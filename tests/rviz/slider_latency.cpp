/// How long a running chain takes from a slider's move to body/deformed: a slider goes to and fro, over real
/// topics. roslaunch tensegric_fit demo.launch bag:=scan.bag rviz:=false; then slider_latency [--changes
/// 1000] [--service]
#include <fmt/format.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <tensegric_fit/ControlMesh.h>
#include <tensegric_fit/DeformedMesh.h>
#include <tensegric_fit/FitState.h>
#include <tensegric_fit/Garment.h>
#include <tensegric_fit/SetGarment.h>
#include <tensegric_fit/TriangleMesh.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;
using namespace tensegric_fit;

constexpr double kPatience = 10;  // seconds

struct Settings {
  int changes = 1000;
  double period = 0.05;  // seconds between two moves of the slider
  double low = 0.90, high = 1.00, step = 0.005;
  bool service = false;
};

class Slider {
 public:
  explicit Slider(const Settings& settings) : settings_(settings) {
    const auto prompt = ros::TransportHints().tcpNoDelay();
    subscribers_ = {node_.subscribe("body/mesh", 1, &Slider::on_body, this, prompt),
                    node_.subscribe("control/mesh", 1, &Slider::on_control, this, prompt),
                    node_.subscribe("garment", 1, &Slider::on_garment, this, prompt),
                    node_.subscribe("body/deformed", 4, &Slider::on_deformed, this, prompt)};
  }

  /// False: there is no chain with a fitted body.
  bool ready() {
    if (!wait([this] { return body_ && control_ && garment_ && !arrived_.empty(); })) return false;
    request_ = *garment_;
    subscribers_[2].shutdown();
    if (settings_.service)
      client_ = node_.serviceClient<SetGarment>("set_garment", true);
    else
      publisher_ = node_.advertise<Garment>("garment", 4, true);  // latched: the panel may be connected first
    return settings_.service ? client_.waitForExistence(ros::Duration(kPatience))
                             : wait([this] { return publisher_.getNumSubscribers() > 0; });
  }

  /// Milliseconds from the move to the deformed body, one a change; fewer where an answer stayed out.
  std::vector<double> move() {
    std::vector<double> latencies;
    double ratio = settings_.high, way = -settings_.step;
    for (int i = 0; i < settings_.changes && ros::ok(); ++i) {
      if (ratio + way < settings_.low - 1e-9 || ratio + way > settings_.high + 1e-9) way = -way;
      ratio += way;
      request_.name = "move " + std::to_string(i);  // comes back with the body
      for (GarmentLine& line : request_.lines) line.ratio = ratio;
      const auto start = Clock::now();
      ask();
      if (!wait([this] { return arrived_ == request_.name; })) return latencies;
      latencies.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
      listen_until(start + std::chrono::duration_cast<Clock::duration>(
                               std::chrono::duration<double>(settings_.period)));
    }
    return latencies;
  }

  /// What was worn before, for those who join later.
  void restore() {
    SetGarment call;
    call.request.garment = *garment_;
    ros::service::call("set_garment", call);
  }

  std::string scene() const {
    return fmt::format("{} body triangles, {} control triangles", body_->triangles.size() / 3,
                       control_->triangles.size() / 3);
  }

 private:
  void on_body(const TriangleMesh::ConstPtr& body) { body_ = body; }
  void on_control(const ControlMesh::ConstPtr& control) { control_ = control; }
  void on_garment(const Garment::ConstPtr& garment) { garment_ = garment; }
  void on_deformed(const DeformedMesh::ConstPtr& deformed) {
    if (deformed->status != FitState::SOLVING) arrived_ = deformed->garment;
  }

  void ask() {
    if (!settings_.service) return publisher_.publish(request_);
    SetGarment call;
    call.request.garment = request_;
    client_.call(call);
  }

  static void listen_until(Clock::time_point end) {
    while (ros::ok() && Clock::now() < end)
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.001));
  }

  template <typename Condition>
  static bool wait(const Condition& condition) {
    const auto start = Clock::now();
    while (ros::ok() && !condition()) {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
      if (std::chrono::duration<double>(Clock::now() - start).count() > kPatience) return false;
    }
    return ros::ok();
  }

  const Settings settings_;
  ros::NodeHandle node_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher publisher_;
  ros::ServiceClient client_;
  TriangleMesh::ConstPtr body_;
  ControlMesh::ConstPtr control_;
  Garment::ConstPtr garment_;
  Garment request_;
  std::string arrived_;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "slider_latency", ros::init_options::AnonymousName);
  Settings settings;
  CLI::App app("Slider to deformed body, over topics");
  app.add_option("--changes", settings.changes)->check(CLI::PositiveNumber);
  app.add_option("--period", settings.period, "seconds between two moves")->check(CLI::NonNegativeNumber);
  app.add_option("--low", settings.low, "ratio at one end");
  app.add_option("--high", settings.high, "ratio at the other end, where it starts");
  app.add_option("--step", settings.step, "ratio of one move")->check(CLI::PositiveNumber);
  app.add_flag("--service", settings.service, "by set_garment, in place of the topic garment");
  CLI11_PARSE(app, argc, argv);

  Slider slider(settings);
  if (!slider.ready()) {
    fmt::print(stderr, "no running chain with a fitted body\n");
    return 1;
  }
  std::vector<double> latencies = slider.move();
  slider.restore();
  if (latencies.size() != static_cast<std::size_t>(settings.changes)) {
    fmt::print(stderr, "change {} was not answered\n", latencies.size());
    return 1;
  }
  std::sort(latencies.begin(), latencies.end());
  const auto at = [&latencies](double share) {
    return latencies[static_cast<std::size_t>(std::ceil(share * static_cast<double>(latencies.size()))) - 1];
  };
  fmt::print("{} changes, {}: median {:.1f} ms, 99 % {:.1f} ms, worst {:.1f} ms\n", latencies.size(),
             slider.scene(), at(0.5), at(0.99), at(1));
  return 0;
}
