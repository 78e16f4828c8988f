/// Garments: constraining lines with neutral lengths and tension laws (P1 §3.5, P2 §4;
/// launch/pages/garments_and_templates.md).
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "geometry/range.hpp"

namespace tensegric_fit::tensegric {

/// What files and command lines may ask for: beyond lies a slip of the pen, not a garment.
/// `kTension`: pseudo force, of limits and stiffnesses; `kLineWidth`: m, of `smooth` too.
inline constexpr geometry::Range kRatio{0.05, 10}, kTension{0, 1e9}, kLineWidth{0, 0.2};
/// What files say of a line by `through` that does not state them, m: a band of cloth, not the papers'
/// string.
inline constexpr double kBandWidth = 0.030, kBandSmooth = 0.020;

/// How the one tension T along a line follows from its length L and neutral length l. A line never pushes.
struct TensionLaw {
  enum class Kind { rigid, stiffness, table };
  Kind kind = Kind::rigid;                       ///< rigid: L <= l exactly
  double stiffness = 0;                          ///< T = stiffness * max(0, L/l - 1), pseudo force
  std::vector<std::pair<double, double>> table;  ///< (L/l, T), both ascending, linear in between
};

struct GarmentLine {
  std::string name;
  double ratio = 1;  ///< neutral length / length at rest
  TensionLaw law;
  double tension_limit = std::numeric_limits<double>::infinity();  ///< pseudo force
  std::vector<std::string>
      through;        ///< names of control nodes; empty: the control mesh's own line of this name
  bool taut = false;  ///< straight from stop to stop; else over the control mesh's edges, or over the skin
  std::vector<Eigen::Vector3d> points{};  ///< in place of `through`: on the body, scan frame, m
  /// m: the band is `width` wide (0: a string, by `through` one over the control mesh itself, as in the
  /// papers), and its fibres average over `smooth` to either side along it.
  double width = 0, smooth = 0;
  /// Of a line by points: does bone hold its first and its last end, so that it stays in space and moves with
  /// the posture? Else the skin carries it. A line by `through` ends as its last node does.
  std::array<bool, 2> held{true, true};

  /// Of a cup, else empty: names of control nodes in a row. From the last node of `through` on its fibres
  /// spread over the skin, and end evenly along that row.
  std::vector<std::string> fan{};

  /// Whether it lies on the dense body, and has to be laid there.
  bool on_body() const { return !points.empty() || width > 0; }
};

struct Garment {
  std::string name;
  std::vector<std::string> regions;
  std::vector<GarmentLine> lines;
};

/// What holds each end, as files and messages say it.
inline constexpr const char *kHeldByBone = "bone", *kCarriedBySkin = "skin";
/// In messages a cup's row of nodes comes after those of `through` and this word.
inline constexpr const char* kFan = "fan";
/// \throw Refusal bad_garment beginning with `where`: not two words, or others
std::array<bool, 2> held_in(const std::vector<std::string>& words, const std::string& where);

/// The rules of a line, from wherever it was read; a table that begins beyond stretch 1 gets a row there.
/// \throw Refusal bad_garment beginning with `where`
void check_line(GarmentLine& line, const std::string& where);

/// \throw Refusal bad_garment naming file and key
Garment load_garment(const std::string& path);

/// The garment that `words` mean: a name in `folder` or a file, or several of them worn at once, joined by
/// '+' (B1+H2), as their own names are in its name. \throw Refusal bad_garment: no such garment; two of them
/// have a line of the same name
Garment take_garment(const std::string& words, const std::string& folder);

/// Sets the ratio of the line of that name, or of every line where `line` is empty. \throw Refusal
/// unknown_line; bad_garment: ratio out of range
void set_ratio(Garment& garment, const std::string& line, double ratio);

}  // namespace tensegric_fit::tensegric
