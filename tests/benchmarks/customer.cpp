#include "customer.hpp"

#include <map>

#include "control_mesh/fit_template.hpp"
#include "fit/chain.hpp"
#include "geometry/decimate.hpp"
#include "geometry/ply.hpp"
#include "tffd/binding.hpp"
#include "virtual_booth/virtual_scanner.hpp"

namespace tensegric_fit::benchmarks {
namespace {

std::string body_file;

// The value for `key`, made where it is not there yet.
template <typename Key, typename Make>
const auto& kept(std::map<Key, std::decay_t<std::result_of_t<Make()>>>& all, const Key& key,
                 const Make& make) {
  auto found = all.find(key);
  if (found == all.end()) found = all.emplace(key, make()).first;
  return found->second;
}

}  // namespace

void choose_body(const std::string& ply_file) {
  body_file = ply_file;
}

const virtual_body::VirtualBody& customer() {
  static const virtual_body::VirtualBody one = [] {
    if (body_file.empty()) return virtual_body::make_body({});
    virtual_body::VirtualBody from_file;
    from_file.mesh = geometry::read_ply_mesh(body_file);
    return from_file;
  }();
  return one;
}

const geometry::PointCloud& scan(int points) {
  static std::map<int, geometry::PointCloud> all;
  return kept(all, points, [&] {
    virtual_booth::ScannerOptions options;
    options.points = points;
    options.misregistration = 0;
    return virtual_booth::scan_body(customer().mesh, options).cloud;
  });
}

const geometry::TriangleMesh& body(int triangles) {
  static std::map<int, geometry::TriangleMesh> all;
  return kept(all, triangles, [&] { return geometry::with_triangles(customer().mesh, triangles); });
}

const geometry::TriangleMesh& chest_skin(int triangles) {
  static std::map<int, geometry::TriangleMesh> all;
  return kept(all, triangles, [&] {
    const geometry::TriangleMesh& whole = body(62000);
    const tffd::Binding binding(whole, bust_control(120), {});
    std::vector<char> keep;
    for (const Eigen::Vector3i& t : whole.triangles)
      keep.push_back(binding.reaches(t[0]) && binding.reaches(t[1]) && binding.reaches(t[2]));
    return geometry::with_triangles(geometry::submesh(whole, keep), triangles);
  });
}

const geometry::ControlMesh& bust_control(int triangles) {
  static std::map<int, geometry::ControlMesh> all;
  static const fit::Body measured = [] {  // with the body model registered to it
    fit::StageTimes times;
    return fit::measure_mesh(body(62000), {}, times);
  }();
  return kept(all, triangles, [&] {
    control_mesh::Options options;
    options.control_triangles = triangles;
    const auto pattern = control_mesh::load_template(
        triangles < 120 ? TENSEGRIC_FIT_BENCHMARKS "/bust_60.yaml" : kLaunch + "/templates/bust.yaml");
    return control_mesh::fit_template(pattern, measured.mesh.mesh, measured.measures, options,
                                      &*measured.model);
  });
}

const tensegric::Model& bust_model(int control_triangles) {
  static std::map<int, tensegric::Model> all;
  return kept(all, control_triangles,
              [&] { return tensegric::build_model(bust_control(control_triangles), {}); });
}

tensegric::Garment band(double ratio) {
  tensegric::Garment garment = tensegric::load_garment(kLaunch + "/garments/B1.yaml");
  tensegric::set_ratio(garment, "", ratio);
  return garment;
}

tensegric::Garment chest_line(double ratio) {
  tensegric::Garment garment = band(ratio);
  for (tensegric::GarmentLine& line : garment.lines) line.width = line.smooth = 0;
  return garment;
}

const tensegric::Solution& worn(int control_triangles, double ratio) {
  static std::map<std::pair<int, double>, tensegric::Solution> all;
  return kept(all, std::make_pair(control_triangles, ratio),
              [&] { return tensegric::solve(bust_model(control_triangles), chest_line(ratio), {}); });
}

}  // namespace tensegric_fit::benchmarks
