#include "fit/compute.hpp"

#include <fmt/format.h>

#include <future>

#include "body_model/registration.hpp"
#include "control_mesh/grid.hpp"
#include "control_mesh/shape_control.hpp"
#include "fit/tissue_file.hpp"
#include "geometry/ply.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"
#include "scan_files/scan_file.hpp"
#include "tensegric/load_unit.hpp"

namespace tensegric_fit::fit {
namespace {

class Computation {
 public:
  Computation(const CommandLine& line, Computed& out, const std::function<void(const std::string&)>& say)
      : line_(line), out_(out), say_(say) {}

  // The chain: launch/pages/architecture.md. Refusals leave as exceptions.
  void operator()() {
    out_.settings = line_.settings;
    out_.source.customer = line_.customer;
    out_.source.file = line_.mesh.empty() ? line_.scans.front() : line_.mesh;
    if (line_.mesh.empty()) out_.source.more.assign(line_.scans.begin() + 1, line_.scans.end());
    if (line_.garment.empty() && !line_.is_shape()) return load_body();  // measured only
    // Small files first: what is wrong with them is said at once.
    const tensegric::Garment garment = load_garment();
    out_.source.garment = garment.name;
    check_fineness(garment);
    if (!line_.is_shape()) load_templates(garment);
    if (const std::string tissue = tissue_file(); !tissue.empty()) take_tissue(tissue, out_.settings);
    load_body();
    if (line_.posture.twist != 0 || line_.posture.side_lean != 0)
      out_.settings.solver.bones = geometry::BoneFrames(out_.body.measures, line_.posture);
    const Fitting& fitting = out_.fitting.emplace(prepare_fitting());
    tensegric::SolverOptions& solver = out_.settings.solver;
    solver.gravity = tensegric::force_of_share(fitting.model, line_.gravity, solver, fitting.body_volumes);
    solver.track = tracked_nodes(fitting.control);
    say_("tensegric deformation");
    out_.fit = wear(out_.body, fitting, garment, out_.settings, out_.times);
    out_.warnings = warnings_of(out_.body, fitting, *out_.fit, out_.settings);
  }

 private:
  void load_body() {
    std::future<void> loading;  // of the body model, while files are read; a broken one is refused at its use
    if (!line_.is_shape()) loading = std::async(std::launch::async, [] { body_model::shipped_registrar(); });
    if (!line_.mesh.empty()) {
      say_("reading the mesh");
      geometry::TriangleMesh mesh =
          scan_files::read_body_mesh(line_.mesh, line_.asked, line_.is_shape(), out_.source.reading);
      out_.source.points = mesh.vertices.size();
      out_.body = line_.is_shape() ? take_mesh(std::move(mesh))
                                   : measure_mesh(std::move(mesh), out_.settings, out_.times);
      return;
    }
    say_("reading the scan");
    const geometry::PointCloud scan = read_scans();
    out_.source.points = scan.points.size();
    say_("reconstruction, landmarks");
    out_.body = measure_scan(scan, out_.settings, out_.times);
  }

  geometry::PointCloud read_scans() {
    std::vector<scan_files::ScanFile> files;
    for (const std::string& file : line_.scans) files.push_back(scan_files::read_scan_file(file));
    out_.source.reading = scan_files::reading_of(files, line_.asked);
    std::vector<geometry::PointCloud> parts;
    for (scan_files::ScanFile& file : files) {
      scan_files::apply(out_.source.reading, file.cloud);
      parts.push_back(geometry::points_of(file.cloud));
    }
    return geometry::joined(parts);
  }

  // The defaults are calibrated for the shipped templates as they are; finer ones have tissue of their own.
  std::string tissue_file() const {
    const int asked = out_.settings.control_mesh.control_triangles;
    if (!line_.tissue.empty() || line_.is_shape() || asked <= control_mesh::Options().control_triangles)
      return line_.tissue;
    const control_mesh::Template* as_it_is = nullptr;
    const control_mesh::Template* finer = nullptr;
    for (const control_mesh::Template& one : templates_)
      (is_subdivided(one, asked) ? finer : as_it_is) = &one;
    if (finer == nullptr) return "";
    if (as_it_is != nullptr)
      throw geometry::Refusal(
          geometry::refusal::kBadOption,
          fmt::format("{} control triangles make '{}' finer, but '{}' has {} as it is, and the two need "
                      "tissue of their own: ask for more than {}, or give --tissue",
                      asked, finer->name, as_it_is->name, grid_of(*as_it_is).triangles.size(),
                      grid_of(*as_it_is).triangles.size()));
    return geometry::shipped_folder("tissue") + "/fine.yaml";
  }

  static bool is_subdivided(const control_mesh::Template& pattern, int asked) {
    return grid_of(pattern).triangles.size() < static_cast<std::size_t>(asked);
  }

  tensegric::Garment load_garment() const {
    if (line_.garment.empty()) return {};
    return adjusted(tensegric::take_garment(line_.garment, geometry::shipped_folder("garments")), line_);
  }

  void check_fineness(const tensegric::Garment& garment) const {
    if (!line_.settings.reconstruction.bust_only) return;
    for (const std::string& region : garment.regions)
      if (region != "bust")
        throw geometry::Refusal(geometry::refusal::kBadOption,
                                "--bust-only leaves all but the bust coarse, and garment " + garment.name +
                                    " is worn on the " + region);
  }

  void load_templates(const tensegric::Garment& garment) {
    const std::string folder =
        line_.templates.empty() ? geometry::shipped_folder("templates") : line_.templates;
    for (const std::string& region : garment.regions)
      templates_.push_back(
          control_mesh::load_template(geometry::yaml_file(folder, region, geometry::refusal::kBadGarment)));
    control_mesh::check_together(templates_);
  }

  // In the unit and axes of the mesh.
  geometry::TriangleMesh load_control() const {
    geometry::TriangleMesh control = geometry::read_ply_mesh(line_.control);
    if (!out_.source.reading.is_identity())
      for (Eigen::Vector3d& p : control.vertices) p = out_.source.reading(p);
    return control;
  }

  Fitting prepare_fitting() {
    say_("control mesh");
    if (line_.is_shape()) {
      const auto fixing = control_mesh::load_shape_fixing(line_.fixed);
      return prepare(out_.body,
                     line_.control.empty()
                         ? control_mesh::simplified_control(out_.body.mesh.mesh, fixing,
                                                            out_.settings.control_mesh.control_triangles)
                         : control_mesh::control_from_shape(load_control(), fixing),
                     out_.settings, out_.times);
    }
    return prepare(out_.body, templates_, out_.settings, out_.times);
  }

  const CommandLine& line_;
  Computed& out_;
  std::vector<control_mesh::Template> templates_;  // of the garment's regions
  const std::function<void(const std::string&)>& say_;
};

}  // namespace

nlohmann::ordered_json Computed::report() const {
  return report_of(source, body, fitting ? &*fitting : nullptr, fit ? &*fit : nullptr, warnings, settings,
                   times);
}

void compute(const CommandLine& line, Computed& computed,
             const std::function<void(const std::string&)>& say) {
  Computation(line, computed, say)();
}

}  // namespace tensegric_fit::fit
