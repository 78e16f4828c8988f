/// The tensegric model on a control mesh (P1 §3.1-3.2, P2 §2.1; README.md).
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "geometry/enum_words.hpp"
#include "geometry/range.hpp"

namespace tensegric_fit::tensegric {

/// Node positions: outer node i at i, inner node i at V + i, then those between them, level by level from
/// outside. Metres, the scan's frame.
using Positions = std::vector<Eigen::Vector3d>;

/// Whether inner nodes settle (the papers) or are bound to the bones below them (P2 §6).
enum class InnerNodes { free, bound };
inline constexpr geometry::EnumWords<InnerNodes, 2> kInnerWords{{"free", "bound"}};

std::string to_string(InnerNodes inner);
/// \throw Refusal bad_option naming the word and the choices
InnerNodes inner_nodes_from(const std::string& word);

/// Tissue unlike the rest, from a scar or a prosthesis: units whose skin lies around a named node.
struct StiffPart {
  std::string around;  ///< node of the control mesh
  double radius;       ///< m, at rest
  double times;        ///< as stiff as tissue elsewhere; where parts overlap, the product
};
inline constexpr geometry::Range kStiffRadius{0.005, 0.3}, kStiffTimes{0.1, 100};

/// From "NODE RADIUS TIMES", as in tissue files and parameters. \throw Refusal bad_option quoting it
StiffPart stiff_part_from(const std::string& text);
std::string to_string(const StiffPart& part);

/// Field defaults are the parameters' defaults. A part's stiffness k (force per strain) is its kind's share
/// here times the tissue that it stands for / its length, so that a finer mesh is as stiff as a coarse one.
struct ModelOptions {
  InnerNodes inner = InnerNodes::bound;
  int layers = 1;        ///< of units, one below the other, between the skin and the inner nodes
  bool uniform = false;  ///< all parts of a kind have one k, as in the papers, whatever tissue they stand for
  double strut_stiffness = 0.55;    ///< of struts; edges have 1. The papers' rigid strut is the limit
  double lateral_stiffness = 0.44;  ///< of the tensile parts from outer to inner node
  double skin = 0.0061;             ///< m of tissue that the skin is as stiff as; equilibrium solver only
  double volume_stiffness = 5.1;    ///< pressure per relative change of volume; equilibrium solver only
  double shear_stiffness = 0.18;    ///< shear modulus of units, alike in all directions; likewise
  double modulus = 1510;   ///< Pa, of tissue for which a kind's share is 1: what forces are in newtons
  double stiffening = 59;  ///< of struts, tensile parts and units: k (1 + stiffening e^2) at strain e
  double prestress = 0.1;  ///< mean tension of a piece's tensile parts at rest / their mean k, at most
  std::vector<StiffPart> stiff_parts;
};
inline constexpr geometry::Range kLayers{1, 8};

/// The numbers among them, by the names of parameters and of keys in tissue files, with what they may be.
struct ModelNumber {
  const char* name;
  double ModelOptions::*field;
  geometry::Range range;
};
inline constexpr ModelNumber kModelNumbers[] = {
    {"strut_stiffness", &ModelOptions::strut_stiffness, {1e-3, 1e6}},
    {"lateral_stiffness", &ModelOptions::lateral_stiffness, {1e-3, 1e3}},
    {"skin", &ModelOptions::skin, {0, 10}},
    {"volume_stiffness", &ModelOptions::volume_stiffness, {0, 1e3}},
    {"shear_stiffness", &ModelOptions::shear_stiffness, {0, 1e3}},
    {"stiffening", &ModelOptions::stiffening, {0, 1e4}},
    {"modulus", &ModelOptions::modulus, {1, 1e7}},
    {"prestress", &ModelOptions::prestress, {1e-6, 0.5}},
};

/// As the papers have it, but for the struts' stiffness: inner nodes settle, no skin, units that may change
/// their volumes. What shapes without bones need.
ModelOptions papers_model();

/// A strut (two-way spring) or a tensile part (pulls only) between two nodes. Forces are pseudo forces: the
/// tensile parts' mean stiffness is 1.
struct Member {
  int a, b;  ///< nodes, see Positions
  bool strut;
  double stiffness;   ///< force / strain
  double rest;        ///< length at rest, m
  double natural;     ///< length at zero force, m
  double stiffening;  ///< see ModelOptions
};

struct Model {
  geometry::ControlMesh control;  ///< at rest
  std::vector<Member> members;    ///< 3F struts a layer, then tensile parts: E a level, V a layer
  ModelOptions options;
  std::vector<double> times;  ///< per triangle: as stiff as tissue elsewhere (ModelOptions::stiff_parts)
  double tissue = 1;          ///< stiffness of tissue, pseudo force / m^2: what 1 means in ModelOptions
  double newtons() const { return options.modulus / tissue; }  ///< per pseudo force
  int struts() const;
  int tensile_parts() const;
  int nodes() const;
  int free_nodes() const;
  int first_node(int level) const;                ///< 0: the skin; as many as layers: the inner nodes
  std::vector<std::array<int, 6>> units() const;  ///< prisms: corners of the upper triangle, then those below
  bool is_fixed(int node) const;
  std::vector<int> free_index() const;  ///< of each node its number among the free ones, or -1
  Positions rest_positions() const;
  /// Pieces of the control mesh, connected by its triangles: of each of its nodes, and of each member.
  std::vector<int> piece_of_nodes() const;
  std::vector<int> piece_of_members() const;
  double mean_tension() const;  ///< of the tensile parts at rest, pseudo force
};

/// Members and prestress of the control mesh, its inner nodes fixed where they are to be bound, such that the
/// undeformed model is in exact equilibrium. Two struts cross in a side face between two triangles, which
/// mirrors; a side face on the rim has one, so that a model is mirror-symmetric where the rim's inner nodes
/// are fixed (else to some 10 micrometres). \throw Refusal bad_mesh, bad_option
Model build_model(const geometry::ControlMesh& control, const ModelOptions& options);

}  // namespace tensegric_fit::tensegric
