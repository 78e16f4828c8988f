/// What every solver is given: the model with the garment laid on it.
#pragma once

#include <chrono>
#include <vector>

#include "tensegric/band.hpp"
#include "tensegric/column_pressure.hpp"
#include "tensegric/fold_barrier.hpp"
#include "tensegric/region_volume.hpp"
#include "tensegric/skin_membrane.hpp"
#include "tensegric/solver.hpp"
#include "tensegric/unit_shear.hpp"

namespace tensegric_fit::tensegric {

struct Problem {
  const Model& model;
  const SolverOptions& options;
  std::vector<int> free_index;  ///< of each node its number among those to be solved for, or -1
  int free_nodes;
  Positions rest;
  std::vector<Band> bands;
  std::vector<RegionVolume> volumes;
  std::vector<UnitVolume> units;
  Columns columns;
  std::vector<UnitShear> shears;
  std::vector<SkinTriangle> skin;
  double force_scale;  ///< mean tension of the tensile parts at rest
  SkinFolds folds;     ///< empty: nothing is known of the skin
};

/// Where a solver is, and what the bands pull.
struct State {
  Positions x;
  std::vector<double> tensions;  ///< one per band
};

/// How a solver ended.
struct Outcome {
  State state;
  Status status = Status::capped;
  int iterations = 0;
  double residual = 0;
  std::string note;
  std::vector<double> neutral;  ///< m, one per band: what `state` balances with; empty: as asked for
};

/// What of a garment can be found wrong by the names of nodes and regions alone. \throw Refusal unknown_line,
/// bad_garment
void check_names(const geometry::ControlMesh& control, const Garment& garment);

/// \throw Refusal unknown_line, bad_garment, bad_option
Problem lay_garment(const Model& model, const Garment& garment, const SolverOptions& options,
                    const std::vector<PosedVolume>& body_volumes = {},
                    const std::vector<geometry::LaidLine>& laid = {});

/// What of a garment can be worn alone: bands, by their places in `problem`, whose pieces of the control mesh
/// nothing joins to those of the others. In the order of their first bands. One where all is joined: under
/// gravity, in a posture, and where the body's volume is kept, whose skin may follow several pieces.
std::vector<std::vector<int>> separate_bands(const Problem& problem);

/// The same problem with these bands alone: nodes of pieces that none of them touches stay where they are.
Problem with_bands(const Problem& problem, const std::vector<int>& bands);

/// The rest positions with `share` of the posture: where nodes that are not solved for belong.
Positions posed(const Problem& problem, double share);

/// Carries what is not a node to `share` of the posture: the apexes of the regions, bands on the body.
void pose_problem(Problem& problem, double share);

/// Pseudo force at which a band gives way in the equilibrium solver: its own, or what no garment pulls.
double hold_limit(const Problem& problem, const Band& band);

/// Whether skin over the nodes is turned over, as far as the caller knows.
bool skin_folds(const Problem& problem, const Positions& x);

/// The model's fixed nodes, and with a posture all inner nodes.
bool is_held(const Problem& problem, int node);

Positions positions_of(const Solution& solution);
void put_positions(const Positions& x, const Model& model, Solution& solution);
/// `elsewhere` with the nodes of `x` whose `free_index` is not negative.
Positions merged(Positions elsewhere, const Positions& x, const std::vector<int>& free_index);

/// Largest net force at a free node, relative to the mean tensile force at rest. `gradient` is the negative
/// net force; infinite where it is not finite.
double relative_residual(const Problem& problem, const Eigen::VectorXd& gradient);

/// Keeps the history and reports each iteration to the caller.
class Recorder {
 public:
  Recorder(const Problem& problem, const Progress& progress) : problem_(problem), progress_(progress) {}
  /// From here on positions mean something where `free_index` is not negative; the others are `elsewhere`.
  void look_at(std::vector<int> free_index, Positions elsewhere);
  /// False where the caller wants to stop.
  bool record(int iteration, const Positions& x, double residual, double merit_change = 0);
  double seconds() const;  ///< since it was made
  std::vector<Iterate> history;

 private:
  const Problem& problem_;
  const Progress& progress_;
  std::vector<int> free_index_;  // of what is looked at, empty: of all nodes
  Positions elsewhere_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace tensegric_fit::tensegric
