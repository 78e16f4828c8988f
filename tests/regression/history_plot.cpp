#include "history_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tensegric_fit::regression {
namespace {

constexpr double kPanelWidth = 290, kPanelHeight = 190, kLeft = 44, kRight = 10, kTop = 24, kBottom = 32;
constexpr double kLeast = 1e-16;  // of what is shown as a power of ten
constexpr const char* kColours[] = {"#2b5c8a", "#d1802b", "#4a8f5c", "#7a5195"};

struct Curve {
  std::string name;
  std::vector<double> values;  // one an iterate
};

std::string text(double x, double y, const char* anchor, const std::string& words,
                 const char* colour = "#333") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n", x, y,
                     anchor, colour, words);
}

// One panel, `shift` to the right; the abscissa is the number of the iterate.
std::string panel(double shift, const std::string& title, const std::vector<Curve>& curves) {
  double low = INFINITY, high = -INFINITY;
  for (const Curve& curve : curves)
    for (const double value : curve.values) low = std::min(low, value), high = std::max(high, value);
  const double margin = std::max(0.05 * (high - low), 0.1);
  low -= margin, high += margin;
  const std::size_t count = curves.front().values.size();
  const double right = kPanelWidth - kRight, bottom = kPanelHeight - kBottom;
  const auto x = [&](std::size_t i) {
    return kLeft + (right - kLeft) * static_cast<double>(i) / static_cast<double>(count - 1);
  };
  const auto y = [&](double value) { return kTop + (bottom - kTop) * (high - value) / (high - low); };

  std::string svg =
      fmt::format("<g transform=\"translate({},0)\">\n", shift) + text(kLeft, 14, "start", title);
  for (const double value : {low + margin, high - margin}) {
    svg += fmt::format("<path d=\"M{} {:.1f}H{}\" stroke=\"#ddd\"/>\n", kLeft, y(value), right);
    svg += text(kLeft - 4, y(value) + 4, "end", fmt::format("{:.3g}", value));
  }
  svg += fmt::format("<path d=\"M{0} {1}V{2}H{3}\" fill=\"none\" stroke=\"#888\"/>\n", kLeft, kTop, bottom,
                     right);
  svg += text(kLeft, kPanelHeight - 18, "middle", "0") +
         text(right, kPanelHeight - 18, "end", std::to_string(count - 1)) +
         text((kLeft + right) / 2, kPanelHeight - 18, "middle", "iteration");
  double legend = kLeft;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const char* colour = kColours[c % std::size(kColours)];
    std::string points;
    for (std::size_t i = 0; i < count; ++i)
      points += fmt::format("{:.1f},{:.1f} ", x(i), y(curves[c].values[i]));
    svg += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>\n", points,
                       colour);
    svg += text(legend, kPanelHeight - 4, "start", curves[c].name, colour);
    legend += 12 + 6 * static_cast<double>(curves[c].name.size());
  }
  return svg + "</g>\n";
}

double power_of(double value) {
  return std::log10(std::max(kLeast, std::abs(value)));
}

}  // namespace

std::string history_plot(const std::vector<tensegric::Iterate>& history) {
  if (history.size() < 2) return "";
  std::vector<Curve> lengths, errors = {{"residual", {}}, {"volume", {}}};
  for (std::size_t line = 0; line < history[0].line_ratios.size(); ++line) {
    lengths.push_back({fmt::format("line {}", line + 1), {}});
    for (const tensegric::Iterate& iterate : history)
      lengths.back().values.push_back(100 * iterate.line_ratios[line]);
  }
  for (const tensegric::Iterate& iterate : history) {
    double volume = 0;
    for (const double error : iterate.volume_errors) volume = std::max(volume, std::abs(error));
    errors[0].values.push_back(power_of(iterate.residual));
    errors[1].values.push_back(power_of(volume));
  }
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" role=\"img\" aria-label=\"how the fit went\" "
      "style=\"background:white;max-width:100%;height:auto;font:11px sans-serif\">\n",
      2 * kPanelWidth, kPanelHeight);
  if (!lengths.empty()) svg += panel(0, "length of lines, % of rest", lengths);
  return svg + panel(kPanelWidth, "from balance, powers of ten", errors) + "</svg>\n";
}

}  // namespace tensegric_fit::regression
