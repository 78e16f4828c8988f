#include "body_model/registration.hpp"

#include <algorithm>
#include <cmath>

#include "body_model/arms.hpp"
#include "body_model/gauss_newton.hpp"
#include "geometry/halves.hpp"
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

constexpr std::size_t kFewest = 500;  // samples
constexpr int kSamplesOfMesh = 40000;  // 7 mm apart on a woman
constexpr int kAround = 12;           // samples: two rings of neighbours

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

std::vector<Parameters> starts(const Model& model, const Samples& samples) {
  double low = 1e9, high = -1e9;
  for (const Vector3d& p : samples.points) {
    low = std::min(low, p.z());
    high = std::max(high, p.z());
  }
  const double height = high - low;
  std::vector<double> xs, ys;
  for (const Vector3d& p : samples.points)
    if (p.z() > low + .4 * height && p.z() < low + .8 * height) {
      xs.push_back(p.x());
      ys.push_back(p.y());
    }
  const Eigen::Vector2d c(median(xs), median(ys));
  std::vector<Parameters> all;
  for (int k = 0; k < 8; ++k) {
    const double yaw = k * M_PI / 4;
    Parameters p(model);
    p.rotation = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
    p.log_scale = std::log(height / model.stature);
    const Eigen::Vector2d side(std::cos(yaw), std::sin(yaw));
    std::vector<double> u;
    for (const Vector3d& q : samples.points) u.push_back((q.head<2>() - c).dot(side));
    std::sort(u.begin(), u.end());
    const double span = u[u.size() * 999 / 1000] - u[u.size() / 1000];
    const double s = std::clamp((span / 2 / height - .11) / .40, .1, 1.0), lift = std::asin(s) - 45 * M_PI / 180;
    p.turns[model.group_named("arm_L")].y() = -.9 * lift;
    p.turns[model.group_named("arm_R")].y() = .9 * lift;
    const PosedModel posed(model, p);
    double lowest = 1e9;
    for (const int v : model.fit_points) lowest = std::min(lowest, posed.vertex(v).z());
    p.position = Vector3d(c.x(), c.y(), low - lowest);
    all.push_back(p);
  }
  return all;
}

/// m, of each vertex from the mean of the samples nearest to it.
std::vector<double> support_of(const std::vector<Vector3d>& skin, const std::vector<Vector3d>& samples) {
  const geometry::PointTree tree(samples);
  std::vector<double> support(skin.size());
  geometry::in_halves(skin.size(), [&](std::size_t begin, std::size_t end, int) {
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

}  // namespace

Registrar::Registrar(Model model, const Standing& standing)
    : model_(std::make_shared<const Model>(std::move(model))), field_(*model_), standing_(standing) {}

RegisteredBody Registrar::operator()(const Samples& surface) const {
  const Model& model = *model_;
  if (surface.points.size() < kFewest) throw geometry::Refusal(geometry::refusal::kNotABody, "too little surface to be a body");
  const Samples samples = shuffled(surface);
  const Matcher matcher(samples);
  // 1. Which way she faces; 2. where her arms are, of the two likeliest; 3. pose and shape; 4. what they leave over.
  const std::vector<Parameters> start = starts(model, samples);
  std::vector<Fitted> tried(start.size(), Fitted{start[0], 1e9, {}});
  geometry::in_halves(start.size(), [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t i = begin; i < end; ++i) tried[i] = fit_stage(model, matcher, start[i], kRough);
  });
  const auto better = [](const Fitted& a, const Fitted& b) { return a.residual < b.residual; };
  std::stable_sort(tried.begin(), tried.end(), better);
  tried.erase(tried.begin() + 2, tried.end());
  geometry::in_halves(2, [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t i = begin; i < end; ++i) tried[i] = fit_stage(model, matcher, with_arms_placed(model, matcher, tried[i].parameters), kSecond);
  });
  Fitted fitted = *std::min_element(tried.begin(), tried.end(), better);
  for (const Stage& stage : {kThird, kFine}) fitted = fit_stage(model, matcher, fitted.parameters, stage);
  const PosedModel posed(model, fitted.parameters);
  RegisteredBody body;
  body.model = model_;
  body.parameters = fitted.parameters;
  body.residual = fitted.residual;
  body.posed = posed.vertices();
  const Displaced displaced = displace(model, field_, matcher, fitted.parameters);
  body.skin = displaced.vertices;
  body.off = field_.spread(displaced.distances);
  body.support = support_of(body.skin, samples.points);
  for (std::size_t b = 0; b < model.bones.size(); ++b) body.joints.push_back(posed.joint(static_cast<int>(b)));
  for (std::size_t i = 0; i < model.bone_points.size(); ++i) body.bone_points.push_back(posed.bone_point(static_cast<int>(i)));
  return body;
}

RegisteredBody register_mesh(const Registrar& registrar, const geometry::TriangleMesh& mesh) {
  RegisteredBody body = registrar(sample_surface(mesh, {}, kSamplesOfMesh));
  body.scanned = false;
  body.vertical = upright(body, registrar.standing());
  body.ground = body.vertical.dot(mesh.vertices.front());
  for (const Vector3d& v : mesh.vertices) body.ground = std::min(body.ground, body.vertical.dot(v));
  return body;
}

const Registrar& shipped_registrar() {
  static const Registrar registrar(load_model(geometry::shipped_folder("body_model") + "/women.tfb"),
                                   load_standing(geometry::shipped_folder("body_model") + "/standing.yaml"));
  return registrar;
}

}  // namespace tensegric_fit::body_model
