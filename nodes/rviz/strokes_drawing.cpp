#include "rviz/strokes_drawing.hpp"

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <rviz/ogre_helpers/movable_text.h>
#include <rviz/ogre_helpers/point_cloud.h>

namespace tensegric_fit::inspect {
namespace {

constexpr float kDot = 0.012F, kLetter = 0.02F;  // metres
constexpr Colour kInk{30, 30, 30};

}  // namespace

void SolidLinesDrawing::draw(const PaintedSurface& surface) {
  const geometry::TriangleMesh& mesh = surface.mesh;
  body_.show(!mesh.triangles.empty());
  if (mesh.triangles.empty()) return;
  body_.set_triangles(mesh.triangles, mesh.vertices.size());
  body_.set_vertices(mesh.vertices, surface.normals);
  body_.set_colours(surface.colours);
}

DotsDrawing::DotsDrawing(Ogre::SceneManager* scene, Ogre::SceneNode* parent)
    : scene_(scene), node_(parent->createChildSceneNode()), dots_(std::make_unique<rviz::PointCloud>()) {
  dots_->setRenderMode(rviz::PointCloud::RM_SPHERES);
  dots_->setDimensions(kDot, kDot, kDot);
  node_->attachObject(dots_.get());
}

DotsDrawing::~DotsDrawing() {
  forget_names();
  node_->detachAllObjects();
  scene_->destroySceneNode(node_);
}

void DotsDrawing::forget_names() {
  node_->removeAndDestroyAllChildren();
  names_.clear();
}

void DotsDrawing::draw(const std::vector<NamedDot>& dots, bool with_names) {
  dots_->clear();
  forget_names();
  if (dots.empty()) return;
  std::vector<rviz::PointCloud::Point> points(dots.size());
  for (std::size_t i = 0; i < dots.size(); ++i) {
    points[i].position = ogre(dots[i].position);
    points[i].color = ogre(dots[i].colour);
  }
  dots_->addPoints(points.data(), static_cast<std::uint32_t>(points.size()));
  if (!with_names) return;
  for (const NamedDot& dot : dots) {
    auto name = std::make_unique<rviz::MovableText>("   " + dot.name, "Liberation Sans", kLetter, ogre(kInk));
    name->setTextAlignment(rviz::MovableText::H_LEFT, rviz::MovableText::V_CENTER);
    node_->createChildSceneNode(ogre(dot.position))->attachObject(name.get());
    names_.push_back(std::move(name));
  }
}

}  // namespace tensegric_fit::inspect
