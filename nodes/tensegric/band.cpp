#include "tensegric/band.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"

namespace tensegric_fit::tensegric {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

constexpr double kSmooth = 1e-3;       // m
constexpr double kSmoothShare = 0.03;  // of the mean segment at rest, where that is less
constexpr double kSteep = 100;         // tension per stretch; the tissue's own is about 1

// f(l) = l from `smooth` on, below it an even polynomial that meets it with two equal derivatives.
struct SegmentLength {
  double value, slope_over_length, curvature;
};

SegmentLength segment_length(double l, double smooth) {
  if (l >= smooth) return {l, 1 / l, 0};
  const double t = l / smooth;
  return {smooth * (0.375 + 0.75 * t * t - 0.125 * t * t * t * t), (1.5 - 0.5 * t * t) / smooth,
          (1.5 - 1.5 * t * t) / smooth};
}

std::vector<int> stops_of(const geometry::ControlMesh& control, const GarmentLine& line) {
  std::vector<int> stops;
  for (const std::string& name : line.through) {
    const int node = control.node(name);
    if (node < 0)
      throw Refusal(refusal::kUnknownLine, "line '" + line.name + "' runs through '" + name +
                                               "', which the control mesh does not have");
    if (!stops.empty() && stops.back() == node)
      throw Refusal(refusal::kBadGarment,
                    "line '" + line.name + "' runs through '" + name + "' twice in a row");
    stops.push_back(node);
  }
  return stops;
}

std::vector<int> nodes_of(const geometry::ControlMesh& control, const GarmentLine& line) {
  if (!line.through.empty()) {
    const std::vector<int> stops = stops_of(control, line);
    return line.taut ? stops : geometry::route_over_edges(control, stops);
  }
  for (const geometry::ControlLine& own : control.lines)
    if (own.name == line.name) return own.nodes;
  throw Refusal(refusal::kUnknownLine, "the control mesh has no line '" + line.name + "'");
}

std::size_t table_segment(const TensionLaw& law, double stretch) {
  std::size_t i = 0;
  while (i + 2 < law.table.size() && stretch > law.table[i + 1].first) ++i;
  return i;
}

std::size_t segment_by_tension(const TensionLaw& law, double tension) {
  std::size_t i = 0;
  while (i + 2 < law.table.size() && std::max(0.0, tension) >= law.table[i + 1].second) ++i;
  return i;
}

double slope_of_segment(const TensionLaw& law, std::size_t i) {
  return (law.table[i + 1].second - law.table[i].second) / (law.table[i + 1].first - law.table[i].first);
}

// A table with a level part beyond its first tension has no stretch by tension.
bool is_steep(const TensionLaw& law) {
  if (law.kind == TensionLaw::Kind::rigid) return true;
  if (law.kind == TensionLaw::Kind::stiffness) return law.stiffness >= kSteep;
  double steepest = 0;
  for (std::size_t i = 0; i + 1 < law.table.size(); ++i) {
    const double slope = slope_of_segment(law, i);
    if (slope == 0 && (law.table[i].second > 0 || i + 2 == law.table.size())) return false;
    steepest = std::max(steepest, slope);
  }
  return steepest >= kSteep;
}

}  // namespace

std::vector<Band> lay_bands(const Model& model, const Garment& garment) {
  std::vector<Band> bands;
  for (const GarmentLine& line : garment.lines) {
    Band band;
    band.name = line.name;
    band.nodes = nodes_of(model.control, line);
    if (band.nodes.size() < 2)
      throw Refusal(refusal::kBadGarment, "line '" + line.name + "' has fewer than two nodes");
    if (!(line.ratio > 0) || !std::isfinite(line.ratio) || !(line.tension_limit >= 0))
      throw Refusal(refusal::kBadGarment,
                    "line '" + line.name + "' has a ratio or tension limit that is not positive");
    band.law = line.law;
    band.tension_limit = line.tension_limit;
    band.request = line.ratio;
    band.initial = geometry::line_length(band.nodes, model.control.outer);
    band.neutral = line.ratio * band.initial;
    band.smooth = std::min(kSmooth, kSmoothShare * band.initial / static_cast<double>(band.nodes.size() - 1));
    band.movable =
        std::any_of(band.nodes.begin(), band.nodes.end(), [&](int node) { return !model.is_fixed(node); });
    band.steep = is_steep(band.law);
    bands.push_back(band);
  }
  return bands;
}

double straight_way(const Model& model, const Band& band, const Positions& x) {
  double way = 0;
  int last = -1;
  for (int node : band.nodes) {
    if (!model.is_fixed(node)) continue;
    if (last >= 0) way += (x[node] - x[last]).norm();
    last = node;
  }
  return way;
}

double smooth_length(const Band& band, const Positions& x) {
  double length = 0;
  for (std::size_t i = 1; i < band.nodes.size(); ++i)
    length += segment_length((x[band.nodes[i]] - x[band.nodes[i - 1]]).norm(), band.smooth).value;
  return length;
}

double smooth_slope(const Band& band, const Positions& x) {
  double change = 0, length = 0;
  for (std::size_t i = 1; i < band.nodes.size(); ++i) {
    const double segment = (x[band.nodes[i]] - x[band.nodes[i - 1]]).norm();
    change += segment_length(segment, band.smooth).slope_over_length * segment * segment;
    length += segment;
  }
  return length > 0 ? change / length : 0;
}

void add_length_gradient(const Band& band, const Positions& x, const std::vector<int>& free_index,
                         double scale, Eigen::Ref<Eigen::VectorXd> gradient) {
  for (std::size_t i = 1; i < band.nodes.size(); ++i) {
    const Eigen::Vector3d span = x[band.nodes[i]] - x[band.nodes[i - 1]];
    const Eigen::Vector3d pull = scale * segment_length(span.norm(), band.smooth).slope_over_length * span;
    const int a = free_index[band.nodes[i]], b = free_index[band.nodes[i - 1]];
    if (a >= 0) gradient.segment<3>(3 * a) += pull;
    if (b >= 0) gradient.segment<3>(3 * b) -= pull;
  }
}

void add_length_hessian(const Band& band, const Positions& x, const std::vector<int>& free_index,
                        double scale, NodeMatrix& hessian) {
  for (std::size_t i = 1; i < band.nodes.size(); ++i) {
    const int a = free_index[band.nodes[i]], b = free_index[band.nodes[i - 1]];
    const Eigen::Vector3d span = x[band.nodes[i]] - x[band.nodes[i - 1]];
    const double length = span.norm();
    const SegmentLength f = segment_length(length, band.smooth);
    const Eigen::Vector3d u = length > 0 ? Eigen::Vector3d(span / length) : Eigen::Vector3d::Zero();
    Eigen::Matrix3d block = scale * (f.curvature - f.slope_over_length) * u * u.transpose();
    block.diagonal().array() += scale * f.slope_over_length;
    hessian.add(a, a, block);
    hessian.add(b, b, block);
    hessian.add(a, b, -block);
  }
}

double law_tension(const TensionLaw& law, double stretch) {
  if (law.kind == TensionLaw::Kind::stiffness) return law.stiffness * std::max(0.0, stretch - 1);
  if (stretch <= law.table.front().first) return 0;
  const std::size_t i = table_segment(law, stretch);
  return law.table[i].second + law_slope(law, stretch) * (stretch - law.table[i].first);
}

double law_slope(const TensionLaw& law, double stretch) {
  if (law.kind == TensionLaw::Kind::stiffness) return stretch > 1 ? law.stiffness : 0;
  if (stretch <= law.table.front().first) return 0;
  return slope_of_segment(law, table_segment(law, stretch));
}

double law_work(const TensionLaw& law, double stretch) {
  if (law.kind == TensionLaw::Kind::stiffness) {
    const double beyond = std::max(0.0, stretch - 1);
    return law.stiffness * beyond * beyond / 2;
  }
  double work = 0;
  for (std::size_t i = 0; i + 1 < law.table.size() && stretch > law.table[i].first; ++i) {
    const bool last = i + 2 == law.table.size();
    const double end = last ? stretch : std::min(stretch, law.table[i + 1].first);
    work += (law.table[i].second + law_tension(law, end)) / 2 * (end - law.table[i].first);
  }
  return work;
}

double law_stretch(const TensionLaw& law, double tension) {
  if (law.kind == TensionLaw::Kind::rigid) return 1;
  if (law.kind == TensionLaw::Kind::stiffness) return 1 + tension / law.stiffness;
  const std::size_t i = segment_by_tension(law, tension);
  return law.table[i].first + law_compliance(law, tension) * (tension - law.table[i].second);
}

double law_compliance(const TensionLaw& law, double tension) {
  if (law.kind == TensionLaw::Kind::rigid) return 0;
  if (law.kind == TensionLaw::Kind::stiffness) return 1 / law.stiffness;
  return 1 / slope_of_segment(law, segment_by_tension(law, tension));
}

double law_work_by_tension(const TensionLaw& law, double tension) {
  if (law.kind == TensionLaw::Kind::rigid) return 0;
  if (law.kind == TensionLaw::Kind::stiffness || tension <= 0)
    return law_compliance(law, tension) * tension * tension / 2;
  return law_work(law, law_stretch(law, tension));
}

}  // namespace tensegric_fit::tensegric
