#include "ros/fit_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <utility>

#include "files/html.hpp"
#include "files/page_template.hpp"
#include "geometry/carried_points.hpp"
#include "geometry/scan_stamp.hpp"
#include "geometry/shipped_files.hpp"
#include "inspect/garment_titles.hpp"
#include "inspect/page_view.hpp"
#include "inspect/pressure_words.hpp"
#include "inspect/warning_words.hpp"
#include "inspect/words.hpp"
#include "mesh_files/frame.hpp"
#include "ros/line_force.hpp"

namespace tensegric_fit::node {
namespace {

using files::html_escaped;
using geometry::ChangedMeasure;

/// After the name of what is uncertain: notes_of says why.
std::string star(const geometry::Measure& measure) {
  return measure.is_unsure() ? "*" : "";
}

std::string centimetres(double metres) {
  return fmt::format("{:.1f}", 100 * metres);
}

/// The first cell names the row.
std::string row(const std::vector<std::string>& cells) {
  std::string html = "<tr><th scope=\"row\">" + cells.front() + "</th>";
  for (std::size_t i = 1; i < cells.size(); ++i) html += "<td>" + cells[i] + "</td>";
  return html + "</tr>\n";
}

/// Centimetres before and after, and the change where both are known.
std::string changed_row(const std::string& name, const ChangedMeasure& measure) {
  const double before = measure.before.metres;
  if (!measure.after) return row({name + star(measure.before), centimetres(before), "", ""});
  return row({name + star(measure.before), centimetres(before), centimetres(*measure.after),
              inspect::words::centimetre_change(before, *measure.after)});
}

/// `name` is a button that shows where a girth's tape runs, where its tape is known; view.js enables it.
std::string row_of(const FitFigures& figures, const std::string& kind, const ChangedMeasure& measure) {
  std::string name = html_escaped(inspect::words::measure(measure.before.name, kind));
  const auto& loops = figures.measures.loops;
  if (kind == "girth" && std::any_of(loops.begin(), loops.end(), [&](const geometry::GirthLoop& loop) {
        return loop.name == measure.before.name;
      }))
    name = fmt::format("<button data-loop=\"{}\" aria-pressed=\"false\" disabled>{}</button>",
                       html_escaped(measure.before.name), name);
  return changed_row(name, measure);
}

std::string rows_of(const FitFigures& figures, const std::string& kind,
                    const std::vector<ChangedMeasure>& measures) {
  std::string rows;
  for (const ChangedMeasure& measure : measures) rows += row_of(figures, kind, measure);
  return rows;
}

/// What a bra is bought for.
std::string first_rows(const FitFigures& figures) {
  std::string rows;
  for (const char* name : {"bust", "underbust"})
    for (const ChangedMeasure& measure : figures.girths)
      if (measure.before.name == name)
        rows += changed_row(html_escaped(inspect::words::measure(name, "girth")) + ", cm", measure);
  for (const ChangedMeasure& measure : figures.heights)
    if (measure.before.name == "bust" && measure.after)
      rows += row({"lift of the bust, mm" + star(measure.before), "", "",
                   fmt::format("{:+.0f}", std::round(1e3 * (*measure.after - measure.before.metres)) + 0.0)});
  if (const auto& apart = figures.bust_points) rows += changed_row("bust points apart, cm", *apart);
  return rows;
}

std::string settings_of(const FitFigures& figures) {
  const FitState& fit = *figures.scan.fit;
  std::string rows;
  for (std::size_t i = 0; i < fit.lines.size(); ++i) {
    const LineResult& line = fit.lines[i];
    const auto force = figures.scan.forces ? force_of(*figures.scan.forces, fit, i) : std::nullopt;
    rows +=
        row({html_escaped(line.name), centimetres(line.initial), centimetres(line.final),
             fmt::format("{:.1f} %", 100 * (1 - line.ratio)),
             force ? inspect::words::with_uncertainty(force->newtons) : "",
             force && force->kilopascals > 0 ? inspect::words::with_uncertainty(force->kilopascals) : ""});
  }
  return rows;
}

/// What the hardest pressure means; nothing where none is known.
std::string pressure_of(const FitFigures& figures) {
  const FitState& fit = *figures.scan.fit;
  double hardest = 0;
  for (std::size_t i = 0; figures.scan.forces && i < fit.lines.size(); ++i)
    if (const auto force = force_of(*figures.scan.forces, fit, i))
      hardest = std::max(hardest, force->kilopascals);
  if (hardest <= 0) return "";
  return fmt::format("<p>The hardest pressure is {} kPa: {}.</p>\n",
                     inspect::words::with_uncertainty(hardest), inspect::words::pressure_meaning(hardest));
}

std::string summary_of(const FitFigures& figures) {
  std::string text;
  if (!figures.sizes.empty()) {
    text = "<p>Your bra size (EN 13402): <b>" + figures.sizes[0].label() + "</b>";
    if (figures.sizes.size() > 1)
      text += "; " + figures.sizes[1].label() + " may fit as well: your girths leave it open";
    text += ".</p>\n";
  }
  const FitState& fit = *figures.scan.fit;
  if (fit.status == FitState::INFEASIBLE)
    text += "<p>The garment cannot become as tight as was asked for; this is the nearest to it.</p>\n";
  else if (fit.status != FitState::CONVERGED)
    text += "<p>The computation did not come to its end: take these figures as a first impression.</p>\n";
  // What is shown is not smooth skin, or was never scanned.
  for (const geometry::FitWarning& warning : figures.scan.warnings)
    if (warning.is_warning() || warning.code == geometry::notice::kNotScanned)
      text += "<p>" + html_escaped(inspect::words::warning(warning, figures.measures)) + "</p>\n";
  return text;
}

std::string notes_of(const FitFigures& figures) {
  std::string notes;
  for (const auto& [kind, measures] : {std::pair{"height", &figures.heights}, {"girth", &figures.girths}})
    for (const ChangedMeasure& measure : *measures)
      if (measure.before.is_unsure())
        notes += fmt::format("<p>* {}: uncertain; {}.</p>\n",
                             html_escaped(inspect::words::measure(measure.before.name, kind)),
                             html_escaped(measure.before.reason));
  if (figures.bust_points && figures.bust_points->before.is_unsure())
    notes += "<p>* bust points apart: a bust point is uncertain.</p>\n";
  for (const geometry::Missing& part : geometry::missing_parts(figures.measures))
    notes +=
        fmt::format("<p>Missing: {}; {}.</p>\n", html_escaped(inspect::words::with_names_spoken(part.name)),
                    html_escaped(inspect::words::with_names_spoken(part.reason)));
  return notes;
}

/// Whose scan it is and where it came from, as far as that is known.
std::string whose(const ScanLabel& label) {
  std::string words;
  if (!label.customer.empty()) words += " Customer " + label.customer + ".";
  if (!label.source.empty()) words += " From " + label.source + ".";
  return html_escaped(words);
}

/// In fit.glb's frame, m to the tenth of a millimetre.
nlohmann::json points_of(const std::vector<Eigen::Vector3d>& points,
                         const Eigen::Isometry3d& body_from_scan) {
  nlohmann::json list = nlohmann::json::array();
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d p = mesh_files::y_up(body_from_scan * point);
    nlohmann::json rounded = nlohmann::json::array();
    for (const double value : {p.x(), p.y(), p.z()}) rounded.push_back(std::round(1e4 * value) / 1e4);
    list.push_back(std::move(rounded));
  }
  return list;
}

/// The tapes, for view.js.
nlohmann::json loops_of(const FitFigures& figures) {
  const geometry::SurfaceTree skin(figures.body);
  nlohmann::json loops = nlohmann::json::object();
  for (const geometry::GirthLoop& loop : figures.measures.loops) {
    const auto& frame = figures.measures.body_from_scan;
    const geometry::CarriedPoints carried(figures.body, skin, loop.points);
    loops[loop.name] = {{"before", points_of(loop.points, frame)},
                        {"after", points_of(carried.at(figures.deformed), frame)}};
  }
  return loops;
}

inspect::PageView view_of(const FitFigures& figures, const files::FileContent& model) {
  return {model.bytes,
          "Your body",
          "before",
          "with it",
          "before beside it",
          "skin pressed together",
          "unchanged",
          "stretched",
          "<p class=\"notes\">Choose an underlined measure to see where it is taken.</p>\n",
          {{"attribute", "_DISTORTION"},
           {"per_cent", true},
           {"here", "skin here: "},
           {"low", "pressed together"},
           {"same", "unchanged"},
           {"high", "stretched"}},
          loops_of(figures)};
}

/// What is worn, with title, sentence and picture where it is a shipped garment (or several joined by +).
std::string garment_of(const std::string& name) {
  std::string shown;
  const std::vector<inspect::GarmentTitle> known = inspect::garments_in(geometry::shipped_folder("garments"));
  std::istringstream parts(name);
  std::set<std::string> named;
  for (std::string part; std::getline(parts, part, '+');)
    for (const inspect::GarmentTitle& garment : known) {
      if (garment.name != part || !named.insert(part).second) continue;
      const std::string picture = garment.picture.empty()
                                      ? ""
                                      : "<img alt=\"\" src=\"data:image/png;base64," +
                                            files::base64(files::bytes_of(garment.picture)) + "\">";
      shown +=
          fmt::format("<p class=\"garment\">{}<span><b>{}: {}.</b> {}</span></p>\n", picture,
                      html_escaped(garment.name), html_escaped(garment.title), html_escaped(garment.about));
    }
  return shown;
}

}  // namespace

std::string fit_sheet(const FitFigures& figures, const std::vector<SheetPicture>& pictures,
                      const files::FileContent& model) {
  const inspect::PageView view = view_of(figures, model);
  std::string drawn;
  for (const SheetPicture& picture : pictures)
    drawn += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
        html_escaped(picture.caption), files::base64(picture.png.bytes));
  const std::string day = geometry::day_of(figures.scan.body->header.stamp.toSec());
  const std::string footer = fmt::format(
      "Scan {}{}.{} Made by tensegric_fit {}. Measurements after ISO 8559-1; they are those of a scan, not "
      "of a "
      "medical device.",
      html_escaped(figures.scan.body->scan_id), day.empty() ? "" : ", " + day, whose(figures.scan.label),
      TENSEGRIC_FIT_VERSION);
  return files::filled_in(
      files::bytes_of(geometry::shipped_folder("page") + "/fit.html"),
      {{"title", "Garment " + html_escaped(figures.scan.fit->garment)},
       {"summary", summary_of(figures)},
       {"first", first_rows(figures)},
       {"section", inspect::view_section(view)},
       {"rows", rows_of(figures, "girth", figures.girths) + rows_of(figures, "height", figures.heights)},
       {"notes", notes_of(figures)},
       {"pictures", drawn},
       {"garment", garment_of(figures.scan.fit->garment)},
       {"settings", settings_of(figures)},
       {"pressure", pressure_of(figures)},
       {"footer", footer},
       {"view", inspect::view_scripts(view)}});
}

}  // namespace tensegric_fit::node
