#include "rviz/body_scene.hpp"

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>

#include <limits>

#include "geometry/shading_normals.hpp"
#include "inspect/pointing.hpp"
#include "inspect/words.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr double kTape = 0.003, kModel = 0.0006, kEdge = 0.0015, kMember = 0.001,
                 kBand = 0.006;      // widths, metres
constexpr double kMarkLift = 0.006;  // metres, towards the eye
constexpr Colour kMarkColour{20, 20, 20};

double blend_of(const Look& look) {
  return look.show == Show::before ? 0 : look.show == Show::blend ? look.blend : 1;
}

constexpr std::uint32_t kAllViews = 0xFFFFFFFF;
constexpr Colour kPaper{238, 240, 243};
constexpr double kPaleness = 0.65;

bool is_in_parts(const Look& look) {
  return look.show == Show::side_by_side || look.show == Show::wipe;
}

// All that hangs below it.
void show_to(std::uint32_t views, Ogre::SceneNode* node) {
  for (unsigned short i = 0; i < node->numAttachedObjects(); ++i)
    node->getAttachedObject(i)->setVisibilityFlags(views);
  for (Ogre::Node* child : node->getChildren()) show_to(views, static_cast<Ogre::SceneNode*>(child));
}

}  // namespace

BodyScene::BodyScene(Ogre::SceneManager* scene, Ogre::SceneNode* parent, Parts parts)
    : node_(parent->createChildSceneNode()),
      parts_(parts),
      before_(scene, parent),
      after_(scene, node_),
      ghost_(scene, parent),
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
  before_.show_to(parts_.before);
  const std::vector<Eigen::Vector3d> normals = geometry::shading_normals(mesh.vertices, mesh.triangles);
  before_.set_vertices(mesh.vertices, normals);
  ghost_.set_body(mesh.triangles, mesh.vertices, normals);
}

void BodyScene::draw(const BodyView& body, Overlays& overlays, const std::vector<int>& unheld,
                     const Look& look) {
  look_ = look;
  const double blend = blend_of(look);
  const std::vector<Eigen::Vector3d> vertices = body.vertices(blend);
  after_.set_vertices(vertices, geometry::shading_normals(vertices, body.mesh().triangles));
  const std::vector<double> values = body.values(look.colour_by, blend);
  scale_ = look.automatic_scale ? auto_scale(look.colour_by, values) : fixed_scale(look.colour_by);
  const auto shown = [&look](std::vector<Colour> colours) {
    if (look.pale)
      for (Colour& colour : colours) colour = mixed(colour, kPaper, kPaleness);
    return colours;
  };
  std::vector<Colour> colours = colours_of(scale_, values);
  if (look.colour_by == ColourBy::distortion && blend > 0) colours = with_unheld(std::move(colours), unheld);
  after_.set_colours(shown(std::move(colours)));
  before_.set_colours(shown(std::vector<Colour>(vertices.size(), kNeutral)));
  for (OgreBody* drawn : {&before_, &after_}) drawn->set_opacity(look.opacity);
  before_.show(is_in_parts(look));
  ghost_.show(look.show == Show::ghost && body.is_worn());

  std::vector<NamedDot> dots;
  if (look.landmarks) dots = overlays.dots(body, blend);
  for (NamedDot& dot : dots) {
    dot.name = spoken(dot.name);
    if (look.pale) dot.colour = mixed(dot.colour, kPaper, kPaleness);
  }
  landmarks_.draw(dots, look.names);
  const std::vector<Stroke> none;
  const auto painted = [&shown](PaintedSurface surface) {
    surface.colours = shown(std::move(surface.colours));
    return surface;
  };
  girths_.draw(painted(tubes(look.girths ? overlays.tapes(body, blend) : none, kTape / 2)));
  model_.draw(painted(tubes(look.model ? overlays.model(body, blend) : none, kModel / 2)));
  edges_.draw(painted(tubes(look.control_mesh ? overlays.edges(body, blend) : none, kEdge / 2)));
  members_.draw(painted(tubes(look.members ? overlays.members(body, blend) : none, kMember / 2)));
  lines_.draw(painted(tubes(look.lines ? overlays.lines(body, blend) : none, kBand / 2)));
  ribbons_.draw(painted(surface_of(look.lines ? overlays.ribbons(body, blend) : std::vector<Ribbon>{})));
  show_to(is_in_parts(look) ? parts_.worn : kAllViews, node_);
  mark(nullptr, words::kPointedHelp);
}

void BodyScene::show(bool visible) {
  legend_.show(visible && look_.legend);
}

std::optional<Pointed> BodyScene::point_at(const Ogre::Ray& ray, bool before, const BodyView& body,
                                           Overlays& overlays) const {
  const auto local = [this](const Ogre::Vector3& world) {
    const Ogre::Vector3 v = node_->convertWorldToLocalPosition(world);
    return Eigen::Vector3d(v.x, v.y, v.z);
  };
  const double blend = before ? 0 : blend_of(look_);
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
