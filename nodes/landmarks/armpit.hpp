/// The roof of an armpit that the scan did not see, under the skin that fills it.
#pragma once

#include "landmarks/body_shape.hpp"

namespace tensegric_fit::landmarks {

struct ArmpitRoof {
  bool found = false;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< half way from front to back
  double depth = 0;                                  ///< metres, front to back
};

/// What a search for the roof looks at: sections that part arm and trunk.
struct FilledArmpit {
  const SlicedMesh& sliced;
  Eigen::Vector3d parting;  ///< where arm and trunk part, with the skin that fills the armpit
  double stature;
};

/// How high the roof begins. Above a filling, sensors see the front and the back of what joins arm and trunk;
/// it has its length there. Never below `parting`; `parting` where nothing tells.
double height_of_roof(const FilledArmpit& armpit);

/// Whether what joins arm and trunk has most of its length as soon as they join, which no filling has.
bool parting_is_roof(const FilledArmpit& armpit);

/// The roof at a height; `aside` metres along y from between the parting and, by two thirds, where what joins
/// arm and trunk is narrowest.
ArmpitRoof find_armpit_roof(const FilledArmpit& armpit, double height, double aside);

/// The lowest place of the roof, an arc from front to back over the arm: as the arm leans forward or
/// backward, it wanders from the middle towards the steep folds. `arm` is the way of the arm to the hand.
Eigen::Vector3d lowest_of_roof(const ArmpitRoof& roof, const Eigen::Vector3d& arm, double stature);

}  // namespace tensegric_fit::landmarks
