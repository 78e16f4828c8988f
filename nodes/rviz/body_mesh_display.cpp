#include "rviz/body_mesh_display.hpp"

#include <OgreSceneNode.h>
#include <rviz/bit_allocator.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/ros_topic_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_manager.h>

#include <QMouseEvent>
#include <pluginlib/class_list_macros.hpp>

#include "geometry/fit_warning.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/status.hpp"
#include "inspect/words.hpp"
#include "ros/body_messages.hpp"
#include "ros/flat.hpp"
#include "ros/held_scan.hpp"
#include "ros/model_skin_message.hpp"
#include "rviz/qt_text.hpp"

namespace tensegric_fit::inspect {
namespace {

using rviz::StatusProperty;

constexpr int kStill = 3;  // pixels that a click may move

// Fibre after fibre, as many points on each. \throw Refusal as points_in; bad_mesh: they do not divide
std::vector<std::vector<Eigen::Vector3d>> fibres_in(const std::vector<float>& values, std::uint32_t fibres) {
  const std::vector<Eigen::Vector3d> points = node::points_in(values);
  if (fibres == 0 || points.size() % fibres != 0)
    throw geometry::Refusal(geometry::refusal::kBadMesh, "a band's points do not divide into its fibres");
  const std::size_t count = points.size() / fibres;
  std::vector<std::vector<Eigen::Vector3d>> divided;
  for (auto from = points.begin(); from != points.end(); from += static_cast<long>(count))
    divided.emplace_back(from, from + static_cast<long>(count));
  return divided;
}

}  // namespace

BodyMeshDisplay::BodyMeshDisplay()
    : properties_(std::make_unique<LookProperties>(this, this, SLOT(change_topics()), SLOT(change_look()))) {}

// Qt takes the event filter back itself; rviz may have deleted its render panel before its displays.
BodyMeshDisplay::~BodyMeshDisplay() {
  if (context_ != nullptr) context_->visibilityBits()->freeBits(parts_.before | parts_.worn);
}

void BodyMeshDisplay::onInitialize() {
  parts_ = {context_->visibilityBits()->allocBit(), context_->visibilityBits()->allocBit()};
  make_scene();
  rviz::RenderPanel* panel = context_->getViewManager()->getRenderPanel();
  second_ = std::make_unique<SecondView>(scene_manager_, panel, parts_.before, parts_.worn);
  panel->installEventFilter(this);
  forgetting_ = std::make_unique<Forgetting>(*context_, [this](const std::string& id) { return forget(id); });
}

void BodyMeshDisplay::make_scene() {
  scene_.reset();
  scene_ = std::make_unique<BodyScene>(scene_manager_, scene_node_, parts_);
}

template <typename Message>
void BodyMeshDisplay::subscribe(rviz::RosTopicProperty* topic,
                                void (BodyMeshDisplay::*take)(const Message&)) {
  const QString name = topic->getName();
  if (topic->getTopicStd().empty()) return;
  const boost::function<void(const boost::shared_ptr<const Message>&)> on_message =
      [this, name, take](const boost::shared_ptr<const Message>& message) {
        if (node::is_of_forgotten(message)) return;
        try {
          (this->*take)(*message);
          setStatus(StatusProperty::Ok, name, text(words::of_scan(message->scan_id)));
          changed_ = true;
        } catch (const geometry::Refusal& refusal) {
          setStatus(StatusProperty::Error, name, text(words::refused(refusal.code(), refusal.what())));
        }
      };
  try {
    subscribers_.push_back(update_nh_.subscribe<Message>(topic->getTopicStd(), 1, on_message, {},
                                                         ros::TransportHints().tcpNoDelay()));
    setStatus(StatusProperty::Warn, name, words::kNothingYet);
  } catch (const ros::Exception& error) {
    setStatus(StatusProperty::Error, name, error.what());
  }
}

void BodyMeshDisplay::change_topics() {
  subscribers_.clear();
  if (!isEnabled()) return;
  subscribe(properties_->body, &BodyMeshDisplay::take_body);
  subscribe(properties_->worn, &BodyMeshDisplay::take_worn);
  subscribe(properties_->landmarks, &BodyMeshDisplay::take_landmarks);
  subscribe(properties_->control, &BodyMeshDisplay::take_control);
  subscribe(properties_->fit, &BodyMeshDisplay::take_fit);
  subscribe(properties_->warnings, &BodyMeshDisplay::take_warnings);
  if (properties_->look().lines)  // made only while someone listens
    subscribe(properties_->bands, &BodyMeshDisplay::take_bands);
  else
    deleteStatus(properties_->bands->getName());
  if (properties_->look().members)  // made only while someone listens
    subscribe(properties_->members, &BodyMeshDisplay::take_members);
  else
    deleteStatus(properties_->members->getName());
  if (properties_->look().model)  // large, and seldom looked at
    subscribe(properties_->model, &BodyMeshDisplay::take_model);
  else
    deleteStatus(properties_->model->getName());
  listens_to_bands_ = properties_->look().lines;
  listens_to_members_ = properties_->look().members;
  listens_to_model_ = properties_->look().model;
}

void BodyMeshDisplay::change_look() {
  const Look look = properties_->look();
  if (look.lines != listens_to_bands_ || look.members != listens_to_members_ ||
      look.model != listens_to_model_)
    change_topics();
  changed_ = true;
}

void BodyMeshDisplay::setTopic(const QString& topic, const QString&) {
  properties_->body->setString(topic);
}

void BodyMeshDisplay::onEnable() {
  change_topics();
  changed_ = true;
}

void BodyMeshDisplay::onDisable() {
  subscribers_.clear();
  scene_->show(false);
  second_->close();
}

void BodyMeshDisplay::reset() {
  rviz::Display::reset();
  place_.clear();
  change_topics();
}

bool BodyMeshDisplay::forget(const std::string& scan_id) {
  const bool had_overlays = overlays_.forget(scan_id), had_body = body_.forget(scan_id);
  if (warnings_.scan_id == scan_id) warnings_ = {};
  if (had_body && body_.empty()) {
    new_body_ = false;
    second_->close();
    properties_->show_pointed(nullptr);
    make_scene();  // with nothing in it
  }
  changed_ = true;
  return had_body || had_overlays;
}

void BodyMeshDisplay::take_body(const TriangleMesh& message) {
  body_.take_body(message.scan_id, node::mesh_in(message));
  frame_ = message.header.frame_id;
  new_body_ = true;
}

void BodyMeshDisplay::take_worn(const DeformedMesh& message) {
  body_.take_worn({message.scan_id,
                   message.garment,
                   node::points_in(message.vertices),
                   {message.distortion.begin(), message.distortion.end()}});
}

void BodyMeshDisplay::take_landmarks(const Landmarks& message) {
  overlays_.take_measures(message.scan_id, node::measures_in(message));
}

void BodyMeshDisplay::take_model(const BodyModel& message) {
  overlays_.take_model(message.scan_id, node::skin_in(message));
}

void BodyMeshDisplay::take_control(const ControlMesh& message) {
  overlays_.take_control(message.scan_id, node::control_in(message));
}

void BodyMeshDisplay::take_fit(const FitState& message) {
  std::vector<TenseLine> lines;
  for (const LineResult& line : message.lines)
    lines.push_back({line.name,
                     {line.nodes.begin(), line.nodes.end()},
                     line.tension,
                     node::points_in(line.course_at_rest),
                     node::points_in(line.course)});
  overlays_.take_fit(message.scan_id, node::points_in(message.outer), std::move(lines));
}

void BodyMeshDisplay::take_bands(const BandShapes& message) {
  std::vector<BandOnSkin> bands;
  for (const BandShape& band : message.bands)
    bands.push_back(
        {band.line, band.tension, fibres_in(band.at_rest, band.fibres), fibres_in(band.worn, band.fibres)});
  overlays_.take_bands(message.scan_id, std::move(bands));
}

void BodyMeshDisplay::take_warnings(const FitWarnings& message) {
  warnings_ = message;
}

std::vector<int> BodyMeshDisplay::unheld_skin() const {
  std::vector<int> skin;
  if (warnings_.scan_id != body_.scan_id() || warnings_.garment != body_.garment()) return skin;
  for (const FitWarning& notice : warnings_.notices)
    if (notice.code == geometry::notice::kUnderConstricted)
      for (const std::uint32_t v : notice.vertices)
        if (v < body_.mesh().vertices.size()) skin.push_back(static_cast<int>(v));
  std::sort(skin.begin(), skin.end());
  skin.erase(std::unique(skin.begin(), skin.end()), skin.end());
  return with_rim(skin);
}

// A line's ribbon hides the skin just below it.
std::vector<int> BodyMeshDisplay::with_rim(const std::vector<int>& skin) const {
  constexpr double kRim = 0.012;  // m
  if (skin.empty()) return skin;
  const std::vector<Eigen::Vector3d>& vertices = body_.mesh().vertices;
  std::vector<Eigen::Vector3d> points;
  for (const int v : skin) points.push_back(vertices[v]);
  const geometry::PointTree tree(points);
  std::vector<int> wide;
  for (std::size_t v = 0; v < vertices.size(); ++v)
    if (tree.distance(vertices[v]) <= kRim) wide.push_back(static_cast<int>(v));
  return wide;
}

void BodyMeshDisplay::take_members(const MemberForces& message) {
  overlays_.take_members(message.scan_id, {node::points_in(message.nodes),
                                           {message.ends.begin(), message.ends.end()},
                                           {message.forces.begin(), message.forces.end()}});
}

void BodyMeshDisplay::update(float, float) {
  if (body_.empty()) return;
  place();
  if (!changed_) return;
  changed_ = false;
  if (new_body_) scene_->take_triangles(body_);
  new_body_ = false;
  try {
    const Look look = properties_->look();
    scene_->draw(body_, overlays_, unheld_skin(), look);
    part_view(look);
    setStatus(StatusProperty::Ok, words::kDrawing, text(body_.note()));
  } catch (const geometry::Refusal& refusal) {
    setStatus(StatusProperty::Error, words::kDrawing, text(words::refused(refusal.code(), refusal.what())));
  }
  properties_->show_pointed(nullptr);
  context_->queueRender();
}

void BodyMeshDisplay::part_view(const Look& look) {
  if (look.show == Show::side_by_side)
    second_->open(0.5, true);
  else if (look.show == Show::wipe)
    second_->open(look.blend, false);
  else
    second_->close();
}

// Where tf has the scan's frame now: it outlives the scan's stamp.
void BodyMeshDisplay::place() {
  Ogre::Vector3 position;
  Ogre::Quaternion turn;
  const bool placed = context_->getFrameManager()->getTransform(frame_, ros::Time(), position, turn);
  if (placed) {
    scene_node_->setPosition(position);
    scene_node_->setOrientation(turn);
  }
  const std::string words = placed ? frame_ : words::no_transform(frame_, fixed_frame_.toStdString());
  if (words == place_) return;
  place_ = words;
  setStatus(placed ? StatusProperty::Ok : StatusProperty::Error, words::kPlace, text(words));
}

bool BodyMeshDisplay::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::MouseButtonPress || event->type() == QEvent::MouseButtonRelease) {
    const auto* mouse = static_cast<QMouseEvent*>(event);
    if (event->type() == QEvent::MouseButtonPress)
      pressed_at_ = mouse->pos();
    else if (mouse->button() == Qt::LeftButton && (mouse->pos() - pressed_at_).manhattanLength() <= kStill)
      point(mouse->pos());
  }
  return rviz::Display::eventFilter(watched, event);
}

void BodyMeshDisplay::point(const QPoint& pixel) {
  if (!isEnabled() || body_.empty() || new_body_) return;
  const SecondView::Seen seen = second_->at(pixel);
  const bool before = second_->is_open() && !seen.right;
  const std::optional<Pointed> pointed = scene_->point_at(seen.ray, before, body_, overlays_);
  properties_->show_pointed(pointed ? &*pointed : nullptr);
  if (pointed)
    scene_->mark(&pointed->place, words::pointed(before ? ColourBy::plain : properties_->look().colour_by,
                                                 pointed->value, pointed->landmark, pointed->distance));
  else
    scene_->mark(nullptr, words::kPointedHelp);
  context_->queueRender();
}

}  // namespace tensegric_fit::inspect

PLUGINLIB_EXPORT_CLASS(tensegric_fit::inspect::BodyMeshDisplay, rviz::Display)
