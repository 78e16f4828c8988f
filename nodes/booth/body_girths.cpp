#include "booth/body_girths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/section.hpp"

namespace tensegric_fit::booth {
namespace {

using Eigen::Vector3d;

enum class Part { trunk, arm };

class Tape {
 public:
  Tape(const BodyShape& shape, const geometry::TriangleMesh& mesh) : mesh_(mesh) {
    std::vector<char> vertex(mesh.vertices.size());
    for (std::size_t v = 0; v < vertex.size(); ++v) vertex[v] = shape.is_arm(mesh.vertices[v]);
    for (const Eigen::Vector3i& t : mesh.triangles)
      is_arm_.push_back(vertex[t[0]] + vertex[t[1]] + vertex[t[2]] >= 2);
  }

  // What each loop of the section has of that part of the body.
  std::vector<std::vector<Vector3d>> loops(const Vector3d& origin, const Vector3d& normal, Part part) const {
    std::vector<std::vector<Vector3d>> result;
    for (const geometry::SectionLoop& loop : geometry::plane_section(mesh_, origin, normal)) {
      std::vector<Vector3d> points;
      for (std::size_t i = 0; i < loop.triangles.size(); ++i)
        if ((is_arm_[loop.triangles[i]] != 0) == (part == Part::arm)) points.push_back(loop.points[i]);
      if (!points.empty()) result.push_back(std::move(points));
    }
    return result;
  }

  // The tape round everything of the trunk at this height.
  std::vector<Vector3d> round_trunk(double height) const {
    std::vector<Vector3d> all;
    for (const auto& loop : loops({0, 0, height}, Vector3d::UnitZ(), Part::trunk))
      all.insert(all.end(), loop.begin(), loop.end());
    return geometry::tape(all, Vector3d::UnitZ());
  }

  // The tape round the loop of that part whose middle is nearest to `origin`.
  std::vector<Vector3d> round_nearest(const Vector3d& origin, const Vector3d& normal, Part part) const {
    std::vector<Vector3d> best;
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& loop : loops(origin, normal, part)) {
      Vector3d middle = Vector3d::Zero();
      for (const Vector3d& p : loop) middle += p / static_cast<double>(loop.size());
      if ((middle - origin).norm() >= nearest) continue;
      nearest = (middle - origin).norm();
      best = geometry::tape(loop, normal);
    }
    return best;
  }

 private:
  const geometry::TriangleMesh& mesh_;
  std::vector<char> is_arm_;
};

double length(const std::vector<Vector3d>& tape) {
  return geometry::length_of(tape, true);
}

// Heights from low to high in steps.
std::vector<double> levels(double low, double high, double step) {
  std::vector<double> result;
  for (int i = 0; low + i * step <= high; ++i) result.push_back(low + i * step);
  return result;
}

double largest_girth_height(const Tape& tape, double low, double high) {
  double best = low, girth = 0;
  for (const double z : levels(low, high, 0.005)) {
    const double here = length(tape.round_trunk(z));
    if (here > girth) {
      girth = here;
      best = z;
    }
  }
  return best;
}

// The least girth in between, where it is so much less than at both ends that no two tapes disagree.
std::optional<double> waist_height(const Tape& tape, double middle, double low, double high) {
  const std::vector<double> heights = levels(low, high, 0.005);
  std::vector<double> girths;  // breasts that hang down to the waist are not part of it
  for (const double z : heights)
    girths.push_back(length(tape.round_nearest({middle, 0, z}, Vector3d::UnitZ(), Part::trunk)));
  std::optional<std::size_t> least;
  for (std::size_t i = 1; i + 1 < girths.size(); ++i)
    if (girths[i] < girths[i - 1] && girths[i] <= girths[i + 1] && (!least || girths[i] < girths[*least]))
      least = i;
  constexpr double kFelt = 0.005;
  if (!least || std::min(girths.front(), girths.back()) - girths[*least] < kFelt) return std::nullopt;
  // Top of the parabola through the three
  const double below = girths[*least - 1], at = girths[*least], above = girths[*least + 1];
  return heights[*least] + 0.005 * 0.5 * (below - above) / (below - 2 * at + above);
}

}  // namespace

std::string measure_girths(const BodyShape& shape, const geometry::TriangleMesh& mesh,
                           geometry::BodyMeasures& measures) {
  const Tape tape(shape, mesh);
  const auto height = [&measures](const std::string& name, double metres) {
    measures.heights.push_back({name, metres, 1.0, ""});
    return metres;
  };
  const auto girth = [&measures](const std::string& name, const std::vector<Vector3d>& loop) {
    measures.girths.push_back({name, length(loop), 1.0, ""});
    measures.loops.push_back({name, loop});
  };
  const auto z_of = [&measures](const std::string& name) { return measures.landmark(name).z(); };

  const double bust = height("bust", (z_of("bust_point_L") + z_of("bust_point_R")) / 2);
  const double underbust = height("underbust", std::min(z_of("fold_lowest_L"), z_of("fold_lowest_R")));
  const double hip = height("hip", (z_of("buttock_L") + z_of("buttock_R")) / 2);
  const double crotch = height("crotch", z_of("crotch"));
  const std::optional<double> narrowest =
      waist_height(tape, shape.posed({0.05, 0, 1.10}).x(), hip + 0.10, underbust - 0.015);
  const double ruler = height("waist_ruler", z_of("navel"));
  const double waist = height("waist", narrowest.value_or(ruler));
  const double hip_max = height("hip_max_girth", largest_girth_height(tape, crotch, waist));
  const double bust_max = height("bust_max", largest_girth_height(tape, underbust, bust + 0.04));
  const BodyShape::Axis neck = shape.neck_axis();
  height("neck", neck.origin.z());
  height("stature", geometry::bounding_box(mesh.vertices)[1].z());

  girth("bust", tape.round_trunk(bust));
  girth("bust_max", tape.round_trunk(bust_max));
  girth("underbust", tape.round_nearest({shape.posed({0.05, 0, 1.15}).x(), 0, underbust - 0.003},
                                        Vector3d::UnitZ(), Part::trunk));
  girth("waist", tape.round_trunk(waist));
  girth("waist_ruler", tape.round_trunk(ruler));
  girth("hip", tape.round_trunk(hip));
  girth("hip_max", tape.round_trunk(hip_max));
  girth("neck", tape.round_nearest(neck.origin, neck.direction, Part::trunk));
  for (const bool left : {true, false}) {
    const std::string suffix = left ? "_L" : "_R";
    const BodyShape::Axis arm = shape.upper_arm_axis(left);
    const double axilla = (measures.landmark("axilla" + suffix) - arm.origin).dot(arm.direction);
    girth("upper_arm" + suffix,
          tape.round_nearest(arm.origin + (axilla + shape.scaled(0.087)) * arm.direction, arm.direction,
                             Part::arm));
    // The thighbone runs forward as it goes down
    const Vector3d thigh(shape.scaled(0.05), (left ? 1 : -1) * shape.posed({0, 0.096, 0.73}).y(),
                         crotch - shape.scaled(0.066));
    girth("thigh" + suffix, tape.round_nearest(thigh, Vector3d(-0.12, 0, 1).normalized(), Part::trunk));
  }
  return narrowest ? "interior minimum of the hull girth" : "no interior minimum: ruler level";
}

}  // namespace tensegric_fit::booth
