#include "rviz/ogre_body.hpp"

#include <OgreEntity.h>
#include <OgreHardwareBufferManager.h>
#include <OgreMaterialManager.h>
#include <OgreMeshManager.h>
#include <OgreResourceGroupManager.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreSubMesh.h>
#include <OgreTechnique.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tensegric_fit::inspect {
namespace {

constexpr float kSheen = 0.08F;  // highlight, small enough to leave the colours readable

std::string next_body_name() {
  static int count = 0;
  return "tensegric_fit_body_" + std::to_string(count++);
}

// A transparent body fills the depth buffer first: only its outermost skin is drawn.
void set_passes(Ogre::Technique* technique, bool transparent, OgreBody::Finish finish) {
  technique->removeAllPasses();
  if (finish != OgreBody::Finish::lit) {
    Ogre::Pass* pass = technique->createPass();
    pass->setLightingEnabled(false);
    pass->setColourWriteEnabled(finish == OgreBody::Finish::far_side);
    if (finish == OgreBody::Finish::far_side) pass->setCullingMode(Ogre::CULL_ANTICLOCKWISE);
    return;
  }
  if (transparent) {
    Ogre::Pass* depth = technique->createPass();
    depth->setColourWriteEnabled(false);
    depth->setLightingEnabled(false);
    depth->setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);  // Ogre takes the first pass for the whole
  }
  Ogre::Pass* paint = technique->createPass();
  paint->setLightingEnabled(true);
  paint->setShadingMode(Ogre::SO_GOURAUD);
  paint->setVertexColourTracking(Ogre::TVC_AMBIENT | Ogre::TVC_DIFFUSE);
  paint->setSpecular(kSheen, kSheen, kSheen, 1);
  paint->setShininess(20);
  if (transparent) paint->setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
}

template <typename Value>
void write(const Ogre::HardwareVertexBufferSharedPtr& buffer, const std::vector<Value>& values) {
  buffer->writeData(0, values.size() * sizeof(Value), values.data(), true);
}

}  // namespace

OgreBody::OgreBody(Ogre::SceneManager* scene, Ogre::SceneNode* parent)
    : scene_(scene),
      node_(parent->createChildSceneNode()),
      name_(next_body_name()),
      material_(Ogre::MaterialManager::getSingleton().create(name_, Ogre::RGN_DEFAULT)) {
  material_->setReceiveShadows(false);
  set_passes(material_->getTechnique(0), false, finish_);
}

OgreBody::~OgreBody() {
  clear();
  scene_->destroySceneNode(node_);
  Ogre::MaterialManager::getSingleton().remove(material_);
}

void OgreBody::clear() {
  if (entity_ != nullptr) scene_->destroyEntity(entity_);
  entity_ = nullptr;
  if (mesh_) Ogre::MeshManager::getSingleton().remove(mesh_);
  mesh_.reset();
}

void OgreBody::set_triangles(const std::vector<Eigen::Vector3i>& triangles, std::size_t vertices) {
  clear();
  mesh_ = Ogre::MeshManager::getSingleton().createManual(name_, Ogre::RGN_DEFAULT);
  mesh_->sharedVertexData = new Ogre::VertexData();  // Ogre deletes it with the mesh
  mesh_->sharedVertexData->vertexCount = vertices;

  Ogre::VertexDeclaration* layout = mesh_->sharedVertexData->vertexDeclaration;
  const std::size_t vector = Ogre::VertexElement::getTypeSize(Ogre::VET_FLOAT3);
  layout->addElement(0, 0, Ogre::VET_FLOAT3, Ogre::VES_POSITION);
  layout->addElement(0, vector, Ogre::VET_FLOAT3, Ogre::VES_NORMAL);
  layout->addElement(1, 0, Ogre::VET_COLOUR_ABGR, Ogre::VES_DIFFUSE);
  auto& buffers = Ogre::HardwareBufferManager::getSingleton();
  const auto often = Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY_DISCARDABLE;
  shape_ = buffers.createVertexBuffer(2 * vector, vertices, often);
  paint_ = buffers.createVertexBuffer(sizeof(std::uint32_t), vertices, often);
  mesh_->sharedVertexData->vertexBufferBinding->setBinding(0, shape_);
  mesh_->sharedVertexData->vertexBufferBinding->setBinding(1, paint_);

  std::vector<std::uint32_t> corners;
  for (const Eigen::Vector3i& triangle : triangles)
    for (int corner = 0; corner < 3; ++corner)
      corners.push_back(static_cast<std::uint32_t>(triangle[corner]));
  Ogre::SubMesh* part = mesh_->createSubMesh();
  part->useSharedVertices = true;
  part->indexData->indexCount = corners.size();
  part->indexData->indexBuffer = buffers.createIndexBuffer(
      Ogre::HardwareIndexBuffer::IT_32BIT, corners.size(), Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
  part->indexData->indexBuffer->writeData(0, corners.size() * sizeof(std::uint32_t), corners.data(), true);
  mesh_->_setBounds(Ogre::AxisAlignedBox::BOX_INFINITE);  // bodies move: always drawn
  mesh_->load();
  colours_.assign(vertices, kNeutral);
  upload_colours();

  entity_ = scene_->createEntity(name_, name_, Ogre::RGN_DEFAULT);
  entity_->setMaterial(material_);
  entity_->setCastShadows(false);
  node_->attachObject(entity_);
}

void OgreBody::set_vertices(const std::vector<Eigen::Vector3d>& positions,
                            const std::vector<Eigen::Vector3d>& normals) {
  std::vector<float> values;
  values.reserve(6 * positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<float>(positions[v][axis]));
    for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<float>(normals[v][axis]));
  }
  write(shape_, values);
}

void OgreBody::set_colours(const std::vector<Colour>& colours) {
  colours_ = colours;
  upload_colours();
}

void OgreBody::upload_colours() {
  const auto opacity = static_cast<std::uint32_t>(std::lround(255 * opacity_));
  std::vector<std::uint32_t> values;
  values.reserve(colours_.size());
  for (const Colour& c : colours_)
    values.push_back(opacity << 24 | std::uint32_t{c[2]} << 16 | std::uint32_t{c[1]} << 8 | c[0]);
  write(paint_, values);
}

void OgreBody::set_opacity(double opacity) {
  if (opacity == opacity_) return;
  if ((opacity < 1) != (opacity_ < 1)) set_passes(material_->getTechnique(0), opacity < 1, finish_);
  opacity_ = opacity;
  if (mesh_) upload_colours();
}

void OgreBody::set_finish(Finish finish) {
  finish_ = finish;
  set_passes(material_->getTechnique(0), opacity_ < 1, finish_);
}

void OgreBody::draw_in(unsigned char queue, unsigned short priority) {
  if (entity_ != nullptr) entity_->setRenderQueueGroupAndPriority(queue, priority);
}

void OgreBody::show_to(std::uint32_t views) {
  if (entity_ != nullptr) entity_->setVisibilityFlags(views);
}

void OgreBody::show(bool visible) {
  node_->setVisible(visible);
}

}  // namespace tensegric_fit::inspect
