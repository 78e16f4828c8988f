#include "ros/body_messages.hpp"

#include "ros/flat.hpp"

namespace tensegric_fit::node {
namespace {

using geometry::Refusal;

Landmarks::_body_from_scan_type transform_of(const Eigen::Isometry3d& isometry) {
  Landmarks::_body_from_scan_type rows;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) rows[4 * row + column] = isometry.matrix()(row, column);
  return rows;
}

Eigen::Isometry3d isometry_in(const Landmarks::_body_from_scan_type& rows) {
  Eigen::Isometry3d isometry;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) isometry.matrix()(row, column) = rows[4 * row + column];
  const Eigen::Matrix3d turn = isometry.linear();
  const bool rigid = isometry.matrix().allFinite() && turn.isUnitary(1e-6) && turn.determinant() > 0 &&
                     isometry.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1);
  if (!rigid) throw Refusal(geometry::refusal::kBadMesh, "body_from_scan is not a rigid motion");
  if (isometry.translation().cwiseAbs().maxCoeff() > kFarthest)
    throw Refusal(geometry::refusal::kBadMesh, "body_from_scan moves by 10,000 km");
  return isometry;
}

std::vector<Measure> measures_of(const std::vector<geometry::Measure>& measures) {
  std::vector<Measure> messages;
  for (const geometry::Measure& measure : measures) {
    Measure message;
    message.name = measure.name;
    message.value = measure.metres;
    message.confidence = measure.confidence;
    message.half_width = measure.half_width;
    message.reason = measure.reason;
    messages.push_back(std::move(message));
  }
  return messages;
}

std::vector<geometry::Measure> measures_from(const std::vector<Measure>& messages) {
  std::vector<geometry::Measure> measures;
  for (const Measure& message : messages)
    measures.push_back({message.name, message.value, message.confidence, message.reason, message.half_width});
  return measures;
}

std::vector<std::uint8_t> bytes_of(const std::vector<char>& flags) {
  return {flags.begin(), flags.end()};
}

std::vector<char> flags_in(const std::vector<std::uint8_t>& bytes) {
  std::vector<char> flags;
  for (const std::uint8_t byte : bytes) flags.push_back(static_cast<char>(byte != 0));
  return flags;
}

std::vector<std::uint32_t> numbers_of(const std::vector<int>& numbers) {
  return {numbers.begin(), numbers.end()};
}

std::vector<int> numbers_in(const std::vector<std::uint32_t>& numbers) {
  return {numbers.begin(), numbers.end()};
}

// Entries of a kind, and numbers of a loop or a course, that any message has: ours have some thirty, and some
// hundred points.
constexpr std::size_t kMost = 256, kMostNumbers = 3 * 10000;

}  // namespace

TriangleMesh to_message(const ScanTag& tag, const geometry::TriangleMesh& mesh,
                        const std::vector<char>& filled) {
  TriangleMesh message;
  message.header = tag.header;
  message.scan_id = tag.scan_id;
  message.vertices = flat<float>(mesh.vertices);
  message.triangles = flat(mesh.triangles);
  message.filled = filled.empty() ? std::vector<std::uint8_t>(mesh.vertices.size(), 0) : bytes_of(filled);
  return message;
}

geometry::TriangleMesh mesh_in(const TriangleMesh& message) {
  geometry::TriangleMesh mesh{points_in(message.vertices), triangles_in(message.triangles)};
  if (mesh.triangles.empty()) throw Refusal(geometry::refusal::kBadMesh, "the mesh has no triangles");
  geometry::check_mesh(mesh);
  return mesh;
}

std::vector<char> filled_in(const TriangleMesh& message) {
  if (!message.filled.empty() && 3 * message.filled.size() != message.vertices.size())
    throw Refusal(geometry::refusal::kBadMesh, "`filled` must be empty or have one entry per vertex");
  return flags_in(message.filled);
}

Fracture to_message(const geometry::Fracture& fracture) {
  Fracture message;
  for (int k = 0; k < 3; ++k) message.centre[k] = fracture.centre[k];
  message.radius = fracture.radius;
  message.area = fracture.area;
  message.offset = fracture.offset;
  return message;
}

std::vector<geometry::Fracture> fractures_in(const TriangleMesh& message) {
  std::vector<geometry::Fracture> fractures;
  for (const Fracture& fracture : message.fractures)
    fractures.push_back({{fracture.centre[0], fracture.centre[1], fracture.centre[2]},
                         fracture.radius,
                         fracture.area,
                         fracture.offset});
  return fractures;
}

Landmarks to_message(const ScanTag& tag, const geometry::BodyMeasures& measures) {
  Landmarks message;
  message.header = tag.header;
  message.scan_id = tag.scan_id;
  message.body_from_scan = transform_of(measures.body_from_scan);
  for (const geometry::Landmark& landmark : measures.landmarks) {
    Landmark point;
    point.name = landmark.name;
    Eigen::Vector3d::Map(point.position.data()) = landmark.position;
    point.confidence = landmark.confidence;
    point.reason = landmark.reason;
    message.points.push_back(std::move(point));
  }
  message.heights = measures_of(measures.heights);
  message.girths = measures_of(measures.girths);
  for (const geometry::GirthLoop& loop : measures.loops) {
    GirthLoop girth;
    girth.name = loop.name;
    girth.points = flat<double>(loop.points);
    message.loops.push_back(std::move(girth));
  }
  for (const geometry::Missing& missing : measures.missing) {
    message.missing.emplace_back();
    message.missing.back().name = missing.name;
    message.missing.back().reason = missing.reason;
  }
  return message;
}

/// Exports and the panel go through all of them for each.
void check_counts(const Landmarks& message) {
  for (const std::size_t count : {message.points.size(), message.heights.size(), message.girths.size(),
                                  message.loops.size(), message.missing.size()})
    if (count > kMost)
      throw Refusal(geometry::refusal::kBadMesh, "the landmarks have more than 256 entries of a kind");
  for (const GirthLoop& girth : message.loops)
    if (girth.points.size() > kMostNumbers)
      throw Refusal(geometry::refusal::kBadMesh, "a girth has more than 10,000 points");
  for (const auto* measures : {&message.heights, &message.girths})
    for (const Measure& measure : *measures)
      if (std::abs(measure.value) > kFarthest)
        throw Refusal(geometry::refusal::kBadMesh, "measure '" + measure.name + "' is more than 10,000 km");
}

geometry::BodyMeasures measures_in(const Landmarks& message) {
  check_counts(message);
  geometry::BodyMeasures measures;
  measures.body_from_scan = isometry_in(message.body_from_scan);
  for (const Landmark& point : message.points) {
    const Eigen::Vector3d position = Eigen::Vector3d::Map(point.position.data());
    if (!position.allFinite())
      throw Refusal(geometry::refusal::kNonFinite, "landmark '" + point.name + "' is not finite");
    if (position.cwiseAbs().maxCoeff() > kFarthest)
      throw Refusal(geometry::refusal::kBadMesh, "landmark '" + point.name + "' is 10,000 km away");
    measures.landmarks.push_back({point.name, position, point.confidence, point.reason});
  }
  measures.heights = measures_from(message.heights);
  measures.girths = measures_from(message.girths);
  for (const GirthLoop& girth : message.loops)
    measures.loops.push_back({girth.name, points_in(girth.points)});
  for (const Missing& missing : message.missing) measures.missing.push_back({missing.name, missing.reason});
  return measures;
}

void check_lines(const FitState& fit) {
  if (fit.lines.size() > kMost) throw Refusal(geometry::refusal::kBadMesh, "the fit has more than 256 lines");
  for (const LineResult& line : fit.lines)
    if (line.course.size() > kMostNumbers || line.course_at_rest.size() > kMostNumbers)
      throw Refusal(geometry::refusal::kBadMesh, "line '" + line.name + "' has more than 10,000 points");
}

geometry::BoneFrames bones_of(const FitState& fit, const geometry::BodyMeasures& measures) {
  if (fit.twist == 0 && fit.side_lean == 0) return {};  // which no measures are needed for
  return {measures, {fit.twist, fit.side_lean}};
}

ControlMesh to_message(const ScanTag& tag, const geometry::ControlMesh& control) {
  ControlMesh message;
  message.header = tag.header;
  message.scan_id = tag.scan_id;
  message.outer = flat<double>(control.outer);
  message.inner = flat<double>(control.inner);
  message.triangles = flat(control.triangles);
  message.outer_fixed = bytes_of(control.outer_fixed);
  message.inner_fixed = bytes_of(control.inner_fixed);
  message.names = control.names;
  for (const geometry::ControlRegion& region : control.regions) {
    message.regions.emplace_back();
    message.regions.back().name = region.name;
    message.regions.back().triangles = numbers_of(region.triangles);
  }
  for (const geometry::ControlLine& line : control.lines) {
    message.lines.emplace_back();
    message.lines.back().name = line.name;
    message.lines.back().nodes = numbers_of(line.nodes);
  }
  return message;
}

geometry::ControlMesh control_in(const ControlMesh& message) {
  geometry::ControlMesh control;
  control.outer = points_in(message.outer);
  control.inner = points_in(message.inner);
  control.triangles = triangles_in(message.triangles);
  control.outer_fixed = flags_in(message.outer_fixed);
  control.inner_fixed = flags_in(message.inner_fixed);
  control.names = message.names;
  for (const ControlRegion& region : message.regions)
    control.regions.push_back({region.name, numbers_in(region.triangles)});
  for (const ControlLine& line : message.lines) control.lines.push_back({line.name, numbers_in(line.nodes)});
  geometry::check_control_mesh(control);
  return control;
}

}  // namespace tensegric_fit::node
