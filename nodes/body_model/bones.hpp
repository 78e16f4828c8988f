/// An assumed rib cage and pelvis: soft tissue ends at them.
///
/// No scan sees bones. These are what tests/body_model/bones.py assumes for women of this shape: below the
/// skin of their leanest twins, smooth under breasts and buttocks; the wall of the belly closes them in
/// front. Posed with the body.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "body_model/registered_body.hpp"
#include "geometry/surface_tree.hpp"

namespace tensegric_fit::body_model {

/// Tissue between bone and skin is never thinner, m: skin (Southwood 1955: 2 mm) and a thin layer below it.
inline constexpr double kThinnestTissue = 0.005;

/// A bone of every shape at rest, as the model's skin is.
struct BoneShape : Skinned {  // open above and below
  std::string name;           ///< rib_cage, pelvis
};

/// \throw Refusal broken_file: not there, another format, or contents that do not fit each other;
/// other_model: made for another model file
std::vector<BoneShape> load_bones(const std::string& path, const Model& model);

/// Those of the shipped model, loaded once. \throw Refusal as load_bones
const std::vector<BoneShape>& shipped_bones();

struct BoneSurface {
  std::string name;
  geometry::TriangleMesh mesh;  ///< m, in the body's frame
};

/// Under this body's skin everywhere, by kThinnestTissue at least: where the assumed bone would lie higher,
/// it is pressed down. \pre `shapes` were made for the body's model
std::vector<BoneSurface> bones_of(const RegisteredBody& body, const std::vector<BoneShape>& shapes);

/// Depth of soft tissue, for any number of questions.
class Tissue {
 public:
  /// `bones` must outlive it. \pre not empty
  explicit Tissue(const std::vector<BoneSurface>& bones);
  struct Depth {
    double distance;          ///< m, to the nearest bone
    Eigen::Vector3d on_bone;  ///< the point there
    int bone;                 ///< index into `bones`
  };
  /// Of a point on the skin, in the bones' frame.
  Depth depth(const Eigen::Vector3d& skin) const;

 private:
  std::deque<geometry::SurfaceTree> trees_;  // which cannot be moved
};

}  // namespace tensegric_fit::body_model
