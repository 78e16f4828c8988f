#include "tffd/float_rows.hpp"

namespace tensegric_fit::tffd {

FloatRows::FloatRows(const SparseRows& nodes, const std::vector<Anchor>& anchors) : starts_{0} {
  for (const Anchor& anchor : anchors) {
    for (SparseRows::InnerIterator m(nodes, anchor.vertex); m; ++m) {
      columns_.push_back(static_cast<int>(m.col()));
      weights_.push_back(static_cast<float>(m.value()));
    }
    starts_.push_back(static_cast<int>(columns_.size()));
  }
}

void FloatRows::add(const std::vector<Eigen::Vector3d>& motion, const std::vector<Anchor>& anchors,
                    std::vector<Eigen::Vector3d>& positions) const {
  // Four numbers a node: one vector register.
  std::vector<Eigen::Array4f> moves(motion.size(), Eigen::Array4f::Zero());
  for (std::size_t i = 0; i < motion.size(); ++i) moves[i].head<3>() = motion[i].cast<float>().array();
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    Eigen::Array4f even = Eigen::Array4f::Zero(),
                   odd = even;  // two sums that do not wait for each other
    int j = starts_[i];
    for (; j + 1 < starts_[i + 1]; j += 2) {
      even += weights_[j] * moves[columns_[j]];
      odd += weights_[j + 1] * moves[columns_[j + 1]];
    }
    if (j < starts_[i + 1]) even += weights_[j] * moves[columns_[j]];
    positions[anchors[i].vertex] += (even + odd).head<3>().matrix().cast<double>();
  }
}

}  // namespace tensegric_fit::tffd
