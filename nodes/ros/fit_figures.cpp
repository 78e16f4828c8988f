#include "ros/fit_figures.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"
#include "ros/body_messages.hpp"
#include "ros/flat.hpp"

namespace tensegric_fit::node {
namespace {

using geometry::ChangedMeasure;
using geometry::Refusal;

void check_sizes(const FitFigures& figures) {
  const auto& nodes = figures.control.outer;
  bool fits = !figures.body.vertices.empty() && figures.deformed.size() == figures.body.vertices.size() &&
              figures.distortion.size() == figures.body.vertices.size() &&
              figures.control_deformed.size() == nodes.size();
  for (const LineResult& line : figures.scan.fit->lines) {
    for (const std::uint32_t node : line.nodes) fits = fits && node < nodes.size();
    fits = fits && line.table_stretch.size() == line.table_tension.size();
  }
  if (!fits)
    throw Refusal(geometry::refusal::kBadMesh, "the fit does not belong to this body and control mesh");
}

void check_finite(const FitFigures& figures) {
  const auto check = [](std::initializer_list<double> values, const std::string& what) {
    if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
      throw Refusal(geometry::refusal::kNonFinite, what + " is not finite");
  };
  const FittedScan& scan = figures.scan;
  for (const auto* measures : {&figures.measures.heights, &figures.measures.girths})
    for (const geometry::Measure& m : *measures) check({m.metres, m.confidence, m.half_width}, m.name);
  for (const geometry::Landmark& landmark : figures.measures.landmarks)
    check({landmark.confidence}, landmark.name);
  for (const LineResult& line : scan.fit->lines) {
    check({line.initial, line.neutral, line.final, line.request, line.ratio, line.tension, line.stiffness,
           line.tension_limit},
          line.name);
    for (const auto* column : {&line.table_stretch, &line.table_tension})
      for (const double value : *column) check({value}, line.name);
  }
  for (const RegionResult& region : scan.fit->regions)
    check({region.volume_before, region.volume_after}, region.name);
  check({scan.fit->residual, scan.fit->twist, scan.fit->side_lean}, "the fit");
  check({scan.deformed->volume_before, scan.deformed->volume_after}, "the body's volume");
  for (const double distortion : figures.distortion) check({distortion}, "distortion");
}

void add_sizes(FitFigures& figures) {
  const auto girth = [&figures](const char* name) {
    return std::find_if(figures.girths.begin(), figures.girths.end(),
                        [name](const ChangedMeasure& measure) { return measure.before.name == name; });
  };
  const auto bust = girth("bust"), underbust = girth("underbust");
  if (bust == figures.girths.end() || underbust == figures.girths.end()) return;
  figures.sizes = inspect::bra_sizes(bust->before, underbust->before);
  if (!figures.sizes.empty() && bust->after && underbust->after)
    figures.size_after = inspect::bra_size(*bust->after, *underbust->after);
}

}  // namespace

FitFigures figures_of(const FittedScan& scan) {
  FitFigures figures;
  figures.scan = scan;
  figures.body = mesh_in(*scan.body);
  figures.deformed = points_in(scan.deformed->vertices);
  figures.distortion.assign(scan.deformed->distortion.begin(), scan.deformed->distortion.end());
  figures.control = control_in(*scan.control);
  figures.control_deformed = points_in(scan.fit->outer);
  figures.measures = measures_in(*scan.landmarks);
  check_lines(*scan.fit);
  check_sizes(figures);
  check_finite(figures);
  figures.in_scan_posture =
      geometry::in_scan_posture(figures.body, figures.deformed, bones_of(*scan.fit, figures.measures));
  const geometry::MovedSkin skin{figures.body, figures.in_scan_posture};
  figures.heights = geometry::heights_after(figures.measures, skin);
  figures.girths = geometry::girths_after(figures.measures, skin);
  figures.bust_points = geometry::bust_points_apart(figures.measures, skin);
  add_sizes(figures);
  return figures;
}

}  // namespace tensegric_fit::node
