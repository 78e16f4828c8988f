/// Control mesh templates (P1 §3.3): nodes placed by landmark level and angle round the trunk, or on the body
/// model's skin. YAML; format: README.md beside this file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control_mesh/bone_rule.hpp"

namespace tensegric_fit::control_mesh {

/// A level (height, m) or an angle round the trunk (degrees), taken from one landmark or between two.
/// Written for her left: on her right _L and _R change places, and the middle column takes the mean of both
/// readings.
struct Reference {
  std::string landmark;
  std::string towards;  ///< empty: the value at `landmark` alone
  double at = 0;        ///< share of the way from `landmark` to `towards`
  double offset = 0;    ///< added; angles: away from the front, to either side alike
  std::string below;    ///< levels, before the offset: no higher than `by` metres below this landmark, if any
  double by = 0;
};

/// A point of the body model's skin for her left, and its share of a place there; on her right its mirror
/// image.
struct ModelPoint {
  std::string name;  ///< one of the model's skin points; empty: a vertex
  int vertex = -1;
  double share = 1;
};

/// A node of her left half or of the middle column: placed by the body, or with a name only.
struct TemplateNode {
  enum class Placing { between_others, at_landmark, level_and_angle, on_model };
  int row = 0, column = 0;
  std::string name;  ///< empty, or ending in _L; on the middle column without a side
  Placing placing = Placing::between_others;
  bool spread = true;    ///< between_others: moves to the mean of its neighbours; else it stays
  std::string landmark;  ///< at_landmark
  Reference level, angle;
  std::vector<std::string> axis;        ///< what angles are seen from, such as a leg's; empty: the template's
  std::vector<ModelPoint> on_model;     ///< on_model: shares sum to 1
  std::vector<ModelPoint> or_on_model;  ///< where it lies if the others' places turn a triangle over, or its
                                        ///< landmark is missing; empty: nowhere else
};

/// The block of grid cells between two rows and two columns (of the whole grid, both ends included).
struct TemplateRegion {
  std::string name;
  int first_row, last_row, first_column, last_column;
};

struct TemplateLine {
  std::string name;
  std::vector<std::string> through;  ///< node names, _L and _R written out
};

/// A grid of rows (downwards) and columns (from her left side over the middle to her right side), drawn for
/// her left half and mirrored. Column count is odd. Nodes that are not placed lie evenly along the skin
/// between those that are. Where no cell is, below a crotch, the grid has no nodes.
struct Template {
  std::string name;
  std::vector<std::string> axis;  ///< landmarks; the trunk's axis runs through their mean, upright or
  std::string axis_foot;          ///< leaning, over this landmark, where the body has it; empty: upright
  int rows = 0, columns = 0;
  std::vector<TemplateNode> nodes;
  /// rows-1 words of columns/2 characters: '\' joins (r,c) to (r+1,c+1), '/' joins (r+1,c) to (r,c+1), ' ' is
  /// no cell
  std::vector<std::string> diagonals;
  /// rows of columns/2+1: '#' fixed, 'o' skin that is free over bone (its inner node is fixed), '.' free
  std::vector<std::string> fixed;
  bool inner_fixed = true;  ///< are the inner nodes below fixed outer nodes fixed too
  /// Where inner nodes lie, one of three: `thickness`, rows of columns/2+1, metres; on a bone; under a
  /// cushion.
  std::vector<std::vector<double>> thickness;
  std::optional<BoneRule> bone;
  std::optional<CushionRule> cushion;
  std::vector<TemplateRegion> regions;
  std::vector<TemplateLine> lines;

  /// Of each place of the whole grid, row by row, its node; -1 where no cell touches it.
  std::vector<int> numbers;

  int middle() const { return columns / 2; }
  /// Does a node lie on the body model's skin? Then bodies need a registered model.
  bool needs_model() const;
  /// Has a node another place there?
  bool may_use_model() const;
};

/// \throw Refusal bad_template naming file and key
Template load_template(const std::string& path);

}  // namespace tensegric_fit::control_mesh
