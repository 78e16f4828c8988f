/// A body half transparent with its outline: where the worn one was before.
#pragma once

#include <OgreRenderQueueListener.h>

#include <Eigen/Core>
#include <vector>

#include "rviz/ogre_body.hpp"

namespace tensegric_fit::inspect {

/// The skin shows where it lies over that of other bodies; the outline is seen through them.
class Ghost : public Ogre::RenderQueueListener {
 public:
  Ghost(Ogre::SceneManager* scene, Ogre::SceneNode* parent);
  ~Ghost() override;

  /// \pre one normal per vertex
  void set_body(const std::vector<Eigen::Vector3i>& triangles, const std::vector<Eigen::Vector3d>& vertices,
                const std::vector<Eigen::Vector3d>& normals);
  void show(bool visible);

  /// Called by Ogre: the outline forgets how far away all else is.
  void renderQueueStarted(Ogre::uint8 queue, const Ogre::String& invocation, bool& skip) override;

 private:
  Ogre::SceneManager* scene_;
  OgreBody skin_, mask_, outline_;
  bool visible_ = false;
};

}  // namespace tensegric_fit::inspect
