/// Fits garment after garment to one control mesh after the other.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/posture.hpp"
#include "tensegric/body_under_garment.hpp"
#include "tensegric/model.hpp"
#include "tensegric/solver.hpp"

namespace tensegric_fit::tensegric {

/// Field defaults are the parameters' defaults.
struct FitterOptions {
  ModelOptions model;
  SolverOptions solver;
  geometry::Posture posture;
  double beta = 0;  ///< of the binding; the tffd stage's parameter of that name has to be the same
};

/// Keeps the model of the newest control mesh, and the last solution on it for a warm start.
class GarmentFitter {
 public:
  GarmentFitter(const FitterOptions& options, BindBody bind_body)
      : options_(options), bind_body_(std::move(bind_body)) {}

  /// Whether that body was taken last. For any thread.
  bool knows(const std::string& scan_id) const;
  /// Whether the garment can be laid on that body; nothing is checked where another was taken last. For any
  /// thread. \throw Refusal unknown_line, bad_garment
  void check(const Garment& garment, const std::string& scan_id) const;

  // What follows is for one thread.

  /// The next garments are fitted to this control mesh. `measures` are needed for a posture, else null;
  /// `body` makes the mesh of the same scan where it is asked for; null: strings alone, and nothing is known
  /// of the skin. \throw Refusal as build_model: the mesh before stays
  void take(const std::string& scan_id, const geometry::ControlMesh& control,
            const geometry::BodyMeasures* measures, std::function<geometry::TriangleMesh()> body);

  /// `rest` counts how often a start from rest was asked for: only a solution of the same count is started
  /// from, so that none of them is lost where a fit is left out or stopped. Nothing where `progress` stopped
  /// it. \pre take() \throw Refusal as BodyUnderGarment::lay and solve
  std::optional<Solution> fit(const Garment& garment, SolverName solver, int rest, const Progress& progress);

  /// The newest model; null where there is none. For any thread.
  std::shared_ptr<const Model> model() const;

 private:
  struct Wearer {
    std::string scan_id;
    Model model;
    std::unique_ptr<const BodyUnderGarment> body;
  };
  std::shared_ptr<const Wearer> wearer() const;

  const FitterOptions options_;
  const BindBody bind_body_;
  geometry::BoneFrames bones_;
  std::vector<PosedVolume> body_volumes_;
  std::optional<Solution> last_;
  bool knows_skin_ = false;  // whether skin is turned over
  int last_rest_ = 0;        // of last_

  mutable std::mutex mutex_;
  std::shared_ptr<const Wearer> wearer_;  // the newest
};

}  // namespace tensegric_fit::tensegric
