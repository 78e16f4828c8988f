#include "inspect/pipeline_watch.hpp"

#include <algorithm>
#include <array>

#include "geometry/status.hpp"
#include "inspect/panel_words.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr std::array<const char*, 5> kStages{"reconstruction", "landmarks", "control_mesh", "tensegric",
                                             "tffd"};
constexpr std::size_t kLandmarks = 1;  // the last of them that only measures

// Before the chain, where there are.
constexpr std::array<const char*, 3> kBooth{"depth_cameras", "assembler", "scan_player"};

bool is_of_booth(const std::string& stage) {
  return std::find(kBooth.begin(), kBooth.end(), stage) != kBooth.end();
}

}  // namespace

void PipelineWatch::hear(const StageReport& report, double now) {
  const auto before = stages_.find(report.stage);
  const bool first = before == stages_.end();
  // That a newer scan overtook another within the chain is no news: the newer one is shown.
  const bool is_overtaken = report.code == geometry::refusal::kSuperseded && !is_of_booth(report.stage);
  if (!first && !report.refused() && !is_overtaken && !report.last_error.empty() &&
      report.last_error != before->second.report.last_error) {
    dropped_ = report;
    dropped_at_ = now;
  }
  const bool new_words =
      first || before->second.report.state != report.state || before->second.report.message != report.message;
  const bool new_scan = !first && before->second.report.scan_id != report.scan_id;
  const bool starts = !first && report.state == "working" && before->second.report.state != "working";
  const double said_at = new_words ? now : before->second.said_at;
  // A stage that has come back does not know what it worked on before.
  const bool has_another = !report.scan_id.empty() && (first || new_scan || starts);
  if (report.stage == kStages.front()) {
    if (new_scan) scan_at_ = now;
    if (has_another) {
      newest_ = report.scan_id;
      refused_.clear();
      lone_ = false;
      made_.push_back(newest_);
      if (made_.size() > kRemembered) made_.pop_front();
    }
  } else if (report.stage == kStages[kLandmarks]) {
    if (has_another && !report.refused() && (newest_.empty() || (!first && is_lone(report)))) {
      newest_ = report.scan_id;
      refused_.clear();
      lone_ = true;
      if (new_scan) scan_at_ = now;
    }
  }
  if (is_of_booth(report.stage) && !report.scan_id.empty() && (new_words || new_scan))
    refused_ = report.refused() ? report.scan_id : "";
  stages_[report.stage] = {report, now, said_at};
}

// Somebody else's body, which came to the landmarks past reconstruction. One of reconstruction's own that
// they come to late is not the newest, nor is any while the next is made.
bool PipelineWatch::is_lone(const StageReport& report) const {
  const auto maker = stages_.find(kStages.front());
  const bool makes_next = maker != stages_.end() && maker->second.report.state == "working";
  return !makes_next && std::find(made_.begin(), made_.end(), report.scan_id) == made_.end();
}

// A chain that only measures has none of the stages that fit. Where one of them was heard, all belong to it.
bool PipelineWatch::fits_garments() const {
  return std::any_of(kStages.begin() + kLandmarks + 1, kStages.end(),
                     [this](const char* stage) { return stages_.count(stage) != 0; });
}

PipelineWatch::State PipelineWatch::state(double now) const {
  const bool fits = fits_garments();
  const std::size_t all = fits ? kStages.size() : kLandmarks + 1;
  State state{"", false, false, 0, static_cast<int>(all), ""};
  const bool lives = std::any_of(stages_.begin(), stages_.end(), [now](const auto& stage) {
    return now - stage.second.at <= geometry::kSilent;
  });
  state.newest_scan = refused_.empty() ? newest_ : refused_;
  const bool begins = now - start_ < geometry::kSilent;
  if (!lives && begins) return state;
  if (!lives) return {words::kPipelineNotRunning, true, false, 0, state.all, state.newest_scan};
  const auto first = stages_.find(kStages.front());
  const std::string scan_id = lone_ ? newest_ : first == stages_.end() ? "" : first->second.report.scan_id;
  for (std::size_t i = 0; i < all; ++i) {
    const char* stage = kStages[i];
    const auto found = stages_.find(stage);
    if (found == stages_.end() && begins) continue;
    if (found == stages_.end() || now - found->second.at > geometry::kSilent) {
      if (!state.trouble) state.words = words::silent(stage);
      state.trouble = true;
      continue;
    }
    const StageReport& report = found->second.report;
    if (i == 0 && lone_) {
      ++state.done;  // it has no part in this body
    } else if (report.refused()) {
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
  if (state.words.empty())
    state.words = state.done < state.all ? words::kWaitsForScan
                  : fits                 ? words::kReady
                                         : words::kReadyToMeasure;
  if (!state.trouble && !state.working) add_warnings(state);
  return state;
}

void PipelineWatch::look_at_booth(double now, State& state) const {
  std::string words;
  for (const char* stage : kBooth) {
    const auto found = stages_.find(stage);
    if (found == stages_.end() || !words.empty()) continue;
    if (scan_at_ - found->second.at > geometry::kSilent) continue;  // scans come without it
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
