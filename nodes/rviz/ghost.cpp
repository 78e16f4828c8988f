#include "rviz/ghost.hpp"

#include <OgreRenderSystem.h>
#include <OgreRoot.h>
#include <OgreSceneManager.h>

namespace tensegric_fit::inspect {
namespace {

constexpr double kOpacity = 0.4;
constexpr double kOutline = 0.002;  // m
constexpr Colour kGhostColour{120, 150, 190}, kOutlineColour{30, 60, 110};
constexpr Ogre::uint8 kQueue = Ogre::RENDER_QUEUE_9;  // after all bodies

}  // namespace

Ghost::Ghost(Ogre::SceneManager* scene, Ogre::SceneNode* parent)
    : scene_(scene), skin_(scene, parent), mask_(scene, parent), outline_(scene, parent) {
  skin_.set_opacity(kOpacity);
  mask_.set_finish(OgreBody::Finish::depth_only);
  outline_.set_finish(OgreBody::Finish::far_side);
  scene_->addRenderQueueListener(this);
}

Ghost::~Ghost() {
  scene_->removeRenderQueueListener(this);
}

void Ghost::set_body(const std::vector<Eigen::Vector3i>& triangles,
                     const std::vector<Eigen::Vector3d>& vertices,
                     const std::vector<Eigen::Vector3d>& normals) {
  for (OgreBody* body : {&skin_, &mask_, &outline_}) body->set_triangles(triangles, vertices.size());
  skin_.set_vertices(vertices, normals);
  mask_.set_vertices(vertices, normals);
  std::vector<Eigen::Vector3d> around(vertices);
  for (std::size_t v = 0; v < around.size(); ++v) around[v] += kOutline * normals[v];
  outline_.set_vertices(around, normals);
  skin_.set_colours(std::vector<Colour>(vertices.size(), kGhostColour));
  outline_.set_colours(std::vector<Colour>(vertices.size(), kOutlineColour));
  mask_.draw_in(kQueue, 1);
  outline_.draw_in(kQueue, 2);
}

void Ghost::show(bool visible) {
  visible_ = visible;
  for (OgreBody* body : {&skin_, &mask_, &outline_}) body->show(visible);
}

void Ghost::renderQueueStarted(Ogre::uint8 queue, const Ogre::String&, bool&) {
  if (visible_ && queue == kQueue)
    Ogre::Root::getSingleton().getRenderSystem()->clearFrameBuffer(Ogre::FBT_DEPTH);
}

}  // namespace tensegric_fit::inspect
