/// Measures of a body beside their truth, and what many bodies say of each measure.
#pragma once

#include <string>
#include <vector>

#include "geometry/body_measures.hpp"

namespace tensegric_fit::population {

/// One measure of one body. A girth's or height's error has its sign; a point's is its distance.
struct Error {
  std::string measure;  ///< "girth bust", "height hip", "point crotch", "control bust volume %"
  double millimetres;   ///< infinite where it was not measured; what counts or shares are called so
  double limit;         ///< ISO 20685: 9 for large girths, 4 for small ones and heights; points: 5 for bust
                        ///< points, else 10
  std::string cause = {};  ///< what the stage itself says: why it is uncertain of it or did not find it

  bool within() const;
};

/// All that the truth knows and that is measured on people. Without an inner minimum the waist is a
/// convention and is left out.
std::vector<Error> errors_of(const geometry::BodyMeasures& measured, const geometry::BodyMeasures& truth,
                             bool has_waist);

/// What all bodies say of one measure.
struct Row {
  std::string measure;
  double limit;
  int bodies = 0, within = 0, missing = 0;
  double mean = 0, interval = 0;   ///< of the errors found; half its 95 % confidence interval
  double median = 0, largest = 0;  ///< of their size
  int worst = 0;                   ///< seed of the largest or of a missing one
};

/// In the order in which measures appear; `seeds` has one a body.
std::vector<Row> summary(const std::vector<std::vector<Error>>& bodies, const std::vector<int>& seeds);

}  // namespace tensegric_fit::population
