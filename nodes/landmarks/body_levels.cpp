#include "landmarks/body_levels.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/status.hpp"

namespace tensegric_fit::landmarks {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

constexpr int kLevels = 340;  // 5 mm apart on a person of 1.70 m
constexpr double kCrotchShare =
    0.468;  // of stature, adult women (crotch height in anthropometric tables 0.45 to 0.49)
constexpr double kSmallestLegShare = 0.2;     // of the trunk's area just above; a hand has 0.05
constexpr double kSmallestChange = 0.1;       // of an area, a level on; less is a shred between the thighs
constexpr double kTrunkShareOfHeight = 0.58;  // between crotch and shoulders, with and without a head

[[noreturn]] void refuse(const std::string& what) {
  throw Refusal(refusal::kNotABody, "not a standing body: " + what);
}

void check_size(double height) {
  if (height > 10)
    throw Refusal(refusal::kWrongUnit,
                  "the body is " + std::to_string(height) + " m tall; coordinates must be in metres");
  if (height < 0.9 || height > 2.6) refuse("it is " + std::to_string(height) + " m tall");
}

// The outline that goes on from `from`, a level away: the one round its centroid, or else the nearest one
// that overlaps.
int follow(const Outline& from, const std::vector<Outline>& to) {
  int best = -1;
  double best_distance = std::max((from.high - from.low).norm() / 2, 0.03);
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (to[i].area < kSmallestChange * from.area) continue;
    if (contains(to[i], from.centroid)) return static_cast<int>(i);
    const double distance = (to[i].centroid - from.centroid).norm();
    if (distance < best_distance) {
      best = static_cast<int>(i);
      best_distance = distance;
    }
  }
  return best;
}

// Indices of the two legs that the trunk above stands on, or -1, -1.
std::array<int, 2> legs_of(const Outline& trunk, const std::vector<Outline>& below) {
  std::array<int, 2> legs{-1, -1};
  int found = 0;
  for (std::size_t i = 0; i < below.size(); ++i) {
    if (below[i].area < kSmallestLegShare * trunk.area || !contains(trunk, below[i].centroid)) continue;
    if (found < 2) legs[found] = static_cast<int>(i);
    ++found;
  }
  return found == 2 ? legs : std::array<int, 2>{-1, -1};
}

// Marks the trunk from `start` down to the legs; returns the level of the legs' first separate sections, or
// -1.
int follow_trunk_down(std::vector<Level>& levels, int start) {
  for (int i = start; i > 0; --i) {
    const Outline& trunk = levels[i].outlines[levels[i].trunk];
    levels[i - 1].legs = legs_of(trunk, levels[i - 1].outlines);
    if (levels[i - 1].legs[0] >= 0) return i - 1;
    levels[i - 1].trunk = follow(trunk, levels[i - 1].outlines);
    if (levels[i - 1].trunk < 0) return -1;
  }
  return -1;
}

void follow_legs_down(std::vector<Level>& levels, int start) {
  for (int i = start; i > 0; --i) {
    for (int k = 0; k < 2; ++k)
      if (levels[i].legs[k] >= 0)
        levels[i - 1].legs[k] = follow(levels[i].outlines[levels[i].legs[k]], levels[i - 1].outlines);
  }
}

void follow_trunk_up(std::vector<Level>& levels, int start) {
  for (int i = start; i + 1 < static_cast<int>(levels.size()) && levels[i].trunk >= 0; ++i)
    levels[i + 1].trunk = follow(levels[i].outlines[levels[i].trunk], levels[i + 1].outlines);
}

// A head: somewhere above the narrowest section over the trunk's middle, sections are wider again.
bool is_head_there(const std::vector<Level>& levels, int middle) {
  double narrowest = 1e9;
  for (std::size_t i = middle; i < levels.size() && levels[i].trunk >= 0; ++i) {
    const double area = levels[i].outlines[levels[i].trunk].area;
    narrowest = std::min(narrowest, area);
    if (area > 1.3 * narrowest && narrowest < 0.5 * levels[middle].outlines[levels[middle].trunk].area)
      return true;
  }
  return false;
}

void check_proportions(const BodyLevels& body, int middle) {
  const double square = body.stature * body.stature;
  const Level& trunk_level = body.levels[middle];
  const Outline& trunk = trunk_level.outlines[trunk_level.trunk];
  if (trunk.area < 0.004 * square || trunk.area > 0.12 * square)  // girths of about 0.22 and 1.2 statures
    refuse("its middle has not the size of a trunk");
  const Level& knees = body.levels[body.nearest(body.levels.front().height + 0.28 * body.stature)];
  const bool no_knees = knees.legs[0] < 0 || knees.legs[1] < 0;
  if (no_knees && !body.has_head) refuse("it has neither knees nor a head");
  if (no_knees) throw Refusal(std::string(refusal::kMissingPart) + ":legs", "the legs end above the knees");
  for (int k = 0; k < 2; ++k) {
    const double area = knees.outlines[knees.legs[k]].area;
    if (area < 0.0005 * square || area > 0.03 * square) refuse("what it stands on has not the size of legs");
  }
}

}  // namespace

int BodyLevels::nearest(double height) const {
  const double index = std::round((height - levels.front().height) / step);
  return static_cast<int>(std::clamp(index, 0.0, static_cast<double>(levels.size() - 1)));
}

BodyLevels find_levels(const SlicedMesh& body) {
  const double height = body.top() - body.bottom();
  check_size(height);

  // 1. Sections at even heights; the largest one at the middle is the trunk.
  BodyLevels result;
  result.step = height / kLevels;
  for (int i = 0; i < kLevels; ++i) {
    const double z = body.bottom() + (i + 0.5) * result.step;
    result.levels.push_back({z, body.outlines_at(z), -1, {-1, -1}});
  }
  std::vector<Level>& levels = result.levels;
  const int middle = static_cast<int>(kTrunkShareOfHeight * kLevels);
  if (levels[middle].outlines.empty()) refuse("nothing is at the height of a trunk");
  levels[middle].trunk = 0;

  // 2. Down to the legs, and on to the soles; up to the crown.
  const int split = follow_trunk_down(levels, middle);
  if (split < 0) refuse("no two legs under a trunk");
  follow_legs_down(levels, split);
  follow_trunk_up(levels, middle);

  result.legs_part = levels[split].height;
  result.has_head = is_head_there(levels, middle);
  result.stature = result.has_head ? height : (result.legs_part - body.bottom()) / kCrotchShare;
  check_proportions(result, middle);
  return result;
}

}  // namespace tensegric_fit::landmarks
