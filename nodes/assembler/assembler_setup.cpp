#include "assembler/assembler_setup.hpp"

#include <fmt/format.h>

#include <set>

#include "geometry/status.hpp"

namespace tensegric_fit::node {
namespace {

constexpr int kMostSensors = 64;

[[noreturn]] void refuse(const std::string& message) {
  throw geometry::Refusal(geometry::refusal::kBadOption, message);
}

std::vector<std::string> check_topics(std::vector<std::string> topics) {
  const std::set<std::string> different(topics.begin(), topics.end());
  if (topics.empty() || topics.size() > kMostSensors || different.size() != topics.size())
    refuse(fmt::format("parameter 'sensors' must list 1 to {} topics, each once", kMostSensors));
  return topics;
}

}  // namespace

AssemblerSetup assembler_setup(Parameters parameters) {
  AssemblerSetup setup;
  setup.sensors = check_topics(parameters.texts("sensors"));
  const int count = static_cast<int>(setup.sensors.size());
  const geometry::Range up_to_all{1, static_cast<double>(count)};
  setup.frame_id = parameters.frame("frame_id", "booth");
  setup.min_sensors = parameters.integer("min_sensors", count, up_to_all);
  setup.capture.slop = parameters.number("slop", setup.capture.slop, assembler::kSlop);
  setup.capture.timeout = parameters.number("timeout", setup.capture.timeout, assembler::kTimeout);
  assembler::AssemblerOptions& assembler = setup.assembler;
  assembler.refine = parameters.flag("refine", assembler.refine);
  assembler.sensors_per_column =
      parameters.integer("sensors_per_column", assembler.sensors_per_column, up_to_all);
  assembler::RegistrationOptions& registration = assembler.registration;
  registration.max_shift = parameters.number("max_shift", registration.max_shift, assembler::kMaxShift);
  registration.max_turn = parameters.number("max_turn", registration.max_turn, assembler::kMaxTurn);
  parameters.check_all_known();
  if (count % assembler.sensors_per_column != 0)
    refuse(fmt::format("parameter 'sensors_per_column' is {}: {} sensors are no whole number of columns",
                       assembler.sensors_per_column, count));
  return setup;
}

}  // namespace tensegric_fit::node
