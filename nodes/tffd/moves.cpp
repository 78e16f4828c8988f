#include "tffd/moves.hpp"

namespace tensegric_fit::tffd {

template <typename Scalar>
void add_moves(const SparseRows& nodes, const Scalar* weights, const std::vector<Eigen::Vector3d>& motion,
               const std::vector<Anchor>& anchors, std::vector<Eigen::Vector3d>& positions) {
  using Move = Eigen::Array<Scalar, 4, 1>;  // four numbers a node: whole vector registers
  std::vector<Move, Eigen::aligned_allocator<Move>> moves(motion.size(), Move::Zero());
  for (std::size_t i = 0; i < motion.size(); ++i)
    moves[i].template head<3>() = motion[i].cast<Scalar>().array();
  const int *const starts = nodes.outerIndexPtr(), *const columns = nodes.innerIndexPtr();
  for (const Anchor& anchor : anchors) {
    Move even = Move::Zero(), odd = Move::Zero();  // two sums that do not wait for each other
    int i = starts[anchor.vertex];
    const int end = starts[anchor.vertex + 1];
    for (; i + 1 < end; i += 2) {
      even += weights[i] * moves[columns[i]];
      odd += weights[i + 1] * moves[columns[i + 1]];
    }
    if (i < end) even += weights[i] * moves[columns[i]];
    positions[anchor.vertex] += (even + odd).template head<3>().matrix().template cast<double>();
  }
}

template void add_moves(const SparseRows&, const float*, const std::vector<Eigen::Vector3d>&,
                        const std::vector<Anchor>&, std::vector<Eigen::Vector3d>&);
template void add_moves(const SparseRows&, const double*, const std::vector<Eigen::Vector3d>&,
                        const std::vector<Anchor>&, std::vector<Eigen::Vector3d>&);

}  // namespace tensegric_fit::tffd
