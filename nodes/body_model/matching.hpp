/// Which sample belongs to which point of the model, and what that asks of the point.
#pragma once

#include <vector>

#include "body_model/samples.hpp"
#include "geometry/oriented_tree.hpp"

namespace tensegric_fit::body_model {

inline constexpr int kWorthThreads = 800;  ///< points; fewer are done before a second thread has begun

/// Points of the model as they are at the moment, with normals and what each counts.
struct ModelSkin {
  std::vector<Eigen::Vector3d> points, normals;
  std::vector<double> weights;
};

/// What the samples ask of one point of the model: the quadratic (x - p)^T information (x - p) / 2 + pull .
/// (x - p).
struct Pull {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
};

struct Matching {
  std::vector<Pull> pulls;  ///< one per point of the model
  std::vector<double>
      distances;  ///< m, of each point of the model from the samples' nearest plane; kUnmatched: none
  std::vector<double> unexplained;            ///< m, of each sample that was looked at, in the samples' order
  static constexpr double kUnmatched = 0.05;  ///< m; farther counts as this
  static constexpr double kSameSide = 0.5;    ///< cosine between two normals of one skin, at least
};

/// Nearest points both ways: each model point looks for a sample, and samples look for model points.
class Matcher {
 public:
  /// The samples, in random order, must outlive it.
  explicit Matcher(const Samples& samples);
  /// Distances beyond some 2.5 times `scale` (m) say nothing, shorter ones less the longer they are.
  /// `samples`: how many look back.
  Matching match(const ModelSkin& skin, double scale, int samples) const;

  /// m: from a point to the nearest sample, a turned normal counting as distance.
  double distance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
    return tree_.distance(point, normal);
  }

 private:
  const Samples& samples_;
  geometry::OrientedTree tree_;
};

}  // namespace tensegric_fit::body_model
