#include "random_solve.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <random>

#include "../stability/shapes.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::solver_fuzz {
namespace {

using Eigen::Vector3d;
using stability::Case;
using tensegric::Solution;
using tensegric::SolverName;
using tensegric::Status;

constexpr int kMostUnits = 2500;  // triangles x layers: above it, single solves take minutes
constexpr double kGrace = 1.0;    // s beyond the cap: the step that is under way
constexpr double kSmall = 1.7;    // power of a uniform share of the way from 60 to 2,000 triangles, on a
                                  // logarithmic scale: most hard cases need few triangles

struct Bump {
  double x, y, width, height;
};

// Of the processor, by all threads of this process.
double seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Signed volume below the region's triangles, from the origin; its change is that of the region, whose rim is
// fixed.
double volume_below(const geometry::ControlMesh& control, const geometry::ControlRegion& region,
                    const std::vector<Vector3d>& outer) {
  double six = 0;
  for (int t : region.triangles) {
    const Eigen::Vector3i& n = control.triangles[t];
    six += outer[n[0]].dot(outer[n[1]].cross(outer[n[2]]));
  }
  return six / 6;
}

double length_over(const std::vector<int>& nodes, const std::vector<Vector3d>& outer) {
  double length = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i) length += (outer[nodes[i]] - outer[nodes[i - 1]]).norm();
  return length;
}

bool all_finite(const Solution& s) {
  bool finite = std::isfinite(s.residual) || s.status == Status::diverged;
  for (const auto* layer : {&s.outer, &s.inner, &s.between})
    for (const Vector3d& p : *layer) finite = finite && p.allFinite();
  for (const auto& line : s.lines)
    finite = finite && std::isfinite(line.tension) && std::isfinite(line.final);
  for (const auto& region : s.regions) finite = finite && std::isfinite(region.volume_after);
  return finite;
}

// The larger of two errors; infinite where the second is no number, which std::max would drop.
double worse(double so_far, double next) {
  return std::isfinite(next) ? std::max(so_far, next) : std::numeric_limits<double>::infinity();
}

// Of rigid lines alone: an elastic one that is too long asks for nothing.
void check_reason(const Case& drawn, const Solution& s, Finding& found) {
  bool has_reason = false;
  for (std::size_t b = 0; b < s.lines.size(); ++b) {
    const auto& line = s.lines[b];
    if (line.law.kind != tensegric::TensionLaw::Kind::rigid) return;
    const double asked = drawn.garment.lines[b].ratio * length_over(line.nodes, drawn.control.outer);
    has_reason = has_reason || (line.tension > 0 && length_over(line.nodes, s.outer) > asked * (1 + 1e-6));
  }
  if (!has_reason) found.faults.push_back("infeasible, and no line that pulls is longer than asked for");
}

void check_lengths(const Case& drawn, const Solution& s, bool exact, Finding& found) {
  for (std::size_t b = 0; b < s.lines.size(); ++b) {
    const auto& line = s.lines[b];
    const double length = length_over(line.nodes, s.outer);
    const double rest = length_over(line.nodes, drawn.control.outer);
    found.length_error = worse(found.length_error, std::abs(length - line.final) / rest);
    const bool rigid = line.law.kind == tensegric::TensionLaw::Kind::rigid;
    if (exact && rigid && s.status == Status::converged &&
        !(length <= drawn.garment.lines[b].ratio * rest * (1 + 1e-6)))
      found.faults.push_back("converged, and a rigid line is longer than asked for");
  }
  if (!(found.length_error <= 1e-9)) found.faults.push_back("a length is not what the solver says");
}

void check_volumes(const Case& drawn, const Solution& s, SolverName solver, Finding& found) {
  for (std::size_t r = 0; r < s.regions.size(); ++r) {
    const auto& region = drawn.control.regions[r];
    const double change = volume_below(drawn.control, region, s.outer) -
                          volume_below(drawn.control, region, drawn.control.outer);
    const double before = std::abs(s.regions[r].volume_before);
    const double said = s.regions[r].volume_after - s.regions[r].volume_before;
    found.volume_error = worse(found.volume_error, std::abs(change) / before);
    if (!(std::abs(change - said) <= 1e-9 * before))
      found.faults.push_back("a volume is not what the solver says");
  }
  const double kept = solver == SolverName::equilibrium ? 1e-8 : 1e-7;  // of the patch; README.md
  if ((s.status == Status::converged || s.status == Status::infeasible) && solver != SolverName::relaxation &&
      !(found.volume_error <= kept))
    found.faults.push_back("a balance that does not keep its volume");
}

}  // namespace

void check(const Case& drawn, const Solution& s, SolverName solver, Finding& found) {
  const bool exact = solver == SolverName::equilibrium;
  if (!all_finite(s)) found.faults.push_back("not finite");
  for (std::size_t i = 0; i < s.outer.size(); ++i)
    if ((drawn.control.outer_fixed[i] && s.outer[i] != drawn.control.outer[i]) ||
        (drawn.control.inner_fixed[i] && s.inner[i] != drawn.control.inner[i])) {
      found.faults.push_back("a fixed node moved");
      break;
    }
  if ((s.status == Status::converged || s.status == Status::infeasible) && !(s.residual <= 1e-8))
    found.faults.push_back("a balance with a residual above 1e-8");
  if (exact && (s.status == Status::diverged || s.status == Status::oscillating))
    found.faults.push_back("equilibrium " + to_string(s.status));
  if (exact && std::any_of(s.history.begin(), s.history.end(),
                           [](const auto& row) { return !(row.merit_change <= 1e-12); }))
    found.faults.push_back("merit rises");
  if (s.lines.size() != drawn.garment.lines.size() || s.regions.size() != drawn.control.regions.size() ||
      s.outer.size() != drawn.control.outer.size())
    found.faults.push_back("a line, a region or a node is not in the result");
  if (exact && s.status == Status::infeasible) check_reason(drawn, s, found);
  check_lengths(drawn, s, exact, found);
  check_volumes(drawn, s, solver, found);
}

Case random_case(unsigned seed) {
  std::mt19937_64 random(seed);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double triangles = 60 * std::pow(2000.0 / 60, std::pow(between(0, 1), kSmall));
  const double aspect = between(0.6, 1.6);
  const int columns = std::max(5, static_cast<int>(std::sqrt(triangles / 2 * aspect)));
  const int rows = std::clamp(static_cast<int>(triangles / 2 / columns), 5, 1000 / columns);
  std::vector<Bump> bumps(static_cast<std::size_t>(between(1, 5)));
  for (Bump& bump : bumps)
    bump = {between(0, 0.02 * columns), between(0, 0.02 * rows), between(0.04, 0.12), between(-0.02, 0.06)};
  Case made;
  made.name = "seed " + std::to_string(seed);
  made.control = stability::sheet(columns, rows, [&bumps](Vector3d p) {
    for (const Bump& b : bumps)
      p.z() +=
          b.height * std::exp(-(std::pow(p.x() - b.x, 2) + std::pow(p.y() - b.y, 2)) / (b.width * b.width));
    return p;
  });
  made.model.layers =
      std::clamp(static_cast<int>(between(1, 9)), 1, std::max(1, kMostUnits / (2 * columns * rows)));
  const int lines = static_cast<int>(between(1, 4));
  for (int line = 0; line < lines; ++line) {
    const int row = static_cast<int>(between(1, rows));
    std::vector<int> nodes;
    for (int i = 0; i <= columns; ++i) nodes.push_back(row * (columns + 1) + i);
    tensegric::Garment one = stability::line_over(made.control, nodes, between(0.3, 1.3));
    one.lines[0].name = "line " + std::to_string(line);
    if (between(0, 1) < 0.3) {
      one.lines[0].law.kind = tensegric::TensionLaw::Kind::stiffness;
      one.lines[0].law.stiffness = std::pow(10, between(-2, 3));
    }
    made.garment.name = one.name;
    made.garment.lines.push_back(one.lines[0]);
  }
  return made;
}

std::optional<tensegric::Model> model_of(const Case& drawn, Finding& finding) {
  try {
    return tensegric::build_model(drawn.control, drawn.model);
  } catch (const geometry::Refusal& refusal) {
    finding.status = refusal.code();
    finding.faults.push_back(std::string("refused: ") + refusal.what());
    return std::nullopt;
  }
}

Finding solve_and_check(const Case& drawn, const tensegric::Model& model, SolverName solver, double cap,
                        int most_iterations) {
  Finding found;
  tensegric::SolverOptions options;
  options.solver = solver;
  if (solver != SolverName::equilibrium) options.max_iterations = most_iterations;
  const double start = seconds();
  try {
    const Solution s =
        tensegric::solve(model, drawn.garment, options, nullptr,
                         [&](const auto&, const auto&, const auto&) { return seconds() - start < cap; });
    found.ms = 1e3 * (seconds() - start);
    found.status = to_string(s.status);
    found.iterations = s.iterations;
    found.residual = s.residual;
    check(drawn, s, solver, found);
  } catch (const geometry::Refusal& refusal) {
    found.status = refusal.code();
    found.faults.push_back(std::string("refused: ") + refusal.what());
  } catch (const std::exception& other) {
    found.status = "exception";
    found.faults.push_back(other.what());
  }
  if (found.ms > 1e3 * (cap + kGrace)) found.faults.push_back("past the cap");
  return found;
}

}  // namespace tensegric_fit::solver_fuzz
