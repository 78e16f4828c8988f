#include "bag_runner.hpp"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <chrono>

#include "assembler/assembler_handler.hpp"
#include "control_mesh/control_mesh_handler.hpp"
#include "fit/bind_body.hpp"
#include "geometry/status.hpp"
#include "landmarks/landmarks_handler.hpp"
#include "peak_memory.hpp"
#include "reconstruction/reconstruction_handler.hpp"
#include "tensegric/tensegric_handler.hpp"
#include "tffd/tffd_handler.hpp"

namespace tensegric_fit::regression {
namespace {

class Chain {
 public:
  Chain(const YAML::Node& pipeline, bool measure_only)
      : pipeline_(pipeline),
        reconstruction_(parameters("reconstruction")),
        landmarks_(parameters("landmarks")),
        control_mesh_(parameters("control_mesh")),
        tensegric_(parameters("tensegric"), fit::bind_body),
        tffd_(parameters("tffd")),
        measure_only_(measure_only) {
    if (pipeline["assembler"]) assembler_.emplace(parameters("assembler"));
  }

  void feed(const tf2_msgs::TFMessage& sensors) {
    for (const auto& sensor : sensors.transforms) transforms_.setTransform(sensor, "bag", true);
  }

  void feed(const std::string& topic, const sensor_msgs::PointCloud2& cloud) {
    if (!assembler_) return feed(cloud);
    constexpr double kNow = 0;  // a capture is whole or waits for ever
    const std::vector<std::string>& sensors = assembler_->setup().sensors;
    for (std::size_t i = 0; i < sensors.size(); ++i)
      if (topic == "/" + sensors[i]) assembler_->add(static_cast<int>(i), cloud, kNow);
    while (const auto capture = assembler_->next(kNow)) {
      run("assembler", [&] { recording.scan = assembler_->handle(*capture, transforms_).scan; });
      if (recording.scan) feed(*recording.scan);
    }
  }

  void feed(const sensor_msgs::PointCloud2& scan) {
    const node::ScanTag tag = node::tag_of(scan);
    recording.scan_id = tag.scan_id;
    run("reconstruction", [&] {
      const auto output = reconstruction_.handle(scan, tag);
      recording.model = output.model;
      recording.body = output.mesh;
    });
    if (!recording.body) return;
    run("landmarks", [&] {
      const auto output = landmarks_.handle({recording.body, recording.model});
      recording.landmarks = output.landmarks;
      recording.body_frame = output.body_frame;
    });
    if (measure_only_) return;
    if (recording.model) control_mesh_.add(recording.model);
    control_mesh_.add(recording.body);
    tffd_.add(recording.body);
    const auto early = tensegric_.add(recording.body);
    if (early) throw std::logic_error("a fit before the control mesh");
    if (recording.landmarks) feed(recording.landmarks);
  }

  void feed(const Garment& garment) {
    std::optional<node::TensegricHandler::Input> input;
    run("tensegric", [&] { input = tensegric_.put_on(garment); });
    fit(input);
  }

  Recording recording;

 private:
  node::Parameters parameters(const std::string& stage) const { return {pipeline_[stage], stage}; }

  void feed(const Landmarks::ConstPtr& landmarks) {
    tensegric_.add(landmarks);
    tffd_.add(landmarks);
    if (const auto input = control_mesh_.add(landmarks))
      run("control_mesh", [&] { recording.control = control_mesh_.handle(*input).control; });
    if (!recording.control) return;
    tffd_.add(recording.control);
    fit(tensegric_.add(recording.control));
  }

  void fit(const std::optional<node::TensegricHandler::Input>& input) {
    if (!input) return;
    const std::size_t fits = recording.fits.size();
    run("tensegric", [&] {
      const auto output = tensegric_.handle(
          *input, [] { return true; }, [](const FitState&) {});
      recording.fits.push_back(output->fit);
      recording.forces.push_back(output->forces);
      recording.histories.push_back(output->solution.history);
    });
    if (recording.fits.size() == fits) return;
    if (const auto joined = tffd_.add(recording.fits.back()))
      run("tffd", [&] {
        const auto output = tffd_.handle(*joined);
        recording.deformed.push_back(output.scan.deformed);
        recording.warnings.push_back(output.warnings);
      });
  }

  template <typename Work>
  void run(const std::string& stage, const Work& work) {
    gauge::forget_peak();
    const auto start = std::chrono::steady_clock::now();
    try {
      work();
    } catch (const geometry::Refusal& refusal) {
      recording.refused_by = stage;
      recording.refusal = refusal.code();
    }
    recording.milliseconds[stage] =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    recording.peak_mebibytes[stage] = gauge::status_mebibytes("VmHWM");
  }

  const YAML::Node pipeline_;
  std::optional<node::AssemblerHandler> assembler_;
  tf2::BufferCore transforms_;
  const node::ReconstructionHandler reconstruction_;
  const node::LandmarksHandler landmarks_;
  node::ControlMeshHandler control_mesh_;
  node::TensegricHandler tensegric_;
  node::TffdHandler tffd_;
  const bool measure_only_;
};

}  // namespace

Recording run_bag(const std::string& path, const YAML::Node& pipeline, bool measure_only) {
  Chain chain(pipeline, measure_only);
  const rosbag::Bag bag(path);
  rosbag::View view(bag);
  for (const rosbag::MessageInstance& message : view) {
    if (const auto sensors = message.instantiate<tf2_msgs::TFMessage>()) chain.feed(*sensors);
    if (const auto cloud = message.instantiate<sensor_msgs::PointCloud2>())
      chain.feed(message.getTopic(), *cloud);
    if (const auto garment = message.instantiate<Garment>()) chain.feed(*garment);
  }
  if (chain.recording.scan_id.empty())
    throw geometry::Refusal(
        geometry::refusal::kBrokenFile,
        path + (chain.recording.refusal.empty() ? ": holds no scan"
                                                : ": its clouds are refused: " + chain.recording.refusal));
  return chain.recording;
}

}  // namespace tensegric_fit::regression
