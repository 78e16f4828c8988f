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
  /// Lift and distance of the bust points, then girths.
  void show_measures(const geometry::BodyMeasures& measures, const geometry::MovedSkin& skin);

 private:
  void set_row(int row, const std::array<std::string, 4>& words);
  void set(int row, int column, const std::string& words);
};

}  // namespace tensegric_fit::inspect
