/// Lines of a garment that lie on the body: polylines that control nodes carry.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

namespace tensegric_fit::geometry {

/// A point whose displacement from `rest` is the weighted sum of the control nodes' displacements.
struct CarriedPoint {
  Eigen::Vector3d rest;                         ///< m, scan frame
  std::vector<std::pair<int, double>> weights;  ///< node (outer i is i, inner i is V + i) and weight, by node
};

/// One thread of a band, and its share of the band's length.
struct Fibre {
  double share;
  std::vector<CarriedPoint> points;  ///< in order, two or more
};

/// All fibres of a line of that name; their shares sum to 1.
struct LaidLine {
  std::string name;
  std::vector<Fibre> fibres;
};

}  // namespace tensegric_fit::geometry
