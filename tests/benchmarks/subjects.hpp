/// The bodies that `population` measures: random customers of the virtual booth, or bodies in a folder.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/point_cloud.hpp"
#include "geometry/triangle_mesh.hpp"
#include "scored_figures.hpp"

namespace tensegric_fit::population {

/// What of a body is measured.
enum class Input { surface, merged_scan, assembled_scan };

/// A body: either its surface or its scan is filled, as the input asks.
struct Subject {
  Truth truth;
  geometry::TriangleMesh surface;
  geometry::PointCloud scan;
};

/// Bodies of one kind.
class Family {
 public:
  virtual ~Family() = default;
  virtual std::string name() const = 0;
  /// Of `count` bodies from number `first` on, fewer where there are fewer. Of the virtual booth the numbers
  /// are seeds; a folder's bodies are numbered from 1 in the order of their names.
  virtual std::vector<std::string> bodies(int first, int count) const = 0;
  /// \throw Refusal broken_file
  virtual Subject body(const std::string& name, Input input) const = 0;
};

/// `model`, `implicit`, or a folder with NAME_truth.json beside NAME_scan.ply or NAME_body.ply.
/// \throw Refusal bad_option: neither, or a folder without a truth file
std::unique_ptr<Family> family_named(const std::string& name);

}  // namespace tensegric_fit::population
