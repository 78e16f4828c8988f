/// What is measured on a body beside what is known of it, figure by figure.
#pragma once

#include <string>
#include <vector>

#include "geometry/body_measures.hpp"
#include "virtual_body/virtual_body.hpp"

namespace tensegric_fit::population {

/// What is known of a body: landmarks in the frame of its scan, metres.
struct Truth {
  geometry::BodyMeasures measures;
  virtual_body::Doubts doubts;
};

/// One figure of one body, millimetres unless its name says otherwise.
struct Figure {
  std::string name;  ///< "girth bust", "height hip", "point crotch", "control bust volume %"
  double
      error;  ///< infinite where it was not measured; of a girth or height with its sign; a point's distance
  double limit;  ///< ISO 20685: 9 for large girths, 4 for the neck and heights; points: 5 for bust points,
                 ///< else 10
  bool counts =
      true;  ///< not one that the truth is vague about, that no sensor sees, or that is for information
  bool hidden = false;     ///< no sensor sees the place
  double confidence = -1;  ///< as the result says; negative: it says nothing
  double half_width = 0;   ///< of the 95 % interval as the result says; 0: it says nothing
  std::string cause = {};  ///< why the result is uncertain of it or lacks it

  bool within() const;
};

/// Every figure that the truth has and that is measured on people, found or not. A point's error is without
/// the direction along which the truth says that it is loose.
std::vector<Figure> figures_of(const geometry::BodyMeasures& measured, const Truth& truth);

}  // namespace tensegric_fit::population
