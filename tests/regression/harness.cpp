#include "harness.hpp"

#include <fmt/format.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/PointCloud2.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <future>

#include "bag_runner.hpp"
#include "geometry/checked_yaml.hpp"
#include "golden_shape.hpp"
#include "replay_runner.hpp"
#include "ros/scan_tag.hpp"
#include "scan_files/bag_messages.hpp"
#include "scan_files/scan_bag.hpp"
#include "virtual_booth/sensor_bag.hpp"

namespace tensegric_fit::regression {
namespace {

namespace fs = std::filesystem;

const std::chrono::seconds kScanTime(1000000000);  // any fixed time will do
const std::string kFrame = "booth";

// A stage that takes so much longer in the launched chain than by its handler at the same time may do
// something else than its work; but both are by the clock, and a busy machine may slow one of them alone.
constexpr double kMoreMilliseconds = 1500, kTimesAsLong = 2;

// What the launch files load, with the case's own parameters over it.
YAML::Node pipeline_of(const Case& asked) {
  const std::string config = TENSEGRIC_FIT_LAUNCH "/config/";
  YAML::Node pipeline = geometry::load_yaml_map(config + "pipeline.yaml", kBadCase);
  if (asked.sensors())
    pipeline["assembler"] = geometry::load_yaml_map(config + "booth.yaml", kBadCase)["assembler"];
  for (const auto& stage : asked.pipeline)
    for (const auto& parameter : stage.second)
      pipeline[stage.first.Scalar()][parameter.first.Scalar()] = parameter.second;
  return pipeline;
}

// The first garment stands before the scan, the others after it.
void add_garments(const std::string& path, const std::vector<Garment>& garments) {
  if (garments.empty()) return;
  const auto [begin, end] = times_of(path);
  rosbag::Bag bag(path, rosbag::bagmode::Append);
  for (std::size_t i = 0; i < garments.size(); ++i)
    bag.write("/garment", i == 0 ? begin - ros::Duration(1) : end + ros::Duration(static_cast<double>(i)),
              garments[i]);
}

std::string scan_id_in(const std::string& path) {
  const rosbag::Bag bag(path);
  rosbag::View view(bag, rosbag::TypeQuery("sensor_msgs/PointCloud2"));
  if (view.size() != 1) throw geometry::Refusal(kBadCase, path + ": a case needs a bag with one scan");
  return node::tag_of(*view.begin()->instantiate<sensor_msgs::PointCloud2>()).scan_id;
}

class CaseRun {
 public:
  CaseRun(const Case& asked, const HarnessOptions& options)
      : options_(options), folder_(options.folder + "/" + asked.name), pipeline_(pipeline_of(asked)) {
    outcome_.asked = asked;
    fs::create_directories(folder_);
    for (const char* result : {"result.bag", "assembled.bag", "assembled_scan.bag", "replayed.bag"})
      fs::remove(folder_ + "/" + result);  // of an earlier run, which this one may not make again
    if (asked.bag.empty()) {
      customer_ = make_customer(asked.booth);
      if (asked.booth.sensors) {
        virtual_booth::write_sensor_bag(sensors_bag_, customer_->sensors, kFrame, kScanTime);
        fs::copy_file(sensors_bag_, bag_, fs::copy_options::overwrite_existing);
      } else {
        scan_files::write_bag_scan(bag_, customer_->scan, kFrame, kScanTime);
      }
    } else {
      fs::copy_file(asked.bag, bag_, fs::copy_options::overwrite_existing);
      if (asked.sensors()) fs::copy_file(asked.bag, sensors_bag_, fs::copy_options::overwrite_existing);
    }
    add_garments(bag_, own_garments());
  }

  Outcome run() {
    const bool sensors = outcome_.asked.sensors();
    ReplayInput input{sensors ? sensors_bag_ : bag_, pipeline_, outcome_.asked.measure_only(), folder_};
    std::future<std::string> launched;
    if (options_.replay)
      launched = std::async(std::launch::async,
                            [=] { return sensors ? launch_assembly(input) : launch_replay(input); });
    if (options_.bag) run_bag_runner(input.measure_only);
    if (!options_.replay) return std::move(outcome_);
    std::string fault = launched.get();
    sensor_msgs::PointCloud2::ConstPtr scan;
    if (sensors && (scan = assembled(input))) {
      input.bag = folder_ + "/assembled_scan.bag";
      rosbag::Bag(input.bag, rosbag::bagmode::Write)
          .write("/scan/points", scan_files::time_of(kScanTime), *scan);
      add_garments(input.bag, outcome_.asked.garments);  // the recorder kept the scan alone
      fault += launch_replay(input);
    }
    Recording recording;
    if (!sensors || scan) recording = replayed(input, scan_id_in(input.bag));
    recording.scan = scan;
    judge_replay(recording, fault);
    return std::move(outcome_);
  }

 private:
  // What is not in the bag already.
  std::vector<Garment> own_garments() const {
    return outcome_.asked.own_garments ? std::vector<Garment>() : outcome_.asked.garments;
  }

  void run_bag_runner(bool measure_only) {
    std::string fault;
    try {
      outcome_.recording = run_bag(bag_, pipeline_, measure_only);
      for (int i = 1; i < options_.repeat && fault.empty(); ++i)
        for (const std::string& difference :
             differences(hashes_of(outcome_.recording), hashes_of(run_bag(bag_, pipeline_, measure_only))))
          fault += fmt::format("repeat {}: {}; ", i + 1, difference);
    } catch (const std::exception& error) {
      fault = error.what();
    }
    add_verdict("bag", outcome_.recording, fault);
    fs::copy_file(bag_, result_bag_, fs::copy_options::overwrite_existing);
    append(outcome_.recording, result_bag_);
  }

  void judge_replay(const Recording& recording, const std::string& fault) {
    add_verdict("replay", recording, fault);
    if (!options_.bag) outcome_.recording = recording;
    if (!options_.bag || !fault.empty()) return;
    for (const std::string& difference : differences(hashes_of(outcome_.recording), hashes_of(recording)))
      outcome_.verdicts.back().faults.push_back("not the bag runner's payload: " + difference);
    for (const auto& [stage, taken] : recording.milliseconds) {
      const auto handler = outcome_.recording.milliseconds.find(stage);
      if (handler == outcome_.recording.milliseconds.end()) continue;
      if (taken > handler->second + kMoreMilliseconds && taken > kTimesAsLong * handler->second)
        outcome_.verdicts.back().notes.push_back(
            fmt::format("{} took {:.0f} ms in the launched chain, {:.0f} ms by its handler", stage, taken,
                        handler->second));
    }
  }

  void add_verdict(const std::string& runner, const Recording& recording, const std::string& fault) {
    Metrics metrics = metrics_of(recording);
    metrics.merge(shape_metrics(outcome_.asked, recording));
    if (customer_) metrics.merge(errors_of(recording, *customer_));
    outcome_.verdicts.push_back(judge(outcome_.asked, runner, metrics));
    if (!fault.empty()) outcome_.verdicts.back().faults.push_back(fault);
  }

  const HarnessOptions options_;
  const std::string folder_, bag_ = folder_ + "/scan.bag", sensors_bag_ = folder_ + "/sensors.bag",
                             result_bag_ = folder_ + "/result.bag";
  const YAML::Node pipeline_;
  std::optional<Customer> customer_;
  Outcome outcome_;
};

}  // namespace

bool Outcome::holds() const {
  return std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.holds(); });
}

Outcome run_case(const Case& asked, const HarnessOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Outcome outcome;
  try {
    outcome = CaseRun(asked, options).run();
  } catch (const std::exception& error) {  // its input cannot be made or copied, say
    outcome = {asked, {}, {judge(asked, options.bag ? "bag" : "replay", {})}};
    outcome.verdicts.back().faults.emplace_back(error.what());
  }
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

}  // namespace tensegric_fit::regression
