// What people write in YAML. The first byte chooses what it is, the rest is the file.
#include <array>

#include "control_mesh/shape_control.hpp"
#include "control_mesh/template.hpp"
#include "depth_cameras/camera_poses.hpp"
#include "fit/tissue_file.hpp"
#include "fuzz_target.hpp"
#include "geometry/shipped_files.hpp"
#include "tensegric/garment.hpp"

namespace {

using namespace tensegric_fit;

void check_ratios(const tensegric::Garment& garment) {
  for (const tensegric::GarmentLine& line : garment.lines) fuzz::require(tensegric::kRatio.holds(line.ratio));
}

void read_garment(const std::string& path) {
  tensegric::Garment garment = tensegric::load_garment(path);
  check_ratios(garment);
  tensegric::set_ratio(garment, garment.lines.back().name, 0.9);
  fuzz::refused_or_done([&] { tensegric::set_ratio(garment, "no such line", garment.lines.front().ratio); });
  fuzz::refused_or_done([&] { tensegric::set_ratio(garment, "", garment.lines.front().width * 100); });
}

/// Two garments in one.
void join_garments(const std::string& path) {
  check_ratios(tensegric::take_garment("B2+" + path, geometry::shipped_folder("garments")));
}

/// Two pieces: a tetrahedron, and a roof that is open.
geometry::TriangleMesh shape() {
  return {{{0, 0, 0},
           {1, 0, 0},
           {0, 1, 0},
           {0, 0, 1},
           {3, 0, 0},
           {4, 0, 0},
           {4, 1, 0.5},
           {3, 1, 0.5},
           {3, 2, 0},
           {4, 2, 0}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {4, 5, 6}, {4, 6, 7}, {7, 6, 9}, {7, 9, 8}}};
}

void fix_shape(const std::string& path) {
  const control_mesh::ShapeFixing fixing = control_mesh::load_shape_fixing(path);
  const geometry::TriangleMesh mesh = shape();
  fuzz::refused_or_done([&] {
    for (const Eigen::Vector3d& v : control_mesh::control_from_shape(mesh, fixing).inner)
      fuzz::require(v.allFinite());
  });
  fuzz::refused_or_done([&] { control_mesh::simplified_control(mesh, fixing, 6); });
}

void read_tissue(const std::string& path) {
  fit::Settings settings;
  fit::take_tissue(path, settings);
  fuzz::require(tensegric::kLayers.holds(settings.model.layers));
}

void read_cameras(const std::string& path) {
  for (const Eigen::Isometry3d& pose : depth_cameras::load_camera_poses(path, {"left", "right"}))
    fuzz::require(pose.matrix().allFinite() && std::abs(pose.linear().determinant() - 1) < 1e-9);
}

void read_template(const std::string& path) {
  control_mesh::load_template(path);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const fuzz::InputFile file(data + 1, size - 1, ".yaml");
  constexpr std::array kKinds{read_garment, read_template, fix_shape,
                              read_tissue,  read_cameras,  join_garments};
  fuzz::refused_or_done([&] { kKinds[data[0] % kKinds.size()](file.path()); });
  return 0;
}
