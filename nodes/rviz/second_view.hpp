/// A second view over rviz's own: the body before in the left part, the worn one in the right part.
#pragma once

#include <OgreMatrix4.h>
#include <OgreRay.h>
#include <OgreRenderTargetListener.h>

#include <QPoint>
#include <QPointer>
#include <cstdint>

#include <rviz/render_panel.h>

namespace Ogre {
class Camera;
class SceneManager;
class SceneNode;
class Viewport;
}  // namespace Ogre

namespace tensegric_fit::inspect {

/// Both parts are seen by the camera of rviz's view, so they turn and zoom alike, at one size.
class SecondView : public Ogre::RenderTargetListener {
 public:
  /// `left`, `right`: bits of what only that part shows.
  SecondView(Ogre::SceneManager* scene, rviz::RenderPanel* panel, std::uint32_t left, std::uint32_t right);
  ~SecondView() override;
  SecondView(const SecondView&) = delete;
  SecondView& operator=(const SecondView&) = delete;

  /// The right part begins at `share` of the width. `beside`: each part has the middle of the view in its own
  /// middle, as half the window would show it; else both show one picture, cut there. \pre 0 <= share <= 1
  void open(double share, bool beside);
  void close();
  bool is_open() const { return second_ != nullptr; }

  /// What a pixel of the panel shows: the ray in the scene's world, and whether it lies in the right part.
  struct Seen {
    Ogre::Ray ray;
    bool right;
  };
  Seen at(const QPoint& pixel) const;

  /// Called by Ogre before each picture. Public for that alone.
  void preRenderTargetUpdate(const Ogre::RenderTargetEvent& event) override;

 private:
  void follow();

  Ogre::SceneManager* scene_;
  QPointer<rviz::RenderPanel> panel_;  // rviz may delete it before its displays
  std::uint32_t left_, right_, usual_mask_ = 0;
  Ogre::SceneNode* node_;
  Ogre::Camera* camera_;
  Ogre::Viewport *second_ = nullptr, *border_ = nullptr;
  double share_ = 0.5;
  bool beside_ = false;
};

}  // namespace tensegric_fit::inspect
