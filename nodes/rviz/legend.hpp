/// The scale of colours over the 3D view, in words and figures that a person reads.
#pragma once

#include <OgreMaterial.h>
#include <OgreTexture.h>

#include <QImage>
#include <string>

#include "inspect/colour_scale.hpp"

namespace Ogre {
class Overlay;
class PanelOverlayElement;
}  // namespace Ogre

namespace tensegric_fit::inspect {

/// The legend as a picture, with a sentence under it.
QImage legend_picture(const ColourScale& scale, const std::string& sentence);

/// Drawn over the lower left corner of every 3D view.
class Legend {
 public:
  Legend();
  ~Legend();
  Legend(const Legend&) = delete;
  Legend& operator=(const Legend&) = delete;

  void set(const ColourScale& scale, const std::string& sentence);
  void show(bool visible);

 private:
  const std::string name_;
  Ogre::Overlay* overlay_;
  Ogre::PanelOverlayElement* panel_;
  Ogre::MaterialPtr material_;
  Ogre::TexturePtr texture_;
};

}  // namespace tensegric_fit::inspect
