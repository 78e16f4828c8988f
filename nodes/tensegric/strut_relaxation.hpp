/// The papers' computation: one strut after the other is put where its forces balance (P1 §3.1), with pseudo
/// forces of volume and lines (P1 §3.4-3.5, P2 §5).
///
/// The adaptive way is stable where P1's swings: struts push as they stand, not as they were when last
/// processed, and a node is held back by as much as slack parts, other struts and the pseudo forces may
/// stiffen while it moves. What is at rest under the one is at rest under the other.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tensegric/problem.hpp"

namespace tensegric_fit::tensegric {

class StrutRelaxation {
 public:
  /// `adaptive`: the volume force is held back while the line force is the greater (P2 §5).
  StrutRelaxation(const Problem& problem, const Solution* start, bool adaptive);

  /// Every strut once, in order; then the pseudo forces anew.
  void cycle();

  /// Largest net force at a free node / mean tensile force at rest.
  double residual() const;

  /// False once a node is not finite or has left the model by some times its size.
  bool sane() const;

  State state() const { return {x_, tensions_}; }

  /// All that a cycle starts from, as one vector of lengths, and back.
  Eigen::VectorXd packed() const;
  void unpack(const Eigen::VectorXd& all);

 private:
  /// Where a node would go if one of its struts let go of it: the mean of the ends of its taut parts, each
  /// moved by its natural length (C_a in README.md), and their weight.
  struct Centre {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    double weight = 0;
  };

  Centre centre(int node, int strut) const;
  void settle_strut(int strut);
  void update_forces();
  void pull(const Band& band);
  void push_volume(std::size_t region, double line_force);
  void hold_back(const Band& band, double slope, double tension);

  const Problem& problem_;
  const Model& model_;
  bool adaptive_;
  Positions x_;
  double size_ = 0;
  std::vector<std::vector<int>> tensile_at_, struts_at_;  // of each node
  std::vector<Eigen::Vector3d>
      pushes_;                // of each strut on its node a, as last processed; the opposite on its node b
  Eigen::VectorXd external_;  // pseudo forces by the free nodes
  std::vector<double> tensions_;
  std::vector<double> gathered_;  // volume push that has added up, one per region
  std::vector<double> held_;      // of each node, adaptive: how fast the pseudo forces change as it moves
};

}  // namespace tensegric_fit::tensegric
