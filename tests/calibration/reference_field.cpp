#include "calibration/reference_field.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "geometry/status.hpp"

namespace tensegric_fit::calibration {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

constexpr double kSamePlace = 1e-4;  // m; a reference is written with fewer digits than a mesh
constexpr std::size_t kFewest = 100;
constexpr const char* kHeader = "vertex,x,y,z,dx,dy,dz,fixed";

}  // namespace

ReferenceField read_reference(const std::string& path, const geometry::TriangleMesh& body) {
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line) || line != kHeader)
    throw Refusal(refusal::kBrokenFile, fmt::format("{}: its first line is not {}", path, kHeader));
  ReferenceField reference;
  for (int number = 2; std::getline(file, line); ++number) {
    std::istringstream fields(line);
    std::string field;
    std::vector<double> values;
    while (std::getline(fields, field, ',')) {
      std::size_t used = 0;
      try {
        values.push_back(std::stod(field, &used));
      } catch (const std::exception&) {
      }
      if (used == 0 || used != field.size() || !std::isfinite(values.back()))
        throw Refusal(refusal::kBrokenFile, fmt::format("{}:{}: '{}' is not a number", path, number, field));
    }
    if (values.size() != 8)
      throw Refusal(refusal::kBrokenFile,
                    fmt::format("{}:{}: {} values, not 8", path, number, values.size()));
    const double vertex = values[0];
    const Eigen::Vector3d place(values[1], values[2], values[3]);
    if (!(vertex >= 0 && vertex < static_cast<double>(body.vertices.size())) ||
        !((body.vertices[static_cast<std::size_t>(vertex)] - place).norm() <= kSamePlace))
      throw Refusal(
          refusal::kWrongReference,
          fmt::format("{}:{}: vertex {} is not where the body's mesh has it: the reference was made on "
                      "another mesh",
                      path, number, vertex));
    if (values[7] != 0) continue;
    reference.vertices.push_back(static_cast<int>(vertex));
    reference.displacements.emplace_back(values[4], values[5], values[6]);
  }
  if (reference.vertices.size() < kFewest)
    throw Refusal(refusal::kTooFewData,
                  fmt::format("{}: {} free vertices, and {} are the fewest that say anything", path,
                              reference.vertices.size(), kFewest));
  return reference;
}

double tissue_error(const ReferenceField& reference, const geometry::TriangleMesh& body,
                    const std::vector<Eigen::Vector3d>& deformed) {
  double sum = 0;
  for (std::size_t i = 0; i < reference.vertices.size(); ++i) {
    const int v = reference.vertices[i];
    sum += (deformed[v] - body.vertices[v] - reference.displacements[i]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(reference.vertices.size()));
}

}  // namespace tensegric_fit::calibration
