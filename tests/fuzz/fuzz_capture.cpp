// The action `capture`: goals, and whatever its booth and its chain send in any order.
#include <boost/make_shared.hpp>

#include <array>
#include <cmath>

#include "capture/capture_handler.hpp"
#include "fuzz_target.hpp"
#include "input.hpp"
#include "ros/scan_tag.hpp"

namespace {

using namespace tensegric_fit;
using namespace tensegric_fit::node;

constexpr std::array kStages{"reconstruction", "landmarks", "control_mesh", "tensegric",
                             "tffd",           "assembler", "scan_player"};
constexpr std::array kStates{"waiting", "working", "done", "superseded", "refused", "failed", ""};
constexpr std::array kSensors{"left/points", "right/points", ""};

/// Stamps that lie near each other, and any.
ros::Time stamp(fuzz::Input& input) {
  const std::uint32_t drawn = input.number(1);
  return drawn % 8 == 0 ? ros::Time(input.any(), 0) : ros::Time(100 + drawn % 4, drawn / 8 * 30'000'000);
}

sensor_msgs::PointCloud2 scan(fuzz::Input& input) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.stamp = stamp(input);
  cloud.data.assign(input.number(1) % 3, 7);
  return cloud;
}

/// A booth with its chain, as the action sees it.
class Booth {
 public:
  explicit Booth(fuzz::Input& input)
      : input_(input),
        handler_(Parameters(YAML::Load(input.number(1) % 2 == 0 ? "{timeout: 5, slop: 0.1}"
                                                                : "{trigger: scan, timeout: 20}"),
                            "capture"),
                 input.number(1) % 4 == 0 ? "/left" : "/") {}

  void step() {
    constexpr std::array kSteps{&Booth::begin,     &Booth::pull, &Booth::cloud,  &Booth::come,
                                &Booth::landmarks, &Booth::fit,  &Booth::report, &Booth::report,
                                &Booth::wait,      &Booth::stop};
    (this->*kSteps[input_.number(1) % kSteps.size()])();
    ask();
  }

 private:
  std::string known_scan() {
    return scans_.empty() || input_.number(1) % 8 == 0 ? "another" : scans_[input_.number(1) % scans_.size()];
  }

  void begin() {
    CaptureGoal goal;
    for (std::uint32_t sensors = input_.number(1) % 4; sensors > 0; --sensors)
      goal.sensors.emplace_back(kSensors[input_.number(1) % kSensors.size()]);
    if (input_.number(1) % 2 == 0) goal.timeout = input_.real();
    goal.with_fit = static_cast<std::uint8_t>(input_.number(1) % 2);
    handler_.stop();  // as the node does where a goal is refused
    fuzz::refused_or_done([&] { handler_.begin(goal, now_); });
    with_fit_ = goal.with_fit != 0;
    share_ = 0;
  }

  void pull() {
    if (handler_.waits_for_trigger()) handler_.pulled(stamp(input_).toNSec());
  }

  void cloud() { handler_.add(kSensors[input_.number(1) % kSensors.size()], scan(input_)); }

  void come() {
    const sensor_msgs::PointCloud2 cloud = scan(input_);
    scans_.push_back(tag_of(cloud).scan_id);
    handler_.add(cloud);
  }

  void landmarks() {
    const auto message = boost::make_shared<Landmarks>();
    message->scan_id = known_scan();
    handler_.add(Landmarks::ConstPtr(message));
  }

  void fit() {
    DeformedMesh message;
    message.scan_id = known_scan();
    message.status = input_.number(1) % 4 == 0 ? "solving" : "converged";
    handler_.add(message);
  }

  void report() {
    diagnostic_msgs::DiagnosticArray message;
    for (std::uint32_t reports = input_.number(1) % 8; reports > 0; --reports) {
      diagnostic_msgs::DiagnosticStatus status;
      const std::string stage = kStages[input_.number(1) % kStages.size()];
      constexpr std::array kNodes{"", "left/", "right/"};
      status.name =
          kNodes[input_.number(1) % kNodes.size()] + stage + (input_.number(1) % 16 == 0 ? "" : ": ") + stage;
      status.level = static_cast<std::int8_t>(input_.number(1) % 4);
      const auto say = [&](const char* key, const std::string& value) {
        if (input_.number(1) % 8 == 0) return;
        diagnostic_msgs::KeyValue pair;
        pair.key = key;
        pair.value = value;
        status.values.push_back(pair);
      };
      say("state", kStates[input_.number(1) % kStates.size()]);
      say("scan_id", known_scan());
      say("scan", known_scan());
      say("last_error", input_.number(1) % 4 == 0 ? "" : "not_a_body");
      say("last_error_message", "a sentence");
      say("working_seconds", std::to_string(input_.real()));
      message.status.push_back(status);
    }
    handler_.add(message, now_);
  }

  void wait() { now_ += input_.number(1) / 8.0; }
  void stop() { handler_.stop(); }

  /// What the node publishes ten times a second.
  void ask() {
    if (!handler_.is_busy()) return;
    if (const std::optional<CaptureResult> result = handler_.result(now_)) {
      fuzz::require(result->measured == result->code.empty() && !handler_.is_busy());
      fuzz::require(!result->measured || result->landmarks.scan_id == result->scan_id);
      fuzz::require(!result->measured || !with_fit_ || !result->fit_status.empty());
      return;
    }
    const CaptureFeedback feedback = handler_.feedback(now_);
    fuzz::require(feedback.progress >= share_ && feedback.progress <= 1);
    share_ = feedback.progress;
  }

  fuzz::Input& input_;
  CaptureHandler handler_;
  std::vector<std::string> scans_;
  double now_ = 1000, share_ = 0;
  bool with_fit_ = false;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  Booth booth(input);
  while (!input.at_end()) booth.step();
  return 0;
}
