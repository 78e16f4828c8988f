/// Files of a JSON header and named arrays. Format: nodes/body_model/README.md.
#pragma once

#include <Eigen/Core>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/status.hpp"

namespace tensegric_fit::body_model {

/// Refuses the file with `what`.
struct Check {
  const std::string& path;
  void operator()(bool holds, const std::string& what) const {
    if (!holds) throw geometry::Refusal(geometry::refusal::kBrokenFile, path + ": " + what);
  }
};

class ArrayFile {
 public:
  /// \param magic the first line of a file of this `kind` and format
  /// \throw Refusal broken_file: not there, another first line, truncated, or not JSON
  ArrayFile(const std::string& path, const std::string& magic, const std::string& kind);

  const nlohmann::json& header() const { return header_; }
  /// Of all bytes, FNV-1a of 64 bits in hexadecimal.
  const std::string& checksum() const { return checksum_; }
  /// An array's numbers, row by row; extents of 0 in `shape` may be any.
  /// \throw Refusal broken_file: not there, of another shape, empty or not finite
  std::vector<double> numbers(const std::string& name, const std::vector<std::size_t>& shape) const;

 private:
  struct Array {
    std::string type;
    std::vector<std::size_t> shape;
    std::string bytes;
  };
  void read_arrays(std::istream& file);

  std::string path_, checksum_;
  nlohmann::json header_;
  std::map<std::string, Array> arrays_;
};

/// Three numbers per point.
std::vector<Eigen::Vector3d> points(const std::vector<double>& xyz);

}  // namespace tensegric_fit::body_model
