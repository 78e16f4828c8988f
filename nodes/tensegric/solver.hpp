/// One interface to the three solvers (P1 §3.1, P2 §5, README.md).
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "geometry/enum_words.hpp"
#include "geometry/fibre.hpp"
#include "geometry/posture.hpp"
#include "geometry/range.hpp"
#include "tensegric/garment.hpp"
#include "tensegric/model.hpp"
#include "tensegric/region_volume.hpp"

namespace tensegric_fit::tensegric {

enum class SolverName { equilibrium, adaptive, relaxation };
enum class Status { converged, infeasible, capped, oscillating, diverged };
/// Whose volume stays as it is: the control mesh's (P1 §3.4), or that of the body below it.
enum class KeptVolume { control, body };

inline constexpr geometry::EnumWords<SolverName, 3> kSolverWords{{"equilibrium", "adaptive", "relaxation"}};
inline constexpr geometry::EnumWords<KeptVolume, 2> kVolumeWords{{"control", "body"}};

std::string to_string(SolverName name);
std::string to_string(Status status);
/// \throw Refusal bad_option naming the word and the choices
SolverName solver_from(const std::string& word);

struct LineResult {
  std::string name;
  double initial = 0, neutral = 0, final = 0;  ///< lengths, m
  double request = 1;                          ///< neutral / initial
  double tension = 0;                          ///< pseudo force
  double newtons = 0;                          ///< the same, N (Model::newtons)
  double pressure = 0;                         ///< Pa, largest; 0 of a line without width
  TensionLaw law;
  double tension_limit = std::numeric_limits<double>::infinity();  ///< pseudo force
  std::vector<int> nodes;  ///< outer nodes that a line by `through` runs over, in order
  std::vector<Eigen::Vector3d> course_at_rest, course;  ///< its middle thread, scan frame
  /// Of a band from edge to edge, of a string its course.
  std::vector<std::vector<Eigen::Vector3d>> fibres_at_rest, fibres;
  double width = 0;      ///< m; 0 of a string; of a cup where its fibres begin to spread
  bool cup = false;      ///< its fibres spread
  double straight = 0;   ///< m, between the fixed nodes that it runs over: it cannot become shorter
  double reachable = 0;  ///< m, the shortest that it came to: `final` where the request is infeasible
};

struct RegionResult {
  std::string name;
  double volume_before = 0, volume_after = 0;  ///< of the control region, m^3
  double volume_error = 0;                     ///< (V - V0) / V0 of the same
  double kept_error = 0;  ///< the same of the volume that is kept: tensegric::volume_error
};

/// One row of P2 Fig. 11. `residual` is relative to the mean tensile force at rest.
struct Iterate {
  int iteration = 0;
  std::vector<double> line_ratios;       ///< length / length at rest, one per line of the garment
  std::vector<double> volume_errors;     ///< (V - V0) / V0, one per region
  std::vector<Eigen::Vector3d> tracked;  ///< the control nodes in SolverOptions::track
  double residual = 0;
  double merit_change =
      0;  ///< of the equilibrium solver's merit function in this step, relative: never a rise
};

/// Of SolverOptions' fields, in their units; kPseudoForce: of line_force and volume_force.
inline constexpr geometry::Range kMaxIterations{0, 1e7}, kTimeBudget{0, 3600}, kPseudoForce{0, 1e6};

/// Field defaults are the parameters' defaults.
struct SolverOptions {
  SolverName solver = SolverName::equilibrium;
  int max_iterations = 0;  ///< 0: the solver's own cap
  double time_budget = 0;  ///< s; 0: none
  KeptVolume volume = KeptVolume::control;
  /// Posture (P2 §6): where the bones move, all inner nodes are bound to them, fixed outer nodes go with
  /// them, and free outer nodes settle; volumes stay those of the scan's posture.
  geometry::BoneFrames bones;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< pseudo force on each outer node, scan frame
  std::vector<int> track;                             ///< outer nodes whose way is written into the history
  /// relaxation, adaptive; pseudo forces / k: pull of a rigid line per stretch (P1 §3.5), and mean push at a
  /// node per relative loss of volume (P1 §3.4). On the test bodies a line_force of 6 and more swings or
  /// blows up.
  double line_force = 3;
  double volume_force = 1;
};

struct Solution {
  std::vector<Eigen::Vector3d> outer, inner;  ///< deformed, scan frame, one per outer node
  std::vector<Eigen::Vector3d> between;       ///< the nodes between them, level by level from outside
  std::vector<LineResult> lines;
  std::vector<RegionResult> regions;
  Status status = Status::capped;
  int iterations = 0;
  double residual = 0;
  std::vector<Iterate> history;
  std::string note;  ///< a sentence for people where the status or the shape needs one
  bool calibrated =
      false;  ///< newtons and pressures mean something: the tissue's constants and `equilibrium`
};

/// Whether skin over these nodes (scan frame) is turned over: a shape that no body can take.
using SkinFolds =
    std::function<bool(const std::vector<Eigen::Vector3d>& outer, const std::vector<Eigen::Vector3d>& inner)>;

/// Called after each iteration with the state as it stands; return false to cancel (status capped: the
/// equilibrium solver's result is then the last state on the way to the request that was in balance, with its
/// volumes kept, or rest where there was none; as it is when the time budget or the iterations end).
using Progress = std::function<bool(const Iterate&, const std::vector<Eigen::Vector3d>& outer,
                                    const std::vector<Eigen::Vector3d>& inner)>;

/// Deforms the model under the garment's lines at constant region volumes. Pieces of the control mesh that no
/// line touches stay at rest, outer and inner nodes bit for bit, where there is no gravity and no posture;
/// those that nothing joins are solved apart by the equilibrium solver, each as if it were worn alone.
/// `start` is null (from rest) or an earlier solution of the same model (warm start). `body_volumes`: for
/// KeptVolume::body, one a region of the control mesh. `laid`: the garment's lines that lie on the body.
/// `folds`: where it says so of the shape asked for, the equilibrium solver goes back along the load to the
/// last shape of which it does not (infeasible); the others, and under gravity or in a posture, keep the
/// shape, infeasible too. Never returns a non-finite position. \throw Refusal unknown_line, bad_garment,
/// bad_option
Solution solve(const Model& model, const Garment& garment, const SolverOptions& options,
               const Solution* start = nullptr, const Progress& progress = {},
               const std::vector<PosedVolume>& body_volumes = {},
               const std::vector<geometry::LaidLine>& laid = {}, const SkinFolds& folds = {});

}  // namespace tensegric_fit::tensegric
