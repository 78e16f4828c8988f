/// A triangle mesh with changing vertices, smooth-shaded and lit.
#pragma once

#include <OgreHardwareVertexBuffer.h>
#include <OgreMaterial.h>
#include <OgreMesh.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "inspect/colours.hpp"

namespace Ogre {
class Entity;
class SceneManager;
class SceneNode;
}  // namespace Ogre

namespace tensegric_fit::inspect {

/// Triangles are sent to the graphics card once, vertices and colours into the same buffers again and again.
class OgreBody {
 public:
  OgreBody(Ogre::SceneManager* scene, Ogre::SceneNode* parent);
  ~OgreBody();
  OgreBody(const OgreBody&) = delete;
  OgreBody& operator=(const OgreBody&) = delete;

  /// \pre indices below `vertices`
  void set_triangles(const std::vector<Eigen::Vector3i>& triangles, std::size_t vertices);
  /// \pre one of each a vertex
  void set_vertices(const std::vector<Eigen::Vector3d>& positions,
                    const std::vector<Eigen::Vector3d>& normals);
  void set_colours(const std::vector<Colour>& colours);
  /// 1 opaque; below, only the outermost skin shows, and what is inside through it.
  void set_opacity(double opacity);
  /// Lit skin; nothing but its depth; the side of it that faces away, in its colours without light.
  enum class Finish { lit, depth_only, far_side };
  void set_finish(Finish finish);
  /// In that queue of Ogre's, of what is drawn there by rising `priority`. Until the next set_triangles.
  void draw_in(unsigned char queue, unsigned short priority);
  void show(bool visible);
  /// Only views with one of these bits show it. Until the next set_triangles.
  void show_to(std::uint32_t views);

 private:
  void clear();
  void upload_colours();

  Ogre::SceneManager* scene_;
  Ogre::SceneNode* node_;
  const std::string name_;
  Ogre::MaterialPtr material_;
  Ogre::MeshPtr mesh_;
  Ogre::Entity* entity_ = nullptr;
  Ogre::HardwareVertexBufferSharedPtr shape_, paint_;
  std::vector<Colour> colours_;
  double opacity_ = 1;
  Finish finish_ = Finish::lit;
};

}  // namespace tensegric_fit::inspect
