#include "inspect/pipeline_watch.hpp"

#include <algorithm>
#include <array>

#include "inspect/panel_words.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr std::array<const char*, 5> kStages{"reconstruction", "landmarks", "control_mesh", "tensegric",
                                             "tffd"};

constexpr std::array<const char*, 2> kBooth{"assembler", "scan_player"};  // before the chain, where there are

bool is_of_booth(const std::string& stage) {
  return std::find(kBooth.begin(), kBooth.end(), stage) != kBooth.end();
}

}  // namespace

void PipelineWatch::hear(const StageReport& report, double now) {
  const auto before = stages_.find(report.stage);
  if (before != stages_.end() && !report.refused() && !report.last_error.empty() &&
      report.last_error != before->second.report.last_error) {
    dropped_ = report;
    dropped_at_ = now;
  }
  const bool new_words = before == stages_.end() || before->second.report.state != report.state ||
                         before->second.report.message != report.message;
  const bool starts =
      report.state == "working" && (before == stages_.end() || before->second.report.state != "working" ||
                                    before->second.report.scan_id != report.scan_id);
  const bool new_scan = before != stages_.end() && before->second.report.scan_id != report.scan_id;
  const double said_at = new_words ? now : before->second.said_at;
  if (report.stage == kStages.front() && new_scan) scan_at_ = now;
  // A stage that has come back does not know what it worked on before.
  if (report.stage == kStages.front() && !report.scan_id.empty() && (starts || report.scan_id != newest_)) {
    newest_ = report.scan_id;
    refused_.clear();
  }
  if (is_of_booth(report.stage) && !report.scan_id.empty() && (new_words || new_scan))
    refused_ = report.refused() ? report.scan_id : "";
  stages_[report.stage] = {report, now, said_at};
}

PipelineWatch::State PipelineWatch::state(double now) const {
  State state{"", false, false, 0, static_cast<int>(kStages.size()), ""};
  const bool lives = std::any_of(stages_.begin(), stages_.end(), [now](const auto& stage) {
    return now - stage.second.at <= geometry::kSilent;
  });
  state.newest_scan = refused_.empty() ? newest_ : refused_;
  if (!lives) return {words::kPipelineNotRunning, true, false, 0, state.all, state.newest_scan};
  const auto first = stages_.find(kStages.front());
  const std::string scan_id = first == stages_.end() ? "" : first->second.report.scan_id;
  for (const char* stage : kStages) {
    const auto found = stages_.find(stage);
    if (found == stages_.end() || now - found->second.at > geometry::kSilent) {
      if (!state.trouble) state.words = words::silent(stage);
      state.trouble = true;
      continue;
    }
    const StageReport& report = found->second.report;
    if (report.refused()) {
      if (!state.trouble) state.words = words::stage_refused(stage, report.message);
      state.trouble = true;
    } else if (report.state == "working") {
      state.working = true;
      if (!state.trouble) state.words = words::working(stage);
    } else if (report.scan_id == scan_id && !scan_id.empty()) {
      ++state.done;
    }
  }
  look_at_booth(now, state);
  if (state.words.empty()) state.words = state.done == state.all ? words::kReady : words::kWaitsForScan;
  if (!state.trouble && !state.working) add_warnings(state);
  return state;
}

void PipelineWatch::look_at_booth(double now, State& state) const {
  std::string words;
  for (const char* stage : kBooth) {
    const auto found = stages_.find(stage);
    if (found == stages_.end() || !words.empty()) continue;
    if (now - found->second.at > geometry::kSilent) {
      words = words::silent(stage);
    } else if (found->second.report.refused() && found->second.said_at >= scan_at_) {
      words = words::stage_refused(stage, found->second.report.message);
    }
  }
  if (words.empty() && now - dropped_at_ < kNews)
    words = words::stage_refused(dropped_.stage, dropped_.last_error);
  if (words.empty() || state.trouble) return;
  state.words = words;
  state.trouble = true;
}

// Of the scan that is shown; what garments are warned of has a place of its own.
void PipelineWatch::add_warnings(State& state) const {
  for (const char* stage : {"scan_player", "assembler", "reconstruction", "landmarks", "control_mesh"}) {
    const auto found = stages_.find(stage);
    if (found == stages_.end() || !found->second.report.warns) continue;
    const StageReport& report = found->second.report;
    if (is_of_booth(stage) || report.scan_id == state.newest_scan) state.words += " " + report.message;
  }
}

}  // namespace tensegric_fit::inspect
