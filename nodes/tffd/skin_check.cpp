#include "tffd/skin_check.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"
#include "geometry/triangle_mesh.hpp"
#include "tffd/skin_place.hpp"

namespace tensegric_fit::tffd {
namespace {

using geometry::FitWarning;

constexpr double kShare = 0.1;  // of all the shelf: less is no place of its own

// What became of a triangle.
struct Change {
  int triangle;
  double area;         // at rest, m^2
  double turn;         // rad
  double most, least;  // principal stretches
};

// Squares of the principal stretches are the eigenvalues of F^T F, whose trace and determinant follow from
// the dot products of two sides before (P) and after (Q): tr(P^-1 Q), det Q / det P.
void stretch(const Eigen::Vector3d& u0, const Eigen::Vector3d& v0, const Eigen::Vector3d& u1,
             const Eigen::Vector3d& v1, double before, double after, Change& change) {
  const double trace =
      (v0.dot(v0) * u1.dot(u1) - 2 * u0.dot(v0) * u1.dot(v1) + u0.dot(u0) * v1.dot(v1)) / (before * before);
  const double product = after / before;
  const double root = std::sqrt(std::max(0.0, trace * trace / 4 - product * product));
  change.most = std::sqrt(trace / 2 + root);
  change.least = change.most > 0 ? product / change.most : 0;
}

std::vector<Change> changes_of(const WornSkin& skin) {
  std::vector<char> moved(skin.rest.size());
  for (std::size_t v = 0; v < moved.size(); ++v) moved[v] = skin.rest[v] != skin.worn[v];
  std::vector<Change> changes;
  for (std::size_t i = 0; i < skin.triangles.size(); ++i) {
    const Eigen::Vector3i& t = skin.triangles[i];
    if (!moved[t[0]] && !moved[t[1]] && !moved[t[2]]) continue;
    const Eigen::Vector3d u0 = skin.rest[t[1]] - skin.rest[t[0]], v0 = skin.rest[t[2]] - skin.rest[t[0]],
                          u1 = skin.worn[t[1]] - skin.worn[t[0]], v1 = skin.worn[t[2]] - skin.worn[t[0]],
                          before = u0.cross(v0), after = u1.cross(v1);
    const double area = before.norm();
    if (area == 0) continue;  // a needle without area has no normal
    Change change{static_cast<int>(i), area / 2, std::atan2(before.cross(after).norm(), before.dot(after)), 1,
                  1};
    stretch(u0, v0, u1, v1, area, after.norm(), change);
    changes.push_back(change);
  }
  return changes;
}

// Places of the triangles that `is` picks, in the order of their first triangle.
template <typename Is>
std::vector<std::vector<Change>> pieces(const WornSkin& skin, const std::vector<Change>& changes, Is is) {
  std::vector<Change> picked;
  std::copy_if(changes.begin(), changes.end(), std::back_inserter(picked), is);
  std::vector<int> triangles;
  for (const Change& change : picked) triangles.push_back(change.triangle);
  std::vector<std::vector<Change>> found;
  for (const std::vector<int>& place : places_of(triangles, skin.triangles)) {
    found.emplace_back();
    for (const int i : place) found.back().push_back(picked[i]);
  }
  return found;
}

double area_of(const std::vector<Change>& piece) {
  double area = 0;
  for (const Change& change : piece) area += change.area;
  return area;
}

double area_beyond(const std::vector<Change>& piece, double turn) {
  double area = 0;
  for (const Change& change : piece)
    if (change.turn > turn) area += change.area;
  return area;
}

double turn_of(const Change& change) {
  return change.turn;
}

// The largest (or least) value that a grain of the piece reaches.
template <typename Value>
double extreme(std::vector<Change> piece, Value value, bool largest) {
  std::stable_sort(piece.begin(), piece.end(), [&](const Change& a, const Change& b) {
    return largest ? value(a) > value(b) : value(a) < value(b);
  });
  double area = 0;
  for (const Change& change : piece)
    if ((area += change.area) >= kGrain) return value(change);
  return value(piece.back());
}

FitWarning warning_of(const char* code, const std::vector<Change>& piece, double value, const WornSkin& skin,
                      const std::vector<WornLine>& lines) {
  std::vector<int> triangles;
  for (const Change& change : piece) triangles.push_back(change.triangle);
  FitWarning warning = warning_at(code, triangles, value, skin, lines);
  warning.shelf_area = area_beyond(piece, kShelf);
  return warning;
}

void append_sorted(std::vector<FitWarning> found, std::vector<FitWarning>& all) {
  std::stable_sort(found.begin(), found.end(),
                   [](const FitWarning& a, const FitWarning& b) { return a.area > b.area; });
  for (FitWarning& warning : found) all.push_back(std::move(warning));
}

void check_turns(const WornSkin& skin, const std::vector<Change>& changes, const std::vector<WornLine>& lines,
                 std::vector<FitWarning>& all) {
  const auto places = pieces(skin, changes, [](const Change& c) { return c.turn > kTurned; });
  double shelf = 0, largest = 0;
  for (const auto& piece : places) {
    shelf += area_beyond(piece, kShelf);
    largest = std::max(largest, area_beyond(piece, kShelf));
  }
  const bool is_shelf = shelf >= kLeastPatch;
  const double least_shelf = std::min(kShare * shelf, largest);  // one place is named at least
  const auto is_named = [&](const std::vector<Change>& piece) {
    if (is_shelf) return area_beyond(piece, kShelf) >= least_shelf;
    return area_of(piece) >= kLeastPatch || area_beyond(piece, kTurnedOver) >= kGrain;
  };
  std::vector<FitWarning> turned, over;
  for (const auto& piece : places)
    if (is_named(piece))
      turned.push_back(warning_of(is_shelf ? geometry::warning::kShelf : geometry::notice::kSkinTurns, piece,
                                  extreme(piece, turn_of, true), skin, lines));
  for (const auto& piece : pieces(skin, changes, [](const Change& c) { return c.turn > kTurnedOver; }))
    if (is_shelf && area_of(piece) >= kGrain)
      over.push_back(
          warning_of(geometry::warning::kTurnedOver, piece, extreme(piece, turn_of, true), skin, lines));
  append_sorted(std::move(turned), all);
  append_sorted(std::move(over), all);
}

}  // namespace

bool turns_over(const WornSkin& skin) {
  double over = 0;
  for (const Eigen::Vector3i& t : skin.triangles) {
    const Eigen::Vector3d after = geometry::area_vector(skin.worn[t[0]], skin.worn[t[1]], skin.worn[t[2]]),
                          before = geometry::area_vector(skin.rest[t[0]], skin.rest[t[1]], skin.rest[t[2]]);
    if (before.dot(after) < 0) over += before.norm() / 2;
  }
  return over >= kGrain / 2;
}

std::vector<FitWarning> check_skin(const WornSkin& skin, const std::vector<WornLine>& lines) {
  if (skin.worn.size() != skin.rest.size())
    throw geometry::Refusal(geometry::refusal::kBadMesh, "skin check: not one worn place a vertex");
  const std::vector<Change> changes = changes_of(skin);
  std::vector<FitWarning> all, stretched, pressed;
  if (!lines.empty()) check_turns(skin, changes, lines, all);
  const auto most = [](const Change& c) { return c.most; };
  const auto least = [](const Change& c) { return c.least; };
  for (const auto& piece : pieces(skin, changes, [](const Change& c) { return c.most > kMostStretch; }))
    if (area_of(piece) >= kLeastPatch)
      stretched.push_back(
          warning_of(geometry::notice::kOverStretched, piece, extreme(piece, most, true), skin, lines));
  for (const auto& piece : pieces(skin, changes, [](const Change& c) { return c.least < kLeastStretch; }))
    if (area_of(piece) >= kLeastPatch)
      pressed.push_back(
          warning_of(geometry::notice::kPressedTogether, piece, extreme(piece, least, false), skin, lines));
  append_sorted(std::move(stretched), all);
  append_sorted(std::move(pressed), all);
  return all;
}

}  // namespace tensegric_fit::tffd
