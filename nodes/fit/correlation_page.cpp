#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/html.hpp"
#include "fit/correlation_report.hpp"
#include "inspect/colours.hpp"
#include "inspect/correlation_model.hpp"
#include "inspect/page_view.hpp"
#include "inspect/words.hpp"

namespace tensegric_fit::fit {
namespace {

using correlation::Difference;
using files::html_escaped;

constexpr char kPage[] = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Simulated and worn</title>
<style>
@page {{ size: A4; margin: 12mm }}
body {{ font: 10pt sans-serif; color: #333; max-width: 240mm; margin: 0 auto; padding: 3mm }}
h1 {{ font-size: 15pt; margin: 0 0 2mm }}
h2 {{ font-size: 11pt; margin: 5mm 0 1mm }}
p {{ margin: 1mm 0 }}
table {{ border-collapse: collapse }}
th, td {{ padding: .6mm 1.6mm; text-align: right; border-bottom: .2mm solid #ddd }}
th:first-child, td:first-child {{ text-align: left }}
.wide {{ overflow-x: auto }}
figure {{ margin: 0 0 3mm; break-inside: avoid }}
img {{ width: 100% }}
figcaption, footer, .note {{ font-size: 8pt; color: #666 }}
</style>
</head>
<body>
<h1>Simulated and worn</h1>
<p>{summary}</p>
<p class="note">{lines}. Garment thickness allowed for: {thickness:.1f} mm.</p>
<h2>Distance of the worn surface from the simulated one, mm</h2>
<div class="wide"><table>
<tr><th></th><th>mean</th><th>median</th><th>mean size</th><th>rms</th><th>95 % below</th><th>compared</th></tr>
{distances}</table></div>
<p class="note">Mean and median carry a sign: positive where the worn surface lies outside. Still skin is what the garment leaves alone: it says how well the two scans lie on each other.</p>
{section}{view}{pictures}
<h2>What the garment did, cm</h2>
<div class="wide"><table>
<tr><th></th><th>before</th><th>simulated</th><th>worn</th><th>change simulated</th><th>change worn</th><th>worn less simulated</th></tr>
{rows}</table></div>
{notes}<footer>Worn scan {worn}; simulated on {scan}. Heights are above the soles of the scan before. Measured alike on all three bodies.</footer>
</body>
</html>
)";

std::string centimetres(const std::optional<double>& metres) {
  return metres ? fmt::format("{:.1f}", 100 * *metres) : "";
}

std::string change(const std::optional<double>& from, const std::optional<double>& to) {
  return from && to ? inspect::words::centimetre_change(*from, *to) : "";
}

struct Rows {
  std::string table, notes;
};

void add_rows(const std::vector<Difference>& differences, const std::string& kind, Rows& rows) {
  for (const Difference& d : differences) {
    if (kind == "height" && (d.name == "bust" || d.name == "hip")) continue;  // as bust point and buttock
    const std::string name = html_escaped(inspect::words::measure(d.name, kind));
    const bool unsure = d.confidence < geometry::kUnsure;
    rows.table += fmt::format(
        "<tr><td>{}{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", name,
        unsure ? "*" : "", centimetres(d.before), centimetres(d.simulated), centimetres(d.worn),
        change(d.before, d.simulated), change(d.before, d.worn), change(d.simulated, d.worn));
    if (unsure)
      rows.notes += fmt::format("<p class=\"note\">* {}: uncertain; {}.</p>\n", name, html_escaped(d.reason));
  }
}

// With a sign, and none where nothing is seen of it.
std::string signed_millimetres(double metres) {
  const double tenths = std::round(1e4 * metres);
  return tenths == 0 ? "0.0" : fmt::format("{:+.1f}", tenths / 10);
}

std::string distance_row(const std::string& name, const correlation::Summary& s) {
  return fmt::format(
      "<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.1f}</td><td>{:.1f}</td><td>{:.1f}</"
      "td><td>{:.0f} "
      "%</td></tr>\n",
      name, signed_millimetres(s.mean), signed_millimetres(s.median), 1e3 * s.mean_size, 1e3 * s.rms,
      1e3 * s.p95, 100 * s.compared);
}

std::string lines_of(const FittedFolder& fitted) {
  std::string text = "Simulated lines:";
  for (const FittedFolder::Line& line : fitted.lines)
    text +=
        fmt::format(" {} asked {:.3f}, reached {:.3f};", html_escaped(line.name), line.request, line.ratio);
  text.pop_back();
  return text;
}

}  // namespace

std::string correlation_page(const Correlated& correlated, const std::vector<PagePicture>& pictures,
                             const std::string& model) {
  const std::string end = fmt::format("{:.0f} mm", 1e3 * inspect::kFarthestDistance);
  const inspect::PageView view{
      model,
      "The simulated body",
      "before",
      "simulated",
      "worn beside it",
      end + " inside",
      "worn surface",
      end + " outside",
      "<p class=\"note\">Colours and distances are those of the simulated body.</p>\n",
      {{"attribute", "_DISTANCE"},
       {"per_cent", false},
       {"here", "the worn surface lies here: "},
       {"low", "inside"},
       {"same", "on the simulated one"},
       {"high", "outside"},
       {"none", "not compared"},
       {"none_from", inspect::kNotComparedDistance / 2}}};
  const correlation::Summary &covered = correlated.result.covered, &still = correlated.result.still;
  Rows rows;
  add_rows(correlated.differences.effects, "", rows);
  add_rows(correlated.differences.girths, "girth", rows);
  add_rows(correlated.differences.heights, "height", rows);
  std::string drawn;
  for (const PagePicture& picture : pictures)
    drawn += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
        html_escaped(picture.caption), files::base64(picture.png));
  return fmt::format(
      kPage,
      fmt::arg("summary",
               fmt::format("Under the garment the real body lies <b>{:.1f} mm</b> from the simulated "
                           "one on average ({} mm with its sign); where the garment leaves "
                           "the skin alone, {:.1f} mm.{}",
                           1e3 * covered.mean_size, signed_millimetres(covered.mean), 1e3 * still.mean_size,
                           correlated.same_scan
                               ? " <b>The scan in the garment is the one without it once more.</b>"
                               : "")),
      fmt::arg("lines", lines_of(correlated.fitted)), fmt::arg("thickness", 1e3 * correlated.thickness),
      fmt::arg("distances", distance_row("covered skin", covered) + distance_row("still skin", still)),
      fmt::arg("section", inspect::view_section(view)), fmt::arg("view", inspect::view_scripts(view)),
      fmt::arg("pictures", drawn), fmt::arg("rows", rows.table), fmt::arg("notes", rows.notes),
      fmt::arg("worn", html_escaped(correlated.worn.file)),
      fmt::arg("scan", html_escaped(correlated.fitted.scan)));
}

}  // namespace tensegric_fit::fit
