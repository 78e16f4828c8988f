#include "rviz/body_scene.hpp"

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>

#include <limits>

#include "inspect/pointing.hpp"
#include "inspect/words.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr double kTape = 0.003, kModel = 0.0006, kEdge = 0.0015, kMember = 0.001,
                 kBand = 0.006;      // widths, metres
constexpr double kGap = 0.1;         // between two bodies, metres
constexpr double kMarkLift = 0.006;  // metres, towards the eye
constexpr Colour kMarkColour{20, 20, 20};

double blend_of(const Look& look) {
  return look.show == Show::before ? 0 : look.show == Show::blend ? look.blend : 1;
}

// Half of what two bodies side by side are apart, towards her left.
Eigen::Vector3d half_step(const BodyView& body, const Overlays& overlays) {
  const geometry::BodyMeasures* measures = overlays.measures(body);
  const Eigen::Vector3d left = measures != nullptr ? Eigen::Vector3d(measures->body_from_scan.linear().row(1))
                                                   : Eigen::Vector3d::UnitY();
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Eigen::Vector3d& vertex : body.mesh().vertices) {
    low = std::min(low, left.dot(vertex));
    high = std::max(high, left.dot(vertex));
  }
  return (high - low + kGap) / 2 * left;
}

void fill(OgreBody& drawn, const std::vector<Eigen::Vector3d>& vertices, const BodyView& body) {
  drawn.set_vertices(vertices, geometry::vertex_normals(vertices, body.mesh().triangles));
}

}  // namespace

BodyScene::BodyScene(Ogre::SceneManager* scene, Ogre::SceneNode* parent)
    : scene_(scene),
      node_(parent->createChildSceneNode()),
      before_(scene, parent),
      after_(scene, node_),
      landmarks_(scene, node_),
      mark_(scene, node_),
      girths_(scene, node_),
      model_(scene, node_),
      edges_(scene, node_),
      members_(scene, node_),
      lines_(scene, node_),
      ribbons_(scene, node_) {}

BodyScene::~BodyScene() = default;  // rviz removes the display's nodes

void BodyScene::take_triangles(const BodyView& body) {
  const geometry::TriangleMesh& mesh = body.mesh();
  for (OgreBody* drawn : {&before_, &after_}) drawn->set_triangles(mesh.triangles, mesh.vertices.size());
  fill(before_, mesh.vertices, body);
}

void BodyScene::draw(const BodyView& body, Overlays& overlays, const Look& look) {
  look_ = look;
  const double blend = blend_of(look);
  fill(after_, body.vertices(blend), body);
  const std::vector<double> values = body.values(look.colour_by, blend);
  scale_ = look.automatic_scale ? auto_scale(look.colour_by, values) : fixed_scale(look.colour_by);
  after_.set_colours(colours_of(scale_, values));
  for (OgreBody* drawn : {&before_, &after_}) drawn->set_opacity(look.opacity);

  const bool both = look.show == Show::side_by_side;
  const Eigen::Vector3d step = both ? half_step(body, overlays) : Eigen::Vector3d::Zero();
  before_.show(both);
  before_.set_place(-step);
  node_->setPosition(ogre(step));

  std::vector<NamedDot> dots;
  if (look.landmarks) dots = overlays.dots(body, blend);
  for (NamedDot& dot : dots) dot.name = spoken(dot.name);
  landmarks_.draw(dots, look.names);
  const std::vector<Stroke> none;
  girths_.draw(tubes(look.girths ? overlays.tapes(body, blend) : none, kTape / 2));
  model_.draw(tubes(look.model ? overlays.model(body, blend) : none, kModel / 2));
  edges_.draw(tubes(look.control_mesh ? overlays.edges(body, blend) : none, kEdge / 2));
  members_.draw(tubes(look.members ? overlays.members(body, blend) : none, kMember / 2));
  lines_.draw(tubes(look.lines ? overlays.lines(body, blend) : none, kBand / 2));
  ribbons_.draw(surface_of(look.lines ? overlays.ribbons(body, blend) : std::vector<Ribbon>{}));
  mark(nullptr, words::kPointedHelp);
}

void BodyScene::show(bool visible) {
  legend_.show(visible && look_.legend);
}

std::optional<Pointed> BodyScene::point_at(const Ogre::Ray& ray, const BodyView& body,
                                           Overlays& overlays) const {
  const auto local = [this](const Ogre::Vector3& world) {
    const Ogre::Vector3 v = node_->convertWorldToLocalPosition(world);
    return Eigen::Vector3d(v.x, v.y, v.z);
  };
  const double blend = blend_of(look_);
  const std::vector<Eigen::Vector3d> vertices = body.vertices(blend);
  const Eigen::Vector3d from = local(ray.getOrigin()), to = local(ray.getOrigin() + ray.getDirection());
  const auto hit = first_hit(vertices, body.mesh().triangles, from, to - from);
  if (!hit) return std::nullopt;

  const Eigen::Vector3d before_skin = hit->position - kMarkLift * (to - from).normalized();
  Pointed pointed{before_skin, hit->position, 0, "", 0};
  pointed.value = value_at(*hit, body.mesh().triangles, body.values(look_.colour_by, blend));
  if (const geometry::BodyMeasures* measures = overlays.measures(body))
    pointed.position = measures->body_from_scan * hit->position;
  pointed.distance = std::numeric_limits<double>::infinity();
  for (const NamedDot& dot : overlays.dots(body, blend)) {
    const double distance = (dot.position - hit->position).norm();
    if (distance >= pointed.distance) continue;
    pointed.distance = distance;
    pointed.landmark = spoken(dot.name);
  }
  return pointed;
}

void BodyScene::mark(const Eigen::Vector3d* place, const std::string& words) {
  std::vector<NamedDot> dots;
  if (place != nullptr) dots.push_back({*place, "", kMarkColour});
  mark_.draw(dots, false);
  legend_.set(scale_, words);
  show(true);
}

}  // namespace tensegric_fit::inspect
