#include "tensegric/load_unit.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"
#include "tensegric/kkt.hpp"

namespace tensegric_fit::tensegric {

// One Newton step from rest, volumes kept, under a force of 1: the shape's first answer to it.
Eigen::Vector3d force_of_share(const Model& model, const Eigen::Vector3d& share, SolverOptions options,
                               const std::vector<PosedVolume>& body_volumes) {
  if (share.isZero(0)) return share;
  if (!share.allFinite()) throw geometry::Refusal(geometry::refusal::kBadOption, "gravity is not finite");
  options.gravity = share.normalized();
  const Problem problem = lay_garment(model, {}, options, body_volumes);
  Kkt kkt(problem);
  const Balance rest{problem.rest,
                     Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.volumes.size())),
                     Eigen::VectorXd(),
                     {}};
  const Load load{{}, {}, options.gravity};
  const Step step = kkt.step(rest, load, kkt.defect(rest, load), true, false);
  double farthest = 0;
  for (std::size_t i = 0; i < model.control.outer.size(); ++i)
    if (problem.free_index[i] >= 0)
      farthest = std::max(farthest, step.move.segment<3>(3 * problem.free_index[i]).norm());
  if (problem.free_nodes == 0)
    throw geometry::Refusal(geometry::refusal::kBadOption, "all nodes are fixed: gravity has no effect");
  if (!(farthest > 0 && std::isfinite(farthest)))
    throw geometry::Refusal(geometry::refusal::kBadMesh,
                            "the shape at rest is no stable balance: there is no unit of gravity for it");
  const auto box = geometry::bounding_box(model.control.outer);
  return kMoveOfUnit * (box[1] - box[0]).norm() / farthest * share;
}

}  // namespace tensegric_fit::tensegric
