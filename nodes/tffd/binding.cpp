#include "tffd/binding.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"
#include "tffd/moves.hpp"

namespace tensegric_fit::tffd {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

double beta_of(const Options& options) {
  if (options.beta != 0) return options.beta;
  return options.setting == Setting::paper ? 2.5 : 1.3;
}

void check_nodes(const std::vector<Eigen::Vector3d>& nodes, std::size_t count) {
  if (nodes.size() != count)
    throw Refusal(refusal::kBadMesh,
                  "t-FFD: the number of control nodes is not the one that the body was bound with");
  for (const Eigen::Vector3d& node : nodes)
    if (!node.allFinite())
      throw Refusal(refusal::kNonFinite, "t-FFD: a control node's position is not finite");
}

void check_input(const geometry::TriangleMesh& body, const geometry::ControlMesh& control) {
  geometry::check_mesh(body);
  geometry::check_mesh({control.outer, control.triangles});
  check_nodes(control.inner, control.outer.size());
  if (control.triangles.empty()) throw Refusal(refusal::kBadMesh, "t-FFD: the control mesh has no triangles");
  if (control.outer_fixed.size() != control.outer.size() ||
      control.inner_fixed.size() != control.outer.size())
    throw Refusal(refusal::kBadMesh, "t-FFD: the control mesh needs one fixed flag per node");
}

// A control mesh that moves nothing would look like a garment without effect.
void check_carries(const std::vector<Anchor>& anchors, const std::vector<char>& outer_fixed) {
  if (anchors.empty() && std::count(outer_fixed.begin(), outer_fixed.end(), 0) > 0)
    throw Refusal(refusal::kBadMesh,
                  "the control mesh carries no skin: it lies elsewhere, in another unit, or faces inwards");
}

double largest_row_sum(const SparseRows& matrix) {
  double largest = 0;
  for (Eigen::Index row = 0; row < matrix.outerSize(); ++row) {
    double sum = 0;
    for (SparseRows::InnerIterator m(matrix, row); m; ++m) sum += std::abs(m.value());
    largest = std::max(largest, sum);
  }
  return largest;
}

// In the paper's setting whatever is in reach moves in full.
std::vector<Anchor> anchors_of(const NormalTerms& bound) {
  std::vector<Anchor> anchors;
  for (std::size_t v = 0; v + 1 < bound.starts.size(); ++v)
    if (bound.starts[v] < bound.starts[v + 1]) anchors.push_back({static_cast<int>(v), 1});
  return anchors;
}

// Of each triangle two sides and the unit normal.
std::vector<Eigen::Matrix3d> normal_axes(const std::vector<Eigen::Vector3d>& outer,
                                         const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<Eigen::Matrix3d> axes(triangles.size());
  for (std::size_t t = 0; t < axes.size(); ++t) {
    const Eigen::Vector3d& p = outer[triangles[t][0]];
    const Eigen::Vector3d u = outer[triangles[t][1]] - p, v = outer[triangles[t][2]] - p;
    axes[t] << u, v,
        u.cross(v).normalized();  // Eigen leaves the zero vector of a collapsed triangle as it is
  }
  return axes;
}

}  // namespace

void check_options(const Options& options) {
  geometry::check_option("truncation", options.truncation, kTruncation);
  geometry::check_beta(options.beta);
  if (options.setting == Setting::paper && (options.truncation > 0 || options.precision == Precision::fast))
    throw Refusal(refusal::kBadOption,
                  "t-FFD: the paper's setting has neither a fast precision nor a truncation");
}

Binding::Binding(const geometry::TriangleMesh& body, const geometry::ControlMesh& control,
                 const Options& options)
    : setting_(options.setting),
      precision_(options.precision),
      vertices_(body.vertices),
      outer_(control.outer),
      inner_(control.inner),
      triangles_(control.triangles) {
  check_options(options);
  const double beta = beta_of(options);
  check_input(body, control);
  const bool paper = setting_ == Setting::paper;
  frames_ = frames_of(control, paper ? Axis::unit_normal : Axis::inner_to_outer);
  Kernel& kernel = kernel_.emplace(Kernel{beta, TriangleGrid(frames_, beta)});
  if (paper) {
    terms_ = paper_terms(vertices_, frames_, kernel);
    anchors_ = anchors_of(terms_);
    check_carries(anchors_, control.outer_fixed);
    weights_.values = paper_values(vertices_, control, frames_, terms_);
    return;
  }
  anchors_ = reach_of(body, control, frames_, kernel.grid, beta);
  check_carries(anchors_, control.outer_fixed);
  untangle_ = Untangle(body, anchors_);
  const std::vector<Tie> ties = tie_needles(body, anchors_);
  weights_ = standard_weights(body, control, frames_, kernel, anchors_, ties);
  if (options.truncation > 0) {
    kernel.truncation = options.truncation;
    Weights truncated = standard_weights(body, control, frames_, kernel, anchors_, ties);
    truncation_error_ = largest_row_sum(weights_.nodes - truncated.nodes);
    weights_ = std::move(truncated);
  }
  if (precision_ == Precision::fast) {
    const double* const entries = weights_.nodes.valuePtr();
    float_weights_.assign(entries, entries + weights_.nodes.nonZeros());
  }
}

Binding Binding::posed(const geometry::BoneFrames& bones) const {
  Binding other = *this;
  for (auto* points : {&other.vertices_, &other.outer_, &other.inner_})
    for (Eigen::Vector3d& p : *points) p = bones.moved(p);
  if (bones.still() || setting_ != Setting::paper) return other;
  const std::vector<Eigen::Matrix3d> axes = normal_axes(other.outer_, triangles_);
  for (const Anchor& anchor : anchors_)
    for (int i = terms_.starts[anchor.vertex]; i < terms_.starts[anchor.vertex + 1]; ++i) {
      NormalTerm& term = other.terms_.terms[i];
      term.local = axes[term.triangle].inverse() *
                   (other.vertices_[anchor.vertex] - other.outer_[triangles_[term.triangle][0]]);
    }
  return other;
}

double Binding::share_of(int vertex) const {
  const auto at = std::lower_bound(anchors_.begin(), anchors_.end(), vertex,
                                   [](const Anchor& anchor, int v) { return anchor.vertex < v; });
  return at != anchors_.end() && at->vertex == vertex ? at->share : 0;
}

geometry::CarriedPoint Binding::carried(const geometry::SurfacePoint& at,
                                        const Eigen::Vector3i& corners) const {
  double share = 0;
  for (int k = 0; k < 3; ++k) share += at.barycentric[k] * share_of(corners[k]);
  if (share == 0) return {at.position, {}};
  return {at.position, weights_at(at.position, share, outer_.size(), triangles_, frames_, *kernel_)};
}

std::vector<Eigen::Vector3d> Binding::deform(const std::vector<Eigen::Vector3d>& outer,
                                             const std::vector<Eigen::Vector3d>& inner) const {
  check_nodes(outer, outer_.size());
  check_nodes(inner, inner_.size());
  std::vector<Eigen::Vector3d> moved = vertices_;
  if (setting_ == Setting::paper)
    move_by_normals(outer, moved);
  else
    move_by_weights(outer, inner, moved);
  untangle_(vertices_, moved);
  return moved;
}

void Binding::move_by_weights(const std::vector<Eigen::Vector3d>& outer,
                              const std::vector<Eigen::Vector3d>& inner,
                              std::vector<Eigen::Vector3d>& moved) const {
  std::vector<Eigen::Vector3d> motion(outer.size() + inner.size());
  for (std::size_t i = 0; i < outer.size(); ++i) {
    motion[i] = outer[i] - outer_[i];
    motion[outer.size() + i] = inner[i] - inner_[i];
  }
  if (precision_ == Precision::fast)
    add_moves(weights_.nodes, float_weights_.data(), motion, anchors_, moved);
  else
    add_moves(weights_.nodes, weights_.nodes.valuePtr(), motion, anchors_, moved);
}

void Binding::move_by_normals(const std::vector<Eigen::Vector3d>& outer,
                              std::vector<Eigen::Vector3d>& moved) const {
  const std::vector<Eigen::Matrix3d> axes = normal_axes(outer, triangles_);
  for (const Anchor& anchor : anchors_) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = terms_.starts[anchor.vertex]; i < terms_.starts[anchor.vertex + 1]; ++i) {
      const NormalTerm& term = terms_.terms[i];
      sum += term.weight * (outer[triangles_[term.triangle][0]] + axes[term.triangle] * term.local);
    }
    moved[anchor.vertex] = sum;
  }
}

}  // namespace tensegric_fit::tffd
