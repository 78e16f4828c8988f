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
#include "booth/scan_bag.hpp"
#include "geometry/checked_yaml.hpp"
#include "replay_runner.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::regression {
namespace {

namespace fs = std::filesystem;

const ros::Time kScanTime(1000000000, 0);  // any fixed time will do

// What the launch files load, with the case's own parameters over it.
YAML::Node pipeline_of(const Case& asked) {
  YAML::Node pipeline = geometry::load_yaml_map(TENSEGRIC_FIT_LAUNCH "/config/pipeline.yaml", kBadCase);
  for (const auto& stage : asked.pipeline)
    for (const auto& parameter : stage.second)
      pipeline[stage.first.Scalar()][parameter.first.Scalar()] = parameter.second;
  return pipeline;
}

// The first garment stands before the scan, the others after it.
void add_garments(const std::string& path, const std::vector<Garment>& garments) {
  rosbag::Bag bag(path, rosbag::bagmode::Append);
  for (std::size_t i = 0; i < garments.size(); ++i)
    bag.write("/garment", kScanTime + ros::Duration(i == 0 ? -1.0 : static_cast<double>(i)), garments[i]);
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
    if (asked.bag.empty()) {
      customer_ = make_customer(asked.booth);
      booth::write_bag_scan(bag_, customer_->scan, "booth", kScanTime);
    } else {
      fs::copy_file(asked.bag, bag_, fs::copy_options::overwrite_existing);
    }
    add_garments(bag_, asked.garments);
    scan_id_ = scan_id_in(bag_);
  }

  Outcome run() {
    std::future<Replayed> replayed;
    const bool measure_only = outcome_.asked.measure_only();
    if (options_.replay)
      replayed = std::async(std::launch::async,
                            [&] { return replay(bag_, scan_id_, pipeline_, measure_only, folder_); });
    if (options_.bag) run_bag_runner(measure_only);
    if (options_.replay) judge_replay(replayed.get());
    return std::move(outcome_);
  }

 private:
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
  }

  void judge_replay(const Replayed& replayed) {
    add_verdict("replay", replayed.recording, replayed.fault);
    if (!options_.bag) outcome_.recording = replayed.recording;
    if (!options_.bag || !replayed.fault.empty()) return;
    for (const std::string& difference :
         differences(hashes_of(outcome_.recording), hashes_of(replayed.recording)))
      outcome_.verdicts.back().faults.push_back("not the bag runner's payload: " + difference);
  }

  void add_verdict(const std::string& runner, const Recording& recording, const std::string& fault) {
    Metrics metrics = metrics_of(recording);
    if (customer_) metrics.merge(errors_of(recording, *customer_));
    outcome_.verdicts.push_back(judge(outcome_.asked, runner, metrics));
    if (!fault.empty()) outcome_.verdicts.back().faults.push_back(fault);
  }

  const HarnessOptions options_;
  const std::string folder_, bag_ = folder_ + "/scan.bag";
  const YAML::Node pipeline_;
  std::optional<Customer> customer_;
  std::string scan_id_;
  Outcome outcome_;
};

}  // namespace

bool Outcome::holds() const {
  return std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.holds(); });
}

Outcome run_case(const Case& asked, const HarnessOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Outcome outcome = CaseRun(asked, options).run();
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

}  // namespace tensegric_fit::regression
