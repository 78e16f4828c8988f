#include "fit/correlate_line.hpp"

#include "fit/parsed_line.hpp"

namespace tensegric_fit::fit {

std::optional<int> parse(int argc, char** argv, CorrelateLine& line) {
  CLI::App app(
      "How the body that `fit` simulated differs from a scan of the person in the real garment. Exit: 0 "
      "done, "
      "2 usage, 3 input refused, 1 the results cannot be written.");
  app.add_option("--fit", line.fit, "Folder that `fit --garment` wrote, or an export of the pipeline")
      ->required();
  auto* worn =
      app.add_option("--worn", line.worn,
                     "Second scan, with the garment on, in any frame: FILE.ply, .pcd, .xyz, .bag, or a "
                     "mesh .obj, .stl, .glb, .gltf");
  auto* mesh = app.add_option("--mesh", line.mesh,
                              "Body mesh .ply, .obj, .stl, .glb, .gltf, taken as it is instead of a scan");
  app.add_option("--unit", line.asked.unit,
                 "Unit of the second scan or mesh; default: inferred from the body")
      ->check(CLI::IsMember({"m", "cm", "mm", "inch"}));
  app.add_option("--up", line.asked.up, "Its axis that points up; default: inferred from the body")
      ->check(CLI::IsMember({"x", "y", "z", "-x", "-y", "-z"}));
  app.add_option("--thickness", line.options.thickness,
                 "Of the garment, metres: what its outside stands off the skin that it covers")
      ->capture_default_str()
      ->check(number_in(correlation::kThickness.low, correlation::kThickness.high));
  app.add_option("--body-triangles", line.settings.reconstruction.body_triangles,
                 "Triangles of the worn body's mesh")
      ->capture_default_str()
      ->check(whole_in(reconstruction::kBodyTriangles))
      ->excludes(mesh);
  app.add_option("--out", line.out, "Folder for the results")->capture_default_str();
  app.add_flag("--quiet", line.quiet, "No progress");
  worn->excludes(mesh);
  return parsed(app, argc, argv, std::cerr, [&line] {
    if (line.worn.empty() && line.mesh.empty()) throw CLI::RequiredError("--worn or --mesh");
  });
}

}  // namespace tensegric_fit::fit
