/// A figure as mesh and body model have it, and what to make of the two.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tensegric_fit::landmarks {

/// How far off a reading is, m, on bodies whose truth is known: on average by `bias` (of heights and girths;
/// of points 0), round that by the root of (base * (Figure::misfit / 2 mm)^growth)^2, (support *
/// Figure::support)^2 and, on the mesh, (shift * Figure::shift)^2. Readings on the mesh may grow with misfit,
/// too: some are looked for near the model's. On a body that the model cannot make, by `outside` more, as
/// squares.
struct Spread {
  double bias, base, growth, support, outside = 0, shift = 0;
};

/// From misfits that 95 % of scanned women stay below to the median of bodies outside the model's span, m:
/// between them a body is taken to be outside in part.
struct Span {
  double women = std::numeric_limits<double>::infinity(), others = women;
};

/// Of one figure.
struct FigurePrecision {
  Spread mesh, model;
  double disagreement;         ///< share of the distance between the two readings that counts as error
  double half_width;           ///< of the 95 % interval, in spreads, where the mesh has a say
  double half_width_of_model;  ///< the same where the figure rests on the model
};

/// Of all figures, for meshes that were given and for scans: what tests/body_model/fit_precision.py and
/// fit_outside.py write.
struct Precision {
  std::map<std::string, FigurePrecision> of_mesh,
      of_scan;  ///< by "girth bust", "height hip", "point bust_point" (both sides)
  Span mesh_span, scan_span;
};

/// \throw Refusal broken_file
Precision load_precision(const std::string& path);

/// The shipped one, loaded once. \throw Refusal broken_file
const Precision& shipped_precision();

enum class Kind { point, height, girth };

struct Figure {
  Kind kind;
  std::string name;
  std::optional<Eigen::Vector3d> on_mesh, on_model;  ///< body frame, m; of heights and girths x alone
  double support = 0;                                ///< m: RegisteredBody::support there
  double misfit = 0;                                 ///< m: RegisteredBody::residual
  std::vector<Eigen::Vector3d> loop;                 ///< of a girth: the tape on the mesh, body frame
  bool seen =
      false;  ///< the reading on the mesh lies on skin that the scan backs: it may be far from the model's
  double ground = 0;  ///< m: of heights, RegisteredBody::ground_deviation: both readings are off by the same
  double shift = 0;   ///< m: Nipple::shift; 0 of figures without
  double shared = 0;  ///< m: a deviation that both readings have in common, and in words why
  std::string shared_reason = {};
  std::vector<Eigen::Vector3d> loop_on_model = {};
};

/// A settled figure.
struct Settled {
  Eigen::Vector3d value;
  double half_width;    ///< m, of the 95 % interval; of a point, the radius
  bool rests_on_model;  ///< the mesh does not show it, or shows something else
};

/// The tape of a settled girth: on the surface that its value is from.
const std::vector<Eigen::Vector3d>& tape_of(const Figure& figure, const Settled& settled);

/// How far off the model's reading of a figure may be on a body of the model's span, m: what windows of
/// searches were fitted with. Its values are not read.
double spread_of_model(const Figure& figure, const Precision& precision, bool scanned);

/// Mesh and model weighted by how far off each may be.
Settled settle(const Figure& figure, const Precision& precision, bool scanned);

/// What ISO 20685 allows, m.
double limit_of(const Figure& figure);

/// 0 to 1: 0.5 where the interval is one and a half times as wide as ISO 20685 allows.
double confidence_of(const Figure& figure, const Settled& settled);

/// Why the interval is wide, for the one who reads the report.
std::string reason_of(const Figure& figure, const Settled& settled);

}  // namespace tensegric_fit::landmarks
