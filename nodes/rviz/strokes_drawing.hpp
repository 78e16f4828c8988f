/// Lines and dots over a body.
#pragma once

#include <OgreColourValue.h>
#include <OgreVector.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "inspect/overlays.hpp"
#include "inspect/solid_lines.hpp"
#include "rviz/ogre_body.hpp"

namespace Ogre {
class SceneManager;
class SceneNode;
}  // namespace Ogre
namespace rviz {
class MovableText;
class PointCloud;
}  // namespace rviz

namespace tensegric_fit::inspect {

inline Ogre::Vector3 ogre(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

inline Ogre::ColourValue ogre(const Colour& colour) {
  return Ogre::ColourValue(colour[0] / 255.0F, colour[1] / 255.0F, colour[2] / 255.0F);
}

/// Lines as tubes and ribbons.
class SolidLinesDrawing {
 public:
  SolidLinesDrawing(Ogre::SceneManager* scene, Ogre::SceneNode* parent) : body_(scene, parent) {}
  void draw(const PaintedSurface& surface);

 private:
  OgreBody body_;
};

/// Dots with their names beside them.
class DotsDrawing {
 public:
  DotsDrawing(Ogre::SceneManager* scene, Ogre::SceneNode* parent);
  ~DotsDrawing();
  void draw(const std::vector<NamedDot>& dots, bool with_names);

 private:
  void forget_names();

  Ogre::SceneManager* scene_;
  Ogre::SceneNode* node_;
  std::unique_ptr<rviz::PointCloud> dots_;
  std::vector<std::unique_ptr<rviz::MovableText>> names_;
};

}  // namespace tensegric_fit::inspect
