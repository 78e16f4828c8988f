#include "depth_cameras/one_moment.hpp"

#include <algorithm>
#include <set>

namespace tensegric_fit::depth_cameras {

std::vector<int> of_one_moment(const std::vector<std::deque<std::uint64_t>>& stamps, std::uint64_t slop) {
  std::set<std::uint64_t> moments;
  for (const auto& camera : stamps) moments.insert(camera.begin(), camera.end());
  std::vector<int> best(stamps.size(), kNone);
  std::size_t most = 0;
  for (const std::uint64_t first : moments) {
    std::vector<int> chosen(stamps.size(), kNone);
    std::size_t count = 0;
    for (std::size_t camera = 0; camera < stamps.size(); ++camera) {
      const auto next = std::lower_bound(stamps[camera].begin(), stamps[camera].end(), first);
      if (next == stamps[camera].end() || *next - first > slop) continue;
      chosen[camera] = static_cast<int>(next - stamps[camera].begin());
      ++count;
    }
    if (count <= most) continue;
    most = count;
    best = std::move(chosen);
  }
  return best;
}

}  // namespace tensegric_fit::depth_cameras
