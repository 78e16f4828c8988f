#include "ros/fit_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "files/html.hpp"

namespace tensegric_fit::node {
namespace {

using files::html_escaped;
using geometry::ChangedMeasure;

constexpr double kUnsure = 0.5;  // confidences below come with a reason

constexpr char kPage[] = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>{title}</title>
<style>
@page {{ size: A4; margin: 12mm }}
body {{ font: 10pt sans-serif; color: #333; max-width: 186mm; margin: 0 auto }}
h1 {{ font-size: 15pt; margin: 0 0 2mm }}
p {{ margin: 1mm 0 }}
main {{ display: flex; gap: 6mm; align-items: flex-start }}
table {{ border-collapse: collapse; flex: none }}
th, td {{ padding: .6mm 2mm; text-align: right; border-bottom: .2mm solid #ddd }}
th:first-child, td:first-child {{ text-align: left }}
figure {{ margin: 0 0 2mm; break-inside: avoid }}
img {{ width: 100% }}
figcaption, footer {{ font-size: 8pt; color: #666 }}
</style>
</head>
<body>
<h1>{title}</h1>
{summary}
<main>
<table>
<tr><th>cm</th><th>you</th><th>with it</th><th>change</th></tr>
{rows}</table>
<div>
{pictures}</div>
</main>
{notes}<footer>Scan {scan}. Made by tensegric_fit {version}. Measurements after ISO 8559-1; they are those of a scan, not of a medical device.</footer>
</body>
</html>
)";

/// "upper_arm_L" and "girth": left upper arm girth.
std::string words_of(std::string name, const std::string& kind) {
  std::string side;
  for (const auto& [ending, word] : {std::pair{"_L", "left "}, {"_R", "right "}}) {
    const std::size_t at = name.size() - std::min<std::size_t>(name.size(), 2);
    if (name.compare(at, 2, ending) != 0) continue;
    side = word;
    name.resize(at);
  }
  std::replace(name.begin(), name.end(), '_', ' ');
  return side + name + (name == "stature" ? "" : " " + kind);
}

std::string centimetres(double metres) {
  return fmt::format("{:.1f}", 100 * metres);
}

/// With a sign, and none where nothing is seen of it.
std::string change(double metres) {
  const double millimetres = std::round(1e3 * metres);
  return millimetres == 0 ? "0" : fmt::format("{:+.1f}", millimetres / 10);
}

std::string rows_of(const std::string& kind, const std::vector<ChangedMeasure>& measures) {
  std::string rows;
  for (const ChangedMeasure& measure : measures) {
    const double before = measure.before.metres;
    rows += fmt::format("<tr><td>{}{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        html_escaped(words_of(measure.before.name, kind)),
                        measure.before.confidence < kUnsure ? "*" : "", centimetres(before),
                        measure.after ? centimetres(*measure.after) : "",
                        measure.after ? change(measure.change()) : "");
  }
  return rows;
}

std::string summary_of(const FitFigures& figures) {
  std::string text;
  if (!figures.sizes.empty()) {
    text = "<p>Your bra size (EN 13402): <b>" + figures.sizes[0].label() + "</b>";
    if (figures.sizes.size() > 1)
      text += "; " + figures.sizes[1].label() + " may fit as well: you are between the two";
    text += ".</p>\n";
  }
  const FitState& fit = *figures.scan.fit;
  if (fit.status == FitState::INFEASIBLE)
    text += "<p>The garment cannot become as tight as was asked for; this is the nearest to it.</p>\n";
  else if (fit.status != FitState::CONVERGED)
    text += "<p>The computation did not come to its end: take these figures as a first impression.</p>\n";
  return text;
}

std::string notes_of(const FitFigures& figures) {
  std::string notes;
  for (const auto& [kind, measures] : {std::pair{"height", &figures.heights}, {"girth", &figures.girths}})
    for (const ChangedMeasure& measure : *measures)
      if (measure.before.confidence < kUnsure)
        notes +=
            fmt::format("<p>* {}: uncertain; {}.</p>\n", html_escaped(words_of(measure.before.name, kind)),
                        html_escaped(measure.before.reason));
  return notes;
}

}  // namespace

std::string fit_sheet(const FitFigures& figures, const std::vector<SheetPicture>& pictures) {
  std::string drawn;
  for (const SheetPicture& picture : pictures)
    drawn += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
        html_escaped(picture.caption), files::base64(picture.png.bytes));
  return fmt::format(kPage, fmt::arg("title", "Garment " + html_escaped(figures.scan.fit->garment)),
                     fmt::arg("summary", summary_of(figures)),
                     fmt::arg("rows", rows_of("girth", figures.girths) + rows_of("height", figures.heights)),
                     fmt::arg("pictures", drawn), fmt::arg("notes", notes_of(figures)),
                     fmt::arg("scan", html_escaped(figures.scan.body->scan_id)),
                     fmt::arg("version", TENSEGRIC_FIT_VERSION));
}

}  // namespace tensegric_fit::node
