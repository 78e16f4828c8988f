#include "totals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace tensegric_fit::population {
namespace {

constexpr double kSure = 0.5;
constexpr std::size_t kWorst = 3;

struct Of {
  const Figure* figure;
  const std::string* body;
};

Row row_of(const std::string& name, std::vector<Of> figures) {
  Row row;
  row.figure = name;
  if (!figures.empty()) row.limit = figures.front().figure->limit;
  double sum = 0, squares = 0;
  for (const auto& [figure, body] : figures) {
    ++row.bodies;
    row.within += figure->within();
    if (figure->confidence >= kSure) {
      ++row.sure;
      row.sure_out += !figure->within();
    }
    if (!std::isfinite(figure->error)) {
      ++row.missing;
      continue;
    }
    sum += figure->error;
    squares += figure->error * figure->error;
    if (figure->half_width <= 0) continue;
    ++row.stated;
    row.covered += std::abs(figure->error) <= figure->half_width;
  }
  const int found = row.bodies - row.missing;
  if (found > 0) {
    row.bias = sum / found;
    row.deviation = std::sqrt(std::max(0.0, squares / found - row.bias * row.bias));
  }
  std::stable_sort(figures.begin(), figures.end(), [](const Of& a, const Of& b) {
    return std::abs(a.figure->error) > std::abs(b.figure->error);
  });
  for (std::size_t i = 0; i < std::min(kWorst, figures.size()); ++i)
    row.worst.push_back(fmt::format("{} {:+.1f}", *figures[i].body, figures[i].figure->error));
  return row;
}

std::string share(int part, int of) {
  return of > 0 ? fmt::format("{:.1f} % of {}", 100.0 * part / of, of) : "none";
}

constexpr char kColumns[] = "{:<25}{:>6}{:>5}{:>9}{:>8}{:>7}{:>12}{:>8}{:>11}{:>6}{:>9}  {}\n";

std::string line_of(const Row& row, bool names) {
  const auto percent = [](int part, int of) {
    return of > 0 ? fmt::format("{:.0f}", 100.0 * part / of) : "-";
  };
  std::string worst;
  for (const std::string& body : row.worst) worst += (worst.empty() ? "" : ", ") + body;
  return fmt::format(kColumns, row.counts ? row.figure : "(" + row.figure + ")", row.limit, row.bodies,
                     percent(row.within, row.bodies), fmt::format("{:.2f}", row.bias),
                     fmt::format("{:.2f}", row.deviation), percent(row.covered, row.stated),
                     percent(row.sure, row.bodies), row.sure_out, row.left_out, row.missing,
                     names ? worst : "");
}

}  // namespace

std::vector<Row> rows_of(const std::vector<Score>& scores) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<Of>> counting, others;
  for (const Score& score : scores)
    for (const Figure& figure : score.figures) {
      if (counting.count(figure.name) + others.count(figure.name) == 0) order.push_back(figure.name);
      (figure.counts ? counting : others)[figure.name].push_back({&figure, &score.body});
    }
  std::vector<Row> rows;
  for (const std::string& name : order) {
    const bool counts = counting.count(name) > 0;
    rows.push_back(row_of(name, (counts ? counting : others)[name]));
    rows.back().counts = counts;
    rows.back().left_out = others.count(name) > 0 ? static_cast<int>(others[name].size()) : 0;
  }
  return rows;
}

Total total_of(const std::vector<Score>& scores) {
  std::vector<Of> counting, hidden;
  Total total;
  for (const Score& score : scores) {
    total.refused += !score.refusal.empty();
    for (const Figure& figure : score.figures) {
      if (figure.counts) counting.push_back({&figure, &score.body});
      if (figure.hidden) hidden.push_back({&figure, &score.body});
    }
  }
  total.all = row_of("all", std::move(counting));
  total.hidden = row_of("hidden", std::move(hidden));
  return total;
}

std::string table(const std::string& family, const std::vector<Score>& scores, bool names) {
  std::string text =
      fmt::format("\n{}: {} bodies; figures in brackets do not count\n", family, scores.size());
  text += fmt::format(kColumns, "figure, mm", "limit", "n", "within %", "bias", "sd", "covered %", "sure %",
                      "sure, out", "left", "missing", names ? "worst" : "");
  for (const Row& row : rows_of(scores)) text += line_of(row, names);
  const Total total = total_of(scores);
  const Row &all = total.all, &hidden = total.hidden;
  text +=
      fmt::format("within limits: {}; refused bodies: {}\n", share(all.within, all.bodies), total.refused);
  text += fmt::format("confidence of 0.5 or more: {}; of these out of limits: {}\n",
                      share(all.sure, all.bodies), share(all.sure_out, all.sure));
  text += fmt::format("covered by its 95 % interval: {}\n", share(all.covered, all.stated));
  text += fmt::format(
      "hidden figures, apart: within limits {}; confidence of 0.5 or more: {}, of these out of limits {}\n",
      share(hidden.within, hidden.bodies), share(hidden.sure, hidden.bodies),
      share(hidden.sure_out, hidden.sure));
  return text;
}

}  // namespace tensegric_fit::population
