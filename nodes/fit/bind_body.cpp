#include "fit/bind_body.hpp"

#include <algorithm>
#include <mutex>
#include <optional>

#include "geometry/status.hpp"
#include "tensegric/course.hpp"
#include "tffd/body_volume.hpp"
#include "tffd/skin_check.hpp"

namespace tensegric_fit::fit {
namespace {

bool same(const tffd::LineOnBody& a, const tffd::LineOnBody& b) {
  return a.points == b.points && a.width == b.width && a.smooth == b.smooth && a.taut == b.taut &&
         a.held == b.held && a.fan == b.fan;
}

class BoundBody : public tensegric::BodyUnderGarment {
 public:
  BoundBody(std::function<geometry::TriangleMesh()> body, const geometry::ControlMesh& control,
            const geometry::BoneFrames& bones, double beta)
      : body_(std::move(body)), control_(control), bones_(bones) {
    options_.beta = beta;
  }

  std::vector<geometry::LaidLine> lay(const tensegric::Garment& garment) const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<geometry::LaidLine> laid;
    std::vector<Line> lines;
    for (const tensegric::GarmentLine& line : garment.lines) {
      if (!line.on_body()) continue;
      const tffd::LineOnBody way = on_body(control_, line);
      const auto known =
          std::find_if(lines_.begin(), lines_.end(), [&way](const Line& one) { return same(one.way, way); });
      lines.push_back(
          known != lines_.end() ? *known : Line{way, fit::lay(line, way, bound().mesh, bound().binding())});
      laid.push_back({line.name, lines.back().fibres});
    }
    lines_ = std::move(lines);
    return laid;
  }

  std::vector<tensegric::PosedVolume> volumes() const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    const Bound& body = bound();
    return body_volumes(body.at_rest, tffd::carried_triangles(body.at_rest, body.mesh.triangles, control_),
                        control_, bones_);
  }

  bool folds(const std::vector<Eigen::Vector3d>& outer,
             const std::vector<Eigen::Vector3d>& inner) const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    return skin_folds(bound().binding(), bound().mesh.triangles, outer, inner);
  }

  std::vector<Eigen::Vector3d> worn(const std::vector<Eigen::Vector3d>& outer,
                                    const std::vector<Eigen::Vector3d>& inner) const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    return bound().binding().deform(outer, inner);
  }

 private:
  struct Bound {
    geometry::TriangleMesh mesh;
    tffd::Binding at_rest;
    std::optional<tffd::Binding> in_posture;

    const tffd::Binding& binding() const { return in_posture ? *in_posture : at_rest; }
  };
  struct Line {
    tffd::LineOnBody way;
    std::vector<geometry::Fibre> fibres;
  };

  const Bound& bound() const {
    if (bound_) return *bound_;
    geometry::TriangleMesh mesh = body_();
    tffd::Binding at_rest(mesh, control_, options_);
    std::optional<tffd::Binding> in_posture;
    if (!bones_.still()) in_posture = at_rest.posed(bones_);
    bound_ = std::make_unique<const Bound>(Bound{std::move(mesh), std::move(at_rest), std::move(in_posture)});
    return *bound_;
  }

  const std::function<geometry::TriangleMesh()> body_;
  const geometry::ControlMesh control_;
  const geometry::BoneFrames bones_;
  tffd::Options options_;
  mutable std::mutex mutex_;
  mutable std::unique_ptr<const Bound> bound_;
  mutable std::vector<Line> lines_;  // of the last garment
};

}  // namespace

tffd::LineOnBody on_body(const geometry::ControlMesh& control, const tensegric::GarmentLine& line) {
  const tensegric::Course course = tensegric::course_of(control, line);
  return {course.points, line.width, line.smooth, line.taut, course.held, course.fan};
}

std::vector<geometry::Fibre> lay(const tensegric::GarmentLine& line, const tffd::LineOnBody& way,
                                 const geometry::TriangleMesh& body, const tffd::Binding& binding) {
  try {
    return tffd::lay_line(way, body, binding);
  } catch (const geometry::Refusal& refusal) {
    if (refusal.code() != geometry::refusal::kBadGarment) throw;
    const char* advice = ": its points are to lie on the skin, in metres, in the scan's frame";
    throw geometry::Refusal(
        refusal.code(), "line '" + line.name + "' " + refusal.what() + (line.points.empty() ? "" : advice));
  }
}

std::vector<tensegric::PosedVolume> body_volumes(const tffd::Binding& binding,
                                                 const std::vector<std::vector<Eigen::Vector3i>>& carried,
                                                 const geometry::ControlMesh& control,
                                                 const geometry::BoneFrames& bones) {
  std::vector<tensegric::PosedVolume> volumes;
  for (std::size_t r = 0; r < carried.size(); ++r)
    volumes.emplace_back([bones, body = tffd::BodyVolume(binding, carried[r],
                                                         geometry::region_apex(control, control.regions[r]))](
                             double share) { return body.posed(bones, share); });
  return volumes;
}

bool skin_folds(const tffd::Binding& binding, const std::vector<Eigen::Vector3i>& triangles,
                const std::vector<Eigen::Vector3d>& outer, const std::vector<Eigen::Vector3d>& inner) {
  const std::vector<Eigen::Vector3d> worn = binding.deform(outer, inner);
  return tffd::turns_over({binding.vertices(), worn, triangles});
}

std::unique_ptr<const tensegric::BodyUnderGarment> bind_body(std::function<geometry::TriangleMesh()> body,
                                                             const geometry::ControlMesh& control,
                                                             const geometry::BoneFrames& bones, double beta) {
  return std::make_unique<const BoundBody>(std::move(body), control, bones, beta);
}

}  // namespace tensegric_fit::fit
