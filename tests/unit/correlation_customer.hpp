/// A customer of the virtual booth, for the tests of the correlation.
#pragma once

#include <functional>
#include <string>

#include "correlation/correlate.hpp"
#include "fit/chain.hpp"
#include "geometry/points.hpp"
#include "virtual_body/virtual_body.hpp"
#include "virtual_booth/virtual_scanner.hpp"

namespace tensegric_fit::correlation {

using Eigen::Vector3d;
using geometry::TriangleMesh;

inline virtual_body::BodyParameters customer() {
  virtual_body::BodyParameters body;
  body.stature = 1.66;
  body.build = 1.1;
  body.bust = 1.1;
  body.firmness = 0.4;
  body.asymmetry = 0.05;
  return body;
}

inline TriangleMesh moved(TriangleMesh mesh, const std::function<Vector3d(const Vector3d&)>& motion) {
  for (Vector3d& p : mesh.vertices) p = motion(p);
  return mesh;
}

inline TriangleMesh moved(TriangleMesh mesh, const Eigen::Isometry3d& motion) {
  mesh.vertices = geometry::moved(mesh.vertices, motion);
  return mesh;
}

// Every vertex goes out by its own way, metres.
inline TriangleMesh thicker(TriangleMesh mesh, const std::function<double(std::size_t)>& way) {
  const std::vector<Vector3d> normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
  for (std::size_t v = 0; v < normals.size(); ++v) mesh.vertices[v] += way(v) * normals[v];
  return mesh;
}

inline fit::Body scanned(const TriangleMesh& body, std::uint64_t seed) {
  virtual_booth::ScannerOptions booth;
  booth.points = 60000;
  booth.noise = 0.001;
  booth.misregistration = 0;
  booth.seed = seed;
  fit::StageTimes times;
  return fit::measure_scan(virtual_booth::scan_body(body, booth).cloud, {}, times);
}

// A body in a garment of one line.
struct Dressed {
  Dressed(const fit::Body& body, const std::string& region, const std::string& line, double ratio) {
    fit::StageTimes times;
    const auto pattern =
        control_mesh::load_template(TENSEGRIC_FIT_SOURCE_DIR "/launch/templates/" + region + ".yaml");
    const fit::Fitting fitting = fit::prepare(body, std::vector{pattern}, {}, times);
    tensegric::Garment garment = tensegric::take_garment(line, TENSEGRIC_FIT_SOURCE_DIR "/launch/garments");
    tensegric::set_ratio(garment, "", ratio);
    deformed = fit::wear(body, fitting, garment, {}, times).deformed;
    control = {fitting.control.outer, fitting.control.triangles};
  }
  std::vector<Vector3d> deformed;
  TriangleMesh control;
};

inline SimulatedBody simulated(const fit::Body& body, const Dressed& dressed) {
  return {body.mesh.mesh, dressed.deformed, dressed.control, body.measures, body.mesh.filled};
}

inline WornBody worn(const fit::Body& body) {
  return {body.mesh.mesh, body.mesh.filled, body.measures};
}

}  // namespace tensegric_fit::correlation
