// Parameters of the nodes, as a configuration file gives them. The first byte chooses the node, the rest is
// the YAML.
#include <array>

#include "assembler/assembler_handler.hpp"
#include "capture/capture_handler.hpp"
#include "control_mesh/control_mesh_handler.hpp"
#include "correlation/correlation_handler.hpp"
#include "fit/bind_body.hpp"
#include "fuzz_target.hpp"
#include "landmarks/landmarks_handler.hpp"
#include "reconstruction/reconstruction_handler.hpp"
#include "ros/forget_desk.hpp"
#include "tensegric/tensegric_handler.hpp"
#include "tffd/tffd_handler.hpp"

namespace {

using namespace tensegric_fit;
using namespace tensegric_fit::node;

using Read = void (*)(Parameters);

const std::array<Read, 9> kReaders{
    [](Parameters p) {
      const reconstruction::Options options = reconstruction_options(p);
      p.check_all_known();
      fuzz::require(options.body_triangles > 0);
    },
    [](Parameters p) { fuzz::require(!LandmarksHandler(std::move(p)).body_frame().empty()); },
    [](Parameters p) { ControlMeshHandler handler(std::move(p)); },
    [](Parameters p) { TensegricHandler handler(std::move(p), fit::bind_body); },
    [](Parameters p) { TffdHandler handler(std::move(p)); },
    [](Parameters p) {
      CorrelationHandler handler(std::move(p), [](const auto&) { return MeasuredScan(); });
    },
    [](Parameters p) {
      const AssemblerHandler::Setup setup = AssemblerHandler(std::move(p)).setup();
      fuzz::require(setup.capture.min_sensors > 0 && !setup.sensors.empty());
    },
    [](Parameters p) { CaptureHandler handler(std::move(p), "/"); },
    [](Parameters p) { fuzz::require(vault_options(std::move(p)).retention_days >= 0); },
};

YAML::Node yaml_of(const std::uint8_t* data, std::size_t size) {
  try {
    return YAML::Load(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const YAML::Exception&) {  // rosparam's to refuse
    return {};
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const YAML::Node values = yaml_of(data + 1, size - 1);
  fuzz::refused_or_done([&] { kReaders[data[0] % kReaders.size()](Parameters(values, "stage")); });
  return 0;
}
