#include "body_model/registration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "body_model/arms.hpp"
#include "body_model/gauss_newton.hpp"
#include "body_model/missing_parts.hpp"
#include "body_model/recognition.hpp"
#include "geometry/parallel_for.hpp"
#include "geometry/percentile.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Vector3d;

const Stage kRough{.15, .08, 7, 8, 500, 6};
const Stage kSecond{.10, .06, 16, 4, 2000, 60};
const Stage kThird{.06, .05, 12, 2, 3000, 60};
const Stage kFine{.05, .02, 8, 1, 4000, 1000};

constexpr std::size_t kFewest = 500;   // samples
constexpr int kSamplesOfMesh = 40000;  // 7 mm apart on a woman
constexpr int kAround = 12;            // samples: two rings of neighbours

/// Stature and soles of a person; the scan may show only a part of her.
struct Stand {
  double stature, soles;  ///< m
};
constexpr double kShortestWoman = 1.30;  // m, of women who stand or stoop
constexpr double kShort = 1.45;          // m; of 100 women one is shorter: it may be a part of a taller one
constexpr double kUsual = 1.65;          // m, of women and men when a scan shows only a part
constexpr double kKnee = 0.27, kCrotch = 0.46, kChin = 0.87;  // statures above the soles

constexpr int kYaws = 8, kWays = 2;              // that she may face, and that are looked at more closely
constexpr double kRestingArm = M_PI / 4;         // rad, how far the arms are raised at rest
constexpr double kShoulder = 0.11, kArm = 0.40;  // statures: half the shoulders' breadth, an arm's length

/// The mean woman in the place of the samples, facing one way, her arms as far out as the samples reach.
Parameters start_at(const Model& model, const Samples& samples, const Stand& stand, double yaw) {
  const auto box = geometry::bounding_box(samples.points);
  const double low = box[0].z(), height = box[1].z() - low;
  std::vector<double> xs, ys;
  for (const Vector3d& p : samples.points)
    if (p.z() > low + 0.4 * height && p.z() < low + 0.8 * height) {
      xs.push_back(p.x());
      ys.push_back(p.y());
    }
  if (xs.empty())
    throw geometry::Refusal(geometry::refusal::kNotABody, "nothing in the middle of its height");
  Parameters p(model);
  p.rotation = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
  p.log_scale = std::log(stand.stature / model.stature);
  const Vector3d left = p.rotation.col(0), middle(geometry::median(xs), geometry::median(ys), 0);
  std::vector<double> aside;
  for (const Vector3d& q : samples.points) aside.push_back(std::abs((q - middle).dot(left)));
  const auto far =
      aside.begin() + static_cast<std::ptrdiff_t>(aside.size() * 499 / 500);  // but for stray ones
  std::nth_element(aside.begin(), far, aside.end());
  const double raised =
      std::asin(std::clamp((*far / stand.stature - kShoulder) / kArm, 0.1, 1.0)) - kRestingArm;
  p.turns[model.group_named("arm_L")].y() = -raised;
  p.turns[model.group_named("arm_R")].y() = raised;
  const PosedModel posed(model, p);
  double lowest = 1e9;
  for (const int v : model.fit_points) lowest = std::min(lowest, posed.vertex(v).z());
  p.position = Vector3d(middle.x(), middle.y(), stand.soles - lowest);
  return p;
}

/// The same with breasts that hang lower than nearly all women's.
Parameters with_hanging_breasts(const Model& model, Parameters p) {
  constexpr double kLow = -3;  // deviations: one woman of 740 has less. A start, no limit; no other was tried
  Eigen::VectorXd up = Eigen::VectorXd::Zero(model.components());
  for (const SkinPoint& point : model.skin_points)
    if (point.name == "bust_point_L" || point.name == "bust_point_R")
      for (const auto& [vertex, share] : point.vertices)
        up += share * model.basis.col(3 * vertex + 2).cast<double>();
  up.normalize();
  p.shape += (kLow - p.shape.dot(up)) * up;
  return p;
}

/// The same with spine and legs straight, as its pelvis stands: of a tilted scan both legs may have been laid
/// on one.
Parameters standing_straight(const Model& model, Parameters p) {
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    if (model.groups[g].name.find("arm_") == std::string::npos) p.turns[g].setZero();
  return p;
}

/// Whether there is surface that the model is nowhere near: a thing, or a part of her that the fit went past.
bool leaves_things(const Matching& matching) {
  const auto off = std::count_if(matching.unexplained.begin(), matching.unexplained.end(),
                                 [](double distance) { return distance > kOff; });
  return static_cast<double>(off) >= kLeastThing * static_cast<double>(matching.unexplained.size());
}

/// Of a whole person, or of one whose feet, head, or both are missing. \throw Refusal not_a_body
std::vector<Stand> stands_of(const Samples& samples) {
  const auto box = geometry::bounding_box(samples.points);
  const double low = box[0].z(), high = box[1].z(), height = high - low;
  if (height < kLowestPerson || height > kHighestPerson)
    throw geometry::Refusal(
        geometry::refusal::kNotABody,
        fmt::format("what was scanned is {:.2f} m high; a person, or her trunk, is {:.2f} to {:.2f} m",
                    height, kLowestPerson, kHighestPerson));
  std::vector<Stand> stands;
  if (height > kShortestWoman) stands.push_back({height, low});
  if (height > kShort) return stands;
  stands.push_back({kUsual, high - kUsual});
  stands.push_back({kUsual, low});
  for (const double bottom : {kKnee, kCrotch})
    if (const double stature = height / (kChin - bottom);
        stature > kShortestWoman && stature < kHighestPerson)
      stands.push_back({stature, low - bottom * stature});
  return stands;
}

/// m, of each vertex from the mean of the samples nearest to it.
std::vector<double> support_of(const std::vector<Vector3d>& skin, const std::vector<Vector3d>& samples) {
  const geometry::PointTree tree(samples);
  std::vector<double> support(skin.size());
  geometry::parallel_for(skin.size(), [&](std::size_t begin, std::size_t end, int) {
    std::vector<int> near;
    for (std::size_t v = begin; v < end; ++v) {
      tree.nearest(skin[v], kAround, near);
      Vector3d mean = Vector3d::Zero();
      for (const int i : near) mean += samples[i] / static_cast<double>(near.size());
      support[v] = (mean - skin[v]).norm();
    }
  });
  return support;
}

/// m, mean distance of model and samples from each other; skin of parts that are not there has none, nor have
/// samples of things that are not hers. \pre all fit points took part
double residual_of(const Model& model, const Matching& matching, const std::vector<char>& part_is_there,
                   const std::vector<char>& is_of_thing) {
  double skin = 0, weight = 0, samples = 0, count = 0;
  for (std::size_t i = 0; i < model.fit_points.size(); ++i) {
    if (!part_is_there[model.part[model.fit_points[i]]]) continue;
    skin += model.fit_weights[i] * matching.distances[i];
    weight += model.fit_weights[i];
  }
  for (std::size_t s = 0; s < matching.unexplained.size(); ++s) {
    if (s < is_of_thing.size() && is_of_thing[s]) continue;
    samples += matching.unexplained[s];
    ++count;
  }
  return ((weight > 0 ? skin / weight : Matching::kUnmatched) +
          (count > 0 ? samples / count : Matching::kUnmatched)) /
         2;
}

}  // namespace

Registrar::Registrar(Model model, const Standing& standing)
    : model_(std::make_shared<const Model>(std::move(model))), field_(*model_), standing_(standing) {}

RegisteredBody Registrar::operator()(const Samples& samples) const {
  const Model& model = *model_;
  if (samples.points.size() < kFewest)
    throw geometry::Refusal(geometry::refusal::kNotABody, "too little surface to be a body");
  const Matcher matcher(samples);
  // 1. Which way she faces, for each guess at what of her there is; 2. where her arms are, of the two
  // likeliest ways of each guess: a wrong guess may look likelier while it is rough; 3. pose and shape; 4.
  // what they leave over.
  std::vector<std::pair<Stand, double>> from;
  for (const Stand& stand : stands_of(samples))
    for (int k = 0; k < kYaws; ++k) from.emplace_back(stand, 2 * M_PI * k / kYaws);
  std::vector<Fitted> rough(from.size()), tried;
  geometry::parallel_for(rough.size(), [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t i = begin; i < end; ++i)
      rough[i] = fit_stage(model, matcher, start_at(model, samples, from[i].first, from[i].second), kRough);
  });
  const auto likelier = [](const Fitted& a, const Fitted& b) { return a.surprise < b.surprise; };
  for (auto stand = rough.begin(); stand != rough.end(); stand += kYaws) {
    std::stable_sort(stand, stand + kYaws, likelier);
    tried.insert(tried.end(), stand, stand + kWays);
  }
  geometry::parallel_for(tried.size(), [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t i = begin; i < end; ++i)
      tried[i] = fit_stage(model, matcher, with_arms_placed(model, matcher, tried[i].parameters), kSecond);
  });
  const Parameters first = std::min_element(tried.begin(), tried.end(), likelier)->parameters;
  std::vector<Fitted> ways{fit_stage(model, matcher, first, kThird)};
  if (leaves_things(ways.front().matching)) {
    // Breasts that lie on the belly may have been taken for it, one leg for both.
    const std::array starts{with_hanging_breasts(model, first), standing_straight(model, first)};
    ways.resize(1 + starts.size());
    geometry::parallel_for(starts.size(), [&](std::size_t begin, std::size_t end, int) {
      for (std::size_t i = begin; i < end; ++i)
        ways[1 + i] =
            fit_stage(model, matcher, fit_stage(model, matcher, starts[i], kSecond).parameters, kThird);
    });
  }
  const Fitted fitted =
      fit_stage(model, matcher, std::min_element(ways.begin(), ways.end(), likelier)->parameters, kFine);
  const PosedModel posed(model, fitted.parameters);
  RegisteredBody body;
  body.model = model_;
  body.parameters = fitted.parameters;
  body.posed = posed.vertices();
  const Displaced displaced = displace(model, field_, matcher, fitted.parameters);
  body.skin = displaced.vertices;
  body.off = field_.spread(displaced.distances);
  body.support = support_of(body.skin, samples.points);
  for (std::size_t b = 0; b < model.bones.size(); ++b)
    body.joints.push_back(posed.joint(static_cast<int>(b)));
  for (std::size_t i = 0; i < model.bone_points.size(); ++i)
    body.bone_points.push_back(posed.bone_point(static_cast<int>(i)));
  body.there = shares_there(body);
  body.residual = residual_of(model, fitted.matching, parts_there(body), recognise(body, samples));
  return body;
}

RegisteredBody register_mesh(const Registrar& registrar, const geometry::TriangleMesh& mesh,
                             const std::vector<char>& filled) {
  RegisteredBody body = registrar(shuffled(sample_surface(mesh, filled, kSamplesOfMesh)));
  body.scanned = std::find(filled.begin(), filled.end(), 1) != filled.end();
  body.vertical = upright(body, registrar.standing());
  if (lacks_feet(body)) {
    const Ground ground = ground_by_soles(body, registrar.standing());
    body.ground = ground.height;
    body.ground_deviation = ground.deviation;
    return body;
  }
  body.ground = HUGE_VAL;  // under the surface: vertices of no triangle may lie anywhere
  for (const Eigen::Vector3i& t : mesh.triangles)
    for (const int v : t) body.ground = std::min(body.ground, body.vertical.dot(mesh.vertices[v]));
  // Reconstruction ends soles on the ground; whether it saw a floor is not known here.
  if (body.scanned) body.ground_deviation = registrar.standing().ground;
  const Ground ground = settled_ground(body, body.ground, body.ground_deviation, registrar.standing());
  body.ground = ground.height;
  body.ground_deviation = ground.deviation;
  // The lowest place is that of one foot, which may be the one that was lifted.
  if (const auto [left, right] = sides_there(body, "foot"); !(left && right))
    body.ground_deviation = std::max(body.ground_deviation, registrar.standing().ground);
  return body;
}

const Registrar& shipped_registrar() {
  static const Registrar registrar(load_model(geometry::shipped_folder("body_model") + "/women.tfb"),
                                   shipped_standing());
  return registrar;
}

}  // namespace tensegric_fit::body_model
