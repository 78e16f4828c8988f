/// Things that are joined to sets, two at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace tensegric_fit::geometry {

/// Of 0 to `count` - 1, each alone at first. The root of a set is its smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// False where they are in one set already.
  bool join(int a, int b) {
    const int of_a = root(a), of_b = root(b);
    parent_[std::max(of_a, of_b)] = std::min(of_a, of_b);
    return of_a != of_b;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace tensegric_fit::geometry
