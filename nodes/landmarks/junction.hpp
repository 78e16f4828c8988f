/// Where a limb grows out of the trunk, though the scan saw little of the place and filled it with skin.
#pragma once

#include <vector>

#include "landmarks/sliced_mesh.hpp"

namespace tensegric_fit::landmarks {

/// The narrowest place of a section between two lateral positions: material along x at `y`, from `back` to
/// `front`.
struct Bridge {
  double length = 0;  ///< metres of material; 0 where the section is in two parts
  double y = 0, back = 0, front = 0;
};

Bridge narrowest_bridge(const std::vector<Outline>& outlines, double low_y, double high_y);

struct Junction {
  double height;
  Bridge above;  ///< 5 mm above
};

/// Where to look for a junction, metres.
struct JunctionSearch {
  double low, high;      ///< heights
  double low_y, high_y;  ///< lateral positions that the bridge must cross
  double limb_depth;     ///< front to back, of the limb that joins
};

/// Going up, two parts grow together: the height at which the bridge between them lengthens most, to a good
/// part of the limb's depth. Skin that fills a gap makes a short bridge below it, and one that lengthens
/// slowly.
Junction find_junction(const SlicedMesh& body, const JunctionSearch& search);

/// Where a limb is one with the trunk.
struct Root {
  bool found = false;
  double height = 0;  ///< metres; the bridge has nine tenths of the length that it has `further_up`
};

/// Sensors see the bridge's two ends sooner than the hollow between them, so that its length is right soon
/// above a filling. `search.limb_depth` is not needed.
Root find_root(const SlicedMesh& body, const JunctionSearch& search, double further_up);

}  // namespace tensegric_fit::landmarks
