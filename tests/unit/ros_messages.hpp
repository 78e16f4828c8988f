/// Small core types that tests turn into messages and back.
#pragma once

#include <string>

#include "geometry/control_mesh.hpp"
#include "geometry/status.hpp"
#include "geometry/triangle_mesh.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::node {

inline ScanTag some_tag() {
  ScanTag tag;
  tag.header.stamp = ros::Time(12, 34);
  tag.header.frame_id = "booth";
  tag.scan_id = "12.000000034-0badcafe";
  return tag;
}

inline geometry::TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

inline geometry::ControlMesh small_control_mesh() {
  geometry::ControlMesh control;
  control.outer = {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 1.0 / 3}};
  control.inner = {{0, 0, -0.01}, {0.1, 0, -0.01}, {0.1, 0.1, -0.01}, {0, 0.1, 0.3}};
  control.triangles = {{0, 1, 2}, {0, 2, 3}};
  control.outer_fixed = {1, 0, 0, 1};
  control.inner_fixed = {1, 1, 1, 1};
  control.names = {"side_L", "", "sternum", ""};
  control.regions = {{"bust", {0, 1}}};
  control.lines = {{"chest", {0, 2}}};
  return control;
}

template <typename Call>
std::string code_of(Call call) {
  try {
    call();
  } catch (const geometry::Refusal& refusal) {
    return refusal.code();
  }
  return "accepted";
}

}  // namespace tensegric_fit::node
