/// Girths before and under the garment, and the size that they make.
#pragma once

#include <QTableWidget>
#include <array>
#include <string>

#include "geometry/moved_skin.hpp"

namespace tensegric_fit::inspect {

class GirthTable : public QTableWidget {
 public:
  GirthTable();
  /// Lift and distance of the bust points, then girths. Where nothing is worn, as they were scanned alone.
  void show_measures(const geometry::BodyMeasures& measures, const geometry::MovedSkin& skin, bool is_worn);

 private:
  void set_row(int row, const std::array<std::string, 4>& words);
  void set(int row, int column, const std::string& words);
};

}  // namespace tensegric_fit::inspect
