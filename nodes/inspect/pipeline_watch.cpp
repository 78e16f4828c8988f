#include "inspect/pipeline_watch.hpp"

#include <algorithm>
#include <array>

#include "inspect/panel_words.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr std::array<const char*, 5> kStages{"reconstruction", "landmarks", "control_mesh", "tensegric",
                                             "tffd"};

}  // namespace

void PipelineWatch::hear(const StageReport& report, double now) {
  stages_[report.stage] = {report, now};
}

PipelineWatch::State PipelineWatch::state(double now) const {
  State state{"", false, false, 0, static_cast<int>(kStages.size()), ""};
  const bool lives = std::any_of(stages_.begin(), stages_.end(),
                                 [now](const auto& stage) { return now - stage.second.at <= kSilence; });
  if (!lives) return {words::kPipelineNotRunning, true, false, 0, state.all, ""};
  const auto first = stages_.find(kStages.front());
  const std::string scan_id = first == stages_.end() ? "" : first->second.report.scan_id;
  state.newest_scan = scan_id;
  for (const char* stage : kStages) {
    const auto found = stages_.find(stage);
    if (found == stages_.end() || now - found->second.at > kSilence) {
      if (!state.trouble) state.words = words::silent(stage);
      state.trouble = true;
      continue;
    }
    const StageReport& report = found->second.report;
    if (report.state == "refused" || report.state == "failed") {
      if (!state.trouble) state.words = words::stage_refused(stage, report.message);
      state.trouble = true;
    } else if (report.state == "working") {
      state.working = true;
      if (!state.trouble) state.words = words::working(stage);
    } else if (report.scan_id == scan_id && !scan_id.empty()) {
      ++state.done;
    }
  }
  if (state.words.empty()) state.words = state.done == state.all ? words::kReady : words::kWaitsForScan;
  return state;
}

}  // namespace tensegric_fit::inspect
