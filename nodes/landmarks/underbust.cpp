#include <algorithm>
#include <cmath>
#include <functional>

#include "landmarks/bust.hpp"
#include "landmarks/fold_arc.hpp"
#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kMedialReach = 0.055;      // metres, from the definition of the underbust level
constexpr double kApart = 0.005;            // between two profiles
constexpr int kMedial = 11;                 // profiles from the bust point's to the reach's end
constexpr int kOutside = 4, kInside = 9;    // further profiles to both sides, where a pocket's ends are seen
constexpr int kWallFrom = 3, kWallTo = 18;  // millimetres from the fold along the walls of a pocket
constexpr int kReach = 8;                   // millimetres each way over which a profile's hollowness is taken
constexpr double kRim = 0.012;              // metres along the skin; the nipple's own rim is hollow too
constexpr double kSteepest = 2;             // of a fold seen from the front
// Statures under the bust point: folds are 0.01 to 0.05 below, a big belly's own fold over the groin 0.08 or
// more.
constexpr double kBelow = 0.08;
constexpr double kAbove = 0.02;
constexpr double kHollow = 15;  // 1/m: a radius of 70 mm is a rib cage's roundness, not a fold

constexpr double kSharpest =
    120;  // 1/m: a fold is no sharper on a mesh; more is noise, or a cut along a flank

// A place on one of the profiles side by side, and the best way of a fold to it.
struct Place {
  Vector3d point;
  double hollowness;
  double opening;
  double sum;  // of hollowness along the way
  int before;  // on the profile before, -1 on the first
};

using Places = std::vector<Place>;

// Places below the bust point on the profile at lateral position y, from top to bottom.
Places places_below(const BodyShape& body, const std::vector<int>& skin, const Vector3d& bust_point,
                    double y) {
  const Profile profile = cut_profile(body, skin, {bust_point.x(), y, bust_point.z()}, Vector3d::UnitX());
  Places places;
  const int count = static_cast<int>(profile.points.size());
  // No skin of the breast in this plane.
  if (count == 0 || profile.points.front().z() < bust_point.z()) return places;
  int level = 0;  // of the bust point; the fold of a breast that hangs can be as high
  while (level < count && profile.points[level].z() > bust_point.z()) ++level;
  for (int i = level + static_cast<int>(kRim / profile.step); i < count; ++i) {
    const double hollowness = std::clamp(profile.hollowness(i, kReach), 0.0, kSharpest);
    places.push_back({profile.points[i], hollowness, profile.opening(i, kWallFrom, kWallTo), hollowness, -1});
  }
  return places;
}

// Carries the ways on from profile to profile. False where there is nowhere to go.
bool carry_on(const Places& from, Places& to) {
  bool any = false;
  for (Place& next : to) {
    double best = -1;
    for (int i = 0; i < static_cast<int>(from.size()); ++i) {
      if (from[i].sum <= best || std::abs(from[i].point.z() - next.point.z()) > kSteepest * kApart) continue;
      best = from[i].sum;
      next.before = i;
    }
    next.sum = next.before < 0 ? -1 : best + next.hollowness;
    any = any || next.before >= 0;
  }
  return any;
}

// The fold runs on smoothly from profile to profile: of all such ways the one that is most hollow in sum.
// `places_on` gives the places of the next profile; the first ones are given, or are those of the first
// profile that has any.
Places most_hollow_way(Places first, int profiles_ahead, const std::function<Places(int)>& places_on) {
  std::vector<Places> profiles;
  if (!first.empty()) profiles.push_back(std::move(first));
  for (int k = 0; k < profiles_ahead; ++k) {
    Places places = places_on(k);
    if (profiles.empty()) {
      if (!places.empty()) profiles.push_back(std::move(places));
      continue;
    }
    if (!carry_on(profiles.back(), places)) break;
    profiles.push_back(std::move(places));
  }
  Places way;
  if (profiles.empty()) return way;
  const auto less = [](const Place& a, const Place& b) { return a.sum < b.sum; };
  way.push_back(*std::max_element(profiles.back().begin(), profiles.back().end(), less));
  for (std::size_t k = profiles.size() - 1; k-- > 0;) way.push_back(profiles[k][way.back().before]);
  std::reverse(way.begin(), way.end());
  return way;
}

// The profiles under one breast: number k lies 5 mm times k medial of the bust point.
struct Breast {
  const BodyShape& body;
  std::vector<int> skin;
  Vector3d bust_point;
  double inwards;  // sign of y

  Places places_on(int k) const {
    return places_below(body, skin, bust_point, bust_point.y() + inwards * k * kApart);
  }
  double medial(double y) const { return (y - bust_point.y()) * inwards; }
  std::vector<FoldPlace> as_fold(const Places& way) const {
    std::vector<FoldPlace> fold;
    for (const Place& place : way)
      fold.push_back({medial(place.point.y()), place.point.z(), place.hollowness, place.opening});
    return fold;
  }
  int profile_of(const Place& place) const {
    return static_cast<int>(std::lround(medial(place.point.y()) / kApart));
  }
};

Breast breast_of(const BodyShape& body, const Vector3d& bust_point, Side side) {
  const double s = body.stature, inwards = -kSign[side];
  const double medial = bust_point.y() + inwards * ((kMedial + kInside) * kApart + 0.01),
               lateral = bust_point.y() - inwards * (kOutside * kApart + 0.01);
  return {body,
          triangles_in_box(
              body, {bust_point.x() - 0.12 * s, std::min(medial, lateral), bust_point.z() - kBelow * s},
              {bust_point.x() + 0.03 * s, std::max(medial, lateral), bust_point.z() + kAbove * s}),
          bust_point, inwards};
}

// From `end` on over so many profiles more, outwards or inwards.
Places onward(const Breast& breast, const Place& end, int profiles, int step) {
  Place start = end;
  start.sum = 0;
  const int from = breast.profile_of(end);
  Places way =
      most_hollow_way({start}, profiles, [&](int k) { return breast.places_on(from + step * (k + 1)); });
  way.erase(way.begin());
  return way;
}

// The fold within reach and its ends to both sides, to the middle of the chest at most.
std::vector<FoldPlace> whole_fold(const Breast& breast, const Places& way, double middle) {
  const int last = std::min(kMedial + kInside, static_cast<int>(breast.medial(middle) / kApart));
  Places whole = onward(breast, way.front(), kOutside, -1);
  std::reverse(whole.begin(), whole.end());
  whole.insert(whole.end(), way.begin(), way.end());
  const Places inside = onward(breast, way.back(), last - breast.profile_of(way.back()), 1);
  whole.insert(whole.end(), inside.begin(), inside.end());
  return breast.as_fold(whole);
}

// On the outside the breast can run out into the flank, at the sternum into the other one: the fold is where
// the way is hollow without a break, and most in sum, as a cut that grazes the flank is hollow too.
Places hollow_stretch(const Places& way) {
  const auto is_hollow = [](const Place& place) { return place.hollowness >= kHollow; };
  Places most;
  double largest = 0;
  for (auto first = way.begin(); first != way.end();) {
    first = std::find_if(first, way.end(), is_hollow);
    const auto last = std::find_if_not(first, way.end(), is_hollow);
    double sum = 0;
    for (auto place = first; place != last; ++place) sum += place->hollowness;
    if (sum > largest) {
      largest = sum;
      most = Places(first, last);
    }
    first = last;
  }
  return most;
}

}  // namespace

Fold find_fold(const BodyShape& body, const Vector3d& bust_point, double middle, Side side) {
  const Breast breast = breast_of(body, bust_point, side);
  const Places way = most_hollow_way({}, kMedial + 1, [&](int k) { return breast.places_on(k); });
  const Places hollow = hollow_stretch(way);
  if (hollow.empty()) {
    const Vector3d guess = bust_point - 0.035 * body.stature * Vector3d::UnitZ();
    return {guess, guess.z(), 0.2, "no fold under the breast"};
  }
  Fold fold;
  fold.below_bust_point = hollow.front().point;
  fold.lowest = lowest_of_arc(breast.as_fold(hollow), kMedialReach);
  fold.confidence = 0.9;

  // On a mesh without any skin that was not seen, what looks like a fold is one.
  if (std::none_of(body.filled.begin(), body.filled.end(), [](char unseen) { return unseen != 0; }))
    return fold;
  const std::vector<FoldPlace> whole = whole_fold(breast, way, middle);
  fold.hidden = fold_above_pocket(whole, fold.lowest, kMedialReach);
  fold.in_pocket = lies_in_pocket(whole, kMedialReach);
  if (fold.in_pocket) {
    fold.confidence = 0.45;
    fold.reason = fold.hidden > 0
                      ? "the breast hangs over its fold, which the scan did not see; told by the fold's ends"
                      : "the fold lies up a narrow pocket, to whose end the scan may not have seen";
  }
  return fold;
}

}  // namespace tensegric_fit::landmarks
