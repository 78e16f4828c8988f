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
  setHorizontalHeaderLabels({words::kGirth, words::kScanned, words::kWornGirth, words::kChange});
  verticalHeader()->hide();
  verticalHeader()->setDefaultSectionSize(kRowHeight);
  horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  setEditTriggers(QAbstractItemView::NoEditTriggers);
  setSelectionMode(QAbstractItemView::NoSelection);
  setMinimumHeight((kFewest + 1) * kRowHeight);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Ignored);  // what is left on the panel
  setTabKeyNavigation(false);                                   // Tab goes on to the next part of the panel
}

void GirthTable::set(int row, int column, const std::string& words) {
  setItem(row, column, new QTableWidgetItem(text(words)));
}

void GirthTable::show_girths(Girths girths) {
  const auto place = [](const geometry::ChangedMeasure& girth) {
    return std::find(kFirst.begin(), kFirst.end(), girth.before.name) - kFirst.begin();
  };
  std::stable_sort(girths.begin(), girths.end(),
                   [&](const auto& one, const auto& other) { return place(one) < place(other); });
  setRowCount(static_cast<int>(girths.size()) + 1);
  int row = 0;
  set(row, 0, words::kBraSize);
  set(row, 1, size_of(girths));  // of the body without a garment: what a garment squeezes has no size
  for (const int column : {2, 3}) set(row, column, "");
  for (const geometry::ChangedMeasure& girth : girths) {
    ++row;
    set(row, 0, spoken(girth.before.name));
    set(row, 1, words::centimetres(girth.before.metres));
    set(row, 2, girth.after ? words::centimetres(*girth.after) : words::kNoSize);
    set(row, 3, girth.after ? words::change(girth.change()) : words::kNoSize);
  }
}

}  // namespace tensegric_fit::inspect
