#include "body_model/gauss_newton.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/parallel_for.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kTilt =
    10 * kDegree;  // of the pelvis: 15 degrees of the scan, 25 of a stoop are within 2.5 deviations
constexpr double kStartOff =
    0.15;  // of the stature's logarithm: a fit begins with the scan's height, however she stoops
// What a match may be off, as a share of the scale that matches are looked for in, and m that the model
// always is. Tolerance, not fitted: with a share of 0.15 the prior keeps bodies far from the mean in a wrong
// shape while matches are coarse.
constexpr double kNoisePerScale = 0.06, kLeastNoise = 0.002;
constexpr double
    kPiece = 180,
    kPieceMisfit =
        0.002;  // pieces of a woman's skin, 10 cm wide, that misfit each on its own; m, by how much
constexpr double kStatures =
    0.06;  // of the logarithm of people's stature: 1.45 to 1.95 m are within 2.5 deviations
constexpr double kLargestTurn = 20 * kDegree;  // in a step; beyond that derivatives mean little

/// What the prior takes the parameters to be, and how firmly.
struct Prior {
  VectorXd off, precision;
};

Prior prior_of(const Model& model, const Parameters& p, double stature) {
  Prior prior{VectorXd::Zero(p.count()), VectorXd::Zero(p.count())};
  const Vector3d up = p.rotation.col(2);
  prior.off.head<2>() = Vector3d::UnitZ().cross(up).head<2>();
  prior.precision.head<2>().setConstant(1 / (kTilt * kTilt));
  prior.off[Parameters::kScale] = p.log_scale - stature;
  prior.precision[Parameters::kScale] = 1 / (kStartOff * kStartOff);
  for (std::size_t g = 0; g < p.turns.size(); ++g) {
    const int at = Parameters::kTurns + 3 * static_cast<int>(g);
    prior.off.segment<3>(at) = p.turns[g];
    prior.precision.segment<3>(at) = model.groups[g].spread.array().square().inverse();
  }
  prior.off.tail(p.shape.size()) = p.shape;
  prior.precision.tail(p.shape.size()).setOnes();
  return prior;
}

/// The fit points that take part, with their normals at rest: those of one shape serve for the next ones as
/// well.
class FitPoints {
 public:
  FitPoints(const Model& model, const Parameters& p, int every) {
    const PosedModel posed(model, p);
    const std::vector<Vector3d> normals = geometry::vertex_normals(posed.vertices(), model.triangles);
    for (std::size_t i = 0; i < model.fit_points.size(); i += every) {
      vertices_.push_back(model.fit_points[i]);
      weights_.push_back(model.fit_weights[i]);
      at_rest_.push_back(posed.blend(vertices_.back()).transpose() * normals[vertices_.back()]);
    }
  }

  const std::vector<int>& vertices() const { return vertices_; }

  ModelSkin skin(const PosedModel& posed) const {
    ModelSkin skin{{}, {}, weights_};
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      skin.points.push_back(posed.vertex(vertices_[i]));
      skin.normals.push_back((posed.blend(vertices_[i]) * at_rest_[i]).normalized());
    }
    return skin;
  }

 private:
  std::vector<int> vertices_;
  std::vector<double> weights_;
  std::vector<Vector3d> at_rest_;
};

/// As Fitted::surprise. The prior's stature is where the fit began, which says nothing of people.
double surprise_of(const Matching& matching, const Prior& prior, double log_scale) {
  double misfit = 0;
  for (const double d : matching.unexplained) misfit += d / static_cast<double>(matching.unexplained.size());
  const double start =
      prior.off[Parameters::kScale] * prior.off[Parameters::kScale] * prior.precision[Parameters::kScale];
  const double squares =
      prior.off.cwiseAbs2().dot(prior.precision) - start + std::pow(log_scale / kStatures, 2);
  return kPiece * misfit / kPieceMisfit + squares / 2;
}

/// Normal equations of the matches, in the first `active` parameters. A pull is nearly one of a plane: its
/// largest direction stands for it where `planes`, all three otherwise.
void normal_equations(const PosedModel& posed, const std::vector<int>& vertices,
                      const std::vector<Pull>& pulls, int active, bool planes, MatrixXd& matrix,
                      VectorXd& gradient) {
  const int rows_each = planes ? 1 : 3, points = static_cast<int>(vertices.size());
  std::array<MatrixXd, 2> matrices{MatrixXd::Zero(active, active), MatrixXd::Zero(active, active)};
  std::array<VectorXd, 2> gradients{VectorXd::Zero(active), VectorXd::Zero(active)};
  const auto accumulate = [&](std::size_t begin, std::size_t end, int half) {
    MatrixXd rows(active, rows_each * static_cast<int>(end - begin));
    VectorXd off(rows.cols());
    Eigen::Matrix3Xd derivative(3, active);
    Eigen::SelfAdjointEigenSolver<Matrix3d> axes;
    for (std::size_t i = begin; i < end; ++i) {
      axes.computeDirect(pulls[i].information);
      posed.derivative(vertices[i], derivative);
      for (int r = 0; r < rows_each; ++r) {
        const double root = std::sqrt(std::max(axes.eigenvalues()[2 - r], 0.0));
        const Vector3d axis = axes.eigenvectors().col(2 - r);
        const auto at = static_cast<Eigen::Index>(rows_each * (i - begin) + r);
        rows.col(at).noalias() = root * (derivative.transpose() * axis);
        off[at] = root > 0 ? axis.dot(pulls[i].pull) / root : 0;
      }
    }
    matrices[half].selfadjointView<Eigen::Lower>().rankUpdate(rows);
    gradients[half] = rows * off;
  };
  if (points < kWorthThreads)
    accumulate(0, points, 0);
  else
    geometry::parallel_for(points, accumulate);
  matrix = matrices[0] + matrices[1];
  gradient = gradients[0] + gradients[1];
}

}  // namespace

Fitted fit_stage(const Model& model, const Matcher& matcher, Parameters start, const Stage& stage) {
  Fitted fitted{std::move(start), {}, 0};
  Parameters& p = fitted.parameters;
  const FitPoints points(model, p, stage.every);
  const double stature = p.log_scale;
  const int active = p.shape_at() + std::min(stage.components, model.components());
  for (int i = 0; i < stage.iterations; ++i) {
    const double scale = stage.from * std::pow(stage.to / stage.from, double(i) / (stage.iterations - 1));
    const double noise = std::max(kNoisePerScale * scale, kLeastNoise);
    const PosedModel posed(model, p);
    fitted.matching = matcher.match(points.skin(posed), scale, stage.samples);
    MatrixXd matrix;
    VectorXd gradient;
    normal_equations(posed, points.vertices(), fitted.matching.pulls, active, scale <= 0.02, matrix,
                     gradient);
    const Prior prior = prior_of(model, p, stature);
    fitted.surprise = surprise_of(fitted.matching, prior, p.log_scale);
    matrix /= noise * noise;
    matrix.diagonal() += prior.precision.head(active);
    gradient = gradient / (noise * noise) + prior.precision.cwiseProduct(prior.off).head(active);
    VectorXd step = VectorXd::Zero(p.count());
    step.head(active) = -matrix.ldlt().solve(gradient);  // which reads the lower half
    const int turns = p.shape_at() - Parameters::kTurns;
    const double turn = std::max(step.head<3>().cwiseAbs().maxCoeff(),
                                 step.segment(Parameters::kTurns, turns).cwiseAbs().maxCoeff());
    if (turn > kLargestTurn) step *= kLargestTurn / turn;
    p = p.plus(step);
  }
  return fitted;
}

}  // namespace tensegric_fit::body_model
