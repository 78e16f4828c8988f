/// Girths before and under the garment, and the size that they make.
#pragma once

#include <QTableWidget>

#include "geometry/moved_skin.hpp"

namespace tensegric_fit::inspect {

class GirthTable : public QTableWidget {
 public:
  GirthTable();
  void show_girths(std::vector<geometry::ChangedMeasure> girths);

 private:
  void set(int row, int column, const std::string& words);
};

}  // namespace tensegric_fit::inspect
