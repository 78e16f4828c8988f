#include "capture/stage_board.hpp"

#include <fmt/format.h>

namespace tensegric_fit::capture {

bool StageBoard::report(const StageReport& report, double now) {
  const StageReport* last = find(report.stage);
  // what it drops after a refusal changes its last error alone
  const auto says_the_same = [&] {
    return (last->code == report.code && last->last_error == report.last_error) ||
           (!report.message.empty() && last->message == report.message);
  };
  const bool again = last != nullptr && last->refused() && last->scan_id == report.scan_id && says_the_same();
  stages_[report.stage] = {report, now};
  return report.refused() && !again;
}

const StageReport* StageBoard::find(const std::string& stage) const {
  const auto heard = stages_.find(stage);
  return heard == stages_.end() ? nullptr : &heard->second.report;
}

double StageBoard::working_seconds(const std::string& stage, double now) const {
  const auto heard = stages_.find(stage);
  if (heard == stages_.end() || heard->second.report.state != "working") return 0;
  return heard->second.report.working_seconds + now - heard->second.at;
}

double StageBoard::silent_seconds(const std::string& stage, double since, double now) const {
  const auto heard = stages_.find(stage);
  return now - (heard == stages_.end() ? since : heard->second.at);
}

std::string StageBoard::trouble(double now) const {
  std::string words;
  for (const auto& [stage, heard] : stages_) {
    const double silent = now - heard.at, working = working_seconds(stage, now);
    if (silent > geometry::kSilent)
      words += fmt::format("{}{} is dead: silent for {:.0f} s", words.empty() ? "" : "; ", stage, silent);
    else if (working > kSlow)
      words += fmt::format("{}{} is slow: working for {:.0f} s", words.empty() ? "" : "; ", stage, working);
  }
  return words;
}

}  // namespace tensegric_fit::capture
