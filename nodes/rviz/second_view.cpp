#include "rviz/second_view.hpp"

#include <OgreCamera.h>
#include <OgreRenderWindow.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreViewport.h>

#include <algorithm>
#include <string>

namespace tensegric_fit::inspect {
namespace {

constexpr int kSecond = 7, kBorder = 8;  // order of drawing; rviz's own view is 0
constexpr float kBorderWidth = 0.002F;   // share of the window
constexpr double kNarrowest = 0.002;     // Ogre takes no empty view

std::string next_view_name() {
  static int count = 0;
  return "tensegric_fit_second_view_" + std::to_string(count++);
}

// The picture moved to the right by that share of half its width.
Ogre::Matrix4 moved(Ogre::Matrix4 projection, float share) {
  for (int column = 0; column < 4; ++column) projection[0][column] += share * projection[3][column];
  return projection;
}

// Of the whole picture the part that begins at `share` of its width.
Ogre::Matrix4 part_from(Ogre::Matrix4 projection, float share) {
  projection = moved(projection, -share);
  for (int column = 0; column < 4; ++column) projection[0][column] /= 1 - share;
  return projection;
}

}  // namespace

SecondView::SecondView(Ogre::SceneManager* scene, rviz::RenderPanel* panel, std::uint32_t left,
                       std::uint32_t right)
    : scene_(scene),
      panel_(panel),
      left_(left),
      right_(right),
      node_(scene->getRootSceneNode()->createChildSceneNode()),
      camera_(scene->createCamera(next_view_name())) {
  node_->attachObject(camera_);
}

SecondView::~SecondView() {
  close();
  scene_->destroyCamera(camera_);
  scene_->destroySceneNode(node_);
}

void SecondView::open(double share, bool beside) {
  if (!panel_ || panel_->getViewport() == nullptr) return;
  share_ = std::clamp(share, kNarrowest, 1 - kNarrowest);
  beside_ = beside;
  Ogre::RenderWindow* window = panel_->getRenderWindow();
  if (second_ == nullptr) {
    usual_mask_ = panel_->getViewport()->getVisibilityMask();
    second_ = window->addViewport(camera_, kSecond);
    border_ = window->addViewport(camera_, kBorder);
    border_->setVisibilityMask(0);
    border_->setOverlaysEnabled(false);
    border_->setBackgroundColour(Ogre::ColourValue(0.45F, 0.47F, 0.5F));
    panel_->getViewport()->setVisibilityMask((usual_mask_ | left_) & ~right_);
    second_->setVisibilityMask((usual_mask_ | right_) & ~left_);
    window->addListener(this);
  }
  const auto from = static_cast<float>(share_);
  second_->setDimensions(from, 0, 1 - from, 1);
  border_->setDimensions(std::max(0.0F, from - kBorderWidth / 2), 0, kBorderWidth, 1);
  // The scale of colours stands in the wider part.
  panel_->getViewport()->setOverlaysEnabled(share_ >= 0.5);
  second_->setOverlaysEnabled(share_ < 0.5);
  follow();
}

void SecondView::close() {
  if (second_ == nullptr) return;
  second_ = border_ = nullptr;
  if (!panel_) return;  // its window is gone, and the views with it
  panel_->getRenderWindow()->removeListener(this);
  panel_->getRenderWindow()->removeViewport(kSecond);
  panel_->getRenderWindow()->removeViewport(kBorder);
  panel_->getViewport()->setVisibilityMask(usual_mask_);
  panel_->getViewport()->setOverlaysEnabled(true);
  panel_->getViewport()->getCamera()->setCustomProjectionMatrix(false);
}

void SecondView::preRenderTargetUpdate(const Ogre::RenderTargetEvent&) {
  follow();
}

void SecondView::follow() {
  if (second_ == nullptr || !panel_) return;
  Ogre::Camera* main = panel_->getViewport()->getCamera();
  if (main == nullptr) return;
  main->setCustomProjectionMatrix(false);
  const Ogre::Matrix4 whole = main->getProjectionMatrix();
  const auto from = static_cast<float>(share_);
  if (beside_) main->setCustomProjectionMatrix(true, moved(whole, from - 1));
  camera_->setCustomProjectionMatrix(true, part_from(beside_ ? moved(whole, from) : whole, from));
  node_->setPosition(main->getDerivedPosition());
  node_->setOrientation(main->getDerivedOrientation());
  second_->setBackgroundColour(panel_->getViewport()->getBackgroundColour());
}

SecondView::Seen SecondView::at(const QPoint& pixel) const {
  const float x = static_cast<float>(pixel.x()) / static_cast<float>(panel_->width()),
              y = static_cast<float>(pixel.y()) / static_cast<float>(panel_->height());
  const auto from = static_cast<float>(share_);
  if (second_ != nullptr && x > from)
    return {camera_->getCameraToViewportRay((x - from) / (1 - from), y), true};
  return {panel_->getViewport()->getCamera()->getCameraToViewportRay(x, y), false};
}

}  // namespace tensegric_fit::inspect
