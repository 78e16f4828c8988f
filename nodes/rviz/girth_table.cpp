#include "rviz/girth_table.hpp"

#include <QHeaderView>
#include <algorithm>

#include "inspect/bra_size.hpp"
#include "inspect/panel_words.hpp"
#include "inspect/pointing.hpp"
#include "rviz/qt_text.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr int kRowHeight = 20;  // pixels
constexpr int kFewest = 6;      // rows that are always seen
const std::vector<std::string> kFirst{"bust", "underbust", "waist", "hip", "neck"};

using Girths = std::vector<geometry::ChangedMeasure>;

std::string size_of(const Girths& girths) {
  const auto find = [&](const char* name) {
    return std::find_if(girths.begin(), girths.end(),
                        [&](const auto& girth) { return girth.before.name == name; });
  };
  const auto bust = find("bust"), underbust = find("underbust");
  if (bust == girths.end() || underbust == girths.end()) return words::kNoSize;
  return words::sizes(inspect::bra_sizes(bust->before, underbust->before));
}

}  // namespace

GirthTable::GirthTable() : QTableWidget(0, 4) {
  setHorizontalHeaderLabels({words::kMeasure, words::kScanned, words::kWornGirth, words::kChange});
  verticalHeader()->hide();
  verticalHeader()->setDefaultSectionSize(kRowHeight);
  horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  horizontalHeader()->setSectionResizeMode(0, QHeaderView::ResizeToContents);  // names are read whole
  setEditTriggers(QAbstractItemView::NoEditTriggers);
  setSelectionMode(QAbstractItemView::NoSelection);
  setMinimumHeight((kFewest + 1) * kRowHeight);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Ignored);  // what is left on the panel
  setTabKeyNavigation(false);                                   // Tab goes on to the next part of the panel
}

void GirthTable::set(int row, int column, const std::string& words) {
  setItem(row, column, new QTableWidgetItem(text(words)));
}

void GirthTable::set_row(int row, const std::array<std::string, 4>& words) {
  for (int column = 0; column < 4; ++column) set(row, column, words[static_cast<std::size_t>(column)]);
}

void GirthTable::show_measures(const geometry::BodyMeasures& measures, const geometry::MovedSkin& skin,
                               bool is_worn) {
  Girths girths = geometry::girths_after(measures, skin);
  const auto place = [](const geometry::ChangedMeasure& girth) {
    return std::find(kFirst.begin(), kFirst.end(), girth.before.name) - kFirst.begin();
  };
  std::stable_sort(girths.begin(), girths.end(),
                   [&](const auto& one, const auto& other) { return place(one) < place(other); });
  std::vector<std::string> reasons;  // by row, of what is unsure
  const auto row_of = [&](const std::string& name, const geometry::ChangedMeasure& measure) {
    const bool unsure = measure.before.is_unsure();
    reasons.push_back(unsure ? measure.before.reason : "");
    const std::string shown = name + (unsure ? "*" : "");
    if (!is_worn) return std::array<std::string, 4>{shown, words::centimetres(measure.before.metres), "", ""};
    return std::array<std::string, 4>{shown, words::centimetres(measure.before.metres),
                                      measure.after ? words::centimetres(*measure.after) : words::kNoSize,
                                      measure.after ? words::change(measure.change()) : words::kNoSize};
  };
  std::vector<std::array<std::string, 4>> rows;
  for (const geometry::ChangedMeasure& height : geometry::heights_after(measures, skin))
    if (height.before.name == "bust" && height.after) {
      rows.push_back(
          {words::kLift, "", "", is_worn ? words::rise(*height.after - height.before.metres) : ""});
      reasons.emplace_back();
    }
  if (const auto apart = geometry::bust_points_apart(measures, skin))
    rows.push_back(row_of(words::kApart, *apart));
  // The size is of the body without a garment: what a garment squeezes has none.
  rows.push_back({words::kBraSize, size_of(girths), "", ""});
  reasons.emplace_back();
  for (const geometry::ChangedMeasure& girth : girths)
    rows.push_back(row_of(spoken(girth.before.name), girth));
  setRowCount(static_cast<int>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    set_row(static_cast<int>(i), rows[i]);
    item(static_cast<int>(i), 0)->setToolTip(text(reasons[i]));
  }
}

}  // namespace tensegric_fit::inspect
