/// A body and what is drawn over it, in Ogre.
#pragma once

#include <OgreRay.h>

#include <Eigen/Core>
#include <optional>
#include <string>

#include "inspect/body_view.hpp"
#include "inspect/overlays.hpp"
#include "rviz/ghost.hpp"
#include "rviz/legend.hpp"
#include "rviz/ogre_body.hpp"
#include "rviz/strokes_drawing.hpp"

namespace tensegric_fit::inspect {

enum class Show { after, before, side_by_side, blend, ghost, wipe };

/// What the display's properties ask for.
struct Look {
  Show show = Show::after;
  double blend = 1;  ///< for Show::blend: 0 before, 1 after; for Show::wipe how far right the border lies
  ColourBy colour_by = ColourBy::distortion;
  bool automatic_scale = false, legend = true;
  double opacity = 1;
  bool landmarks = true, names = false, girths = true, model = false, control_mesh = false, members = false,
       lines = true;
  bool pale = false;  ///< what is shown is of an earlier scan: all of it nearly as the background
};

/// What someone pointed at: a place for a mark, in the scan's frame, and the position on the skin of the body
/// as it is shown, in the body frame where that is known.
struct Pointed {
  Eigen::Vector3d place, position;
  double value;
  std::string landmark;  ///< the nearest, empty where there is none
  double distance = 0;   ///< to it, metres
};

class BodyScene {
 public:
  /// Before and worn in two parts of the view: `before` and `worn` are the bits of views of one part.
  struct Parts {
    std::uint32_t before, worn;
  };

  BodyScene(Ogre::SceneManager* scene, Ogre::SceneNode* parent, Parts parts);
  ~BodyScene();

  /// \pre before draw, whenever the view has taken a body
  void take_triangles(const BodyView& body);
  /// `unheld`: vertices of skin that the garment does not reach or hold.
  void draw(const BodyView& body, Overlays& overlays, const std::vector<int>& unheld, const Look& look);
  /// The legend with the rest: it lies over the view, not in the scene.
  void show(bool visible);

  /// The ray is in the scene's world; it meets the body before where that is asked for, else the one under
  /// the garment or the only one shown.
  std::optional<Pointed> point_at(const Ogre::Ray& ray, bool before, const BodyView& body,
                                  Overlays& overlays) const;
  /// A dot there, and words in the legend, until the next drawing; null: none.
  void mark(const Eigen::Vector3d* place, const std::string& words);

 private:
  Ogre::SceneNode* node_;
  const Parts parts_;
  OgreBody before_, after_;
  Ghost ghost_;
  DotsDrawing landmarks_, mark_;
  SolidLinesDrawing girths_, model_, edges_, members_, lines_, ribbons_;
  Legend legend_;
  Look look_;
  ColourScale scale_ = fixed_scale(ColourBy::plain);
};

}  // namespace tensegric_fit::inspect
