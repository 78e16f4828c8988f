#include "body_score.hpp"

#include <fmt/format.h>

#include "control_check.hpp"
#include "fit/chain.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::population {

std::string input_name(Input input) {
  return input == Input::surface ? "surface" : input == Input::merged_scan ? "merged scan" : "scan";
}

Score score_of(const Family& family, const std::string& name, Input input,
               const std::vector<control_mesh::Template>& patterns, bool* made) {
  Score score{family.name(), input_name(input), name, "", {}};
  Subject subject;
  fit::StageTimes times;
  if (made != nullptr) *made = false;
  try {
    subject = family.body(name, input);
    if (made != nullptr) *made = true;
    const fit::Body body = input == Input::surface ? fit::measure_mesh(std::move(subject.surface), {}, times)
                                                   : fit::measure_scan(subject.scan, {}, times);
    score.figures = figures_of(body.measures, subject.truth);
    for (const control_mesh::Template& pattern : patterns)
      for (const Figure& figure : control_figures(pattern, body.mesh.mesh, body.measures, *body.model))
        score.figures.push_back(figure);
  } catch (const geometry::Refusal& refusal) {
    score.refusal = fmt::format("{}: {}", refusal.code(), refusal.what());
    score.figures = figures_of({}, subject.truth);
  }
  return score;
}

}  // namespace tensegric_fit::population
