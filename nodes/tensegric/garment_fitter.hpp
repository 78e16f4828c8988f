/// Fits garment after garment to one control mesh after the other.
#pragma once

#include <tensegric_fit/ControlMesh.h>
#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/TriangleMesh.h>

#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "geometry/posture.hpp"
#include "tensegric/body_under_garment.hpp"
#include "tensegric/fit_messages.hpp"
#include "tensegric/model.hpp"
#include "tensegric/solver.hpp"

namespace tensegric_fit::node {

/// What garments are fitted to, all of one scan.
struct FittingScene {
  ControlMesh::ConstPtr control;
  Landmarks::ConstPtr landmarks;  ///< needed for a posture, else null
  TriangleMesh::ConstPtr body;    ///< needed for bands; null: nothing is known of the skin
};

/// Field defaults are the parameters' defaults.
struct FitterOptions {
  tensegric::ModelOptions model;
  tensegric::SolverOptions solver;
  geometry::Posture posture;
  double beta = 0;  ///< of the binding; the tffd stage's parameter of that name has to be the same
};

/// Keeps the model of the newest control mesh, and the last solution on it for a warm start.
class GarmentFitter {
 public:
  GarmentFitter(const FitterOptions& options, tensegric::BindBody bind_body)
      : options_(options), bind_body_(std::move(bind_body)) {}

  /// Whether the garment can be laid on the newest body; any garment can where there is none yet. For any
  /// thread. \throw Refusal unknown_line, bad_garment
  void check(const tensegric::Garment& garment) const;

  /// The solver that a request is for.
  tensegric::SolverName solver_of(const GarmentRequest& request) const;

  /// For one thread. `rest` counts how often a start from rest was asked for: only a solution of the same
  /// count is started from, so that none of them is lost where a fit is left out or stopped. Nothing where
  /// `progress` stopped it. \throw Refusal as build_model, BodyUnderGarment::lay and solve
  std::optional<tensegric::Solution> fit(const FittingScene& scene, const GarmentRequest& request, int rest,
                                         const tensegric::Progress& progress);

  /// The newest model; null where there is none.
  std::shared_ptr<const tensegric::Model> model() const;

 private:
  struct Wearer {
    tensegric::Model model;
    std::unique_ptr<const tensegric::BodyUnderGarment> body;
  };
  std::shared_ptr<const Wearer> wearer() const;
  void take(const FittingScene& scene);

  const FitterOptions options_;
  const tensegric::BindBody bind_body_;
  FittingScene scene_;
  geometry::BoneFrames bones_;
  std::vector<tensegric::VolumeFunction> body_volumes_;
  std::optional<tensegric::Solution> last_;
  int last_rest_ = 0;  // of last_

  mutable std::mutex mutex_;
  std::shared_ptr<const Wearer> wearer_;  // the newest
};

}  // namespace tensegric_fit::node
