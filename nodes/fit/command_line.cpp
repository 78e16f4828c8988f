#include "fit/command_line.hpp"

#include <fmt/format.h>

#include <cmath>
#include <tuple>

#include "fit/parsed_line.hpp"

namespace tensegric_fit::fit {
namespace {

constexpr int kShapeTriangles = 400;  // fins and limbs of a shape take more than a bust

double number_from(const std::string& text, const std::string& option) {
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
  }
  if (used == 0 || used != text.size()) throw CLI::ValidationError(option, "'" + text + "' is not a number");
  return value;
}

RatioRequest ratio_from(const std::string& text) {
  const std::size_t equals = text.find('=');
  const RatioRequest request{
      equals == std::string::npos ? "" : text.substr(0, equals),
      number_from(equals == std::string::npos ? text : text.substr(equals + 1), "--ratio")};
  if (equals == 0) throw CLI::ValidationError("--ratio", "'" + text + "' names no line");
  if (!tensegric::kRatio.holds(request.ratio))
    throw CLI::ValidationError("--ratio", fmt::format("'{}' is outside [{}, {}]", text, tensegric::kRatio.low,
                                                      tensegric::kRatio.high));
  return request;
}

tensegric::TensionLaw band_from(const std::string& text) {
  tensegric::TensionLaw law;
  if (text == "rigid") return law;
  law.kind = tensegric::TensionLaw::Kind::stiffness;
  law.stiffness = number_from(text, "--band");
  if (!(law.stiffness > 0 && tensegric::kTension.holds(law.stiffness)))
    throw CLI::ValidationError("--band", fmt::format("'{}' is neither 'rigid' nor a stiffness in (0, {}]",
                                                     text, tensegric::kTension.high));
  return law;
}

Eigen::Vector3d vector_from(const std::string& text, const std::string& option) {
  Eigen::Vector3d v;
  std::size_t start = 0;
  for (int i = 0; i < 3; ++i) {
    const std::size_t comma = i < 2 ? text.find(',', start) : text.size();
    if (comma == std::string::npos) throw CLI::ValidationError(option, "'" + text + "' is not x,y,z");
    v[i] = number_from(text.substr(start, comma - start), option);
    start = comma + 1;
  }
  if (!v.allFinite()) throw CLI::ValidationError(option, "'" + text + "' is not finite");
  return v;
}

}  // namespace

std::optional<int> parse(int argc, const char* const* argv, CommandLine& line, std::ostream& errors) {
  CLI::App app(
      "From a booth scan to the body that a garment would make of it. Exit: 0 done, 2 usage, 3 input "
      "refused, 1 the results cannot be written.");
  std::vector<std::string> ratios;
  std::string band, gravity, solver = to_string(line.settings.solver.solver),
                             volume = tensegric::kVolumeWords.of(line.settings.solver.volume);

  auto* scan = app.add_option("--scan", line.scans,
                              "Scan: FILE.ply, .pcd, .xyz, .bag, or a mesh .obj, .stl, .glb, .gltf; may be "
                              "repeated: parts of one person, in one frame")
                   ->allow_extra_args(false);
  auto* mesh = app.add_option("--mesh", line.mesh,
                              "Body mesh .ply, .obj, .stl, .glb, .gltf, taken as it is instead of a scan");
  app.add_option("--unit", line.asked.unit,
                 "Unit of the scan, or of mesh and control mesh; default: inferred from the body")
      ->check(CLI::IsMember({"m", "cm", "mm", "inch"}));
  app.add_option("--up", line.asked.up, "Their axis that points up; default: inferred from the body")
      ->check(CLI::IsMember({"x", "y", "z", "-x", "-y", "-z"}));
  app.add_option(
         "--export", line.exports,
         "Also files for makers' programs: any of obj,glb,stl; with them measures.json and measures.vit")
      ->delimiter(',')
      ->check(CLI::IsMember({"obj", "glb", "stl"}));
  auto* garment =
      app.add_option("--garment", line.garment, "Shipped garment (B1 ...) or FILE.yaml; none: measure only");
  app.add_option(
         "--ratio", ratios,
         "Neutral length / length at rest: R for every line, or LINE=R; may be repeated, the last counts")
      ->needs(garment);
  app.add_option("--band", band, "rigid, or the stiffness of every line")->needs(garment);
  app.add_option("--templates", line.templates,
                 "Folder of control mesh templates, REGION.yaml, in place of the shipped")
      ->needs(garment)
      ->check(CLI::ExistingDirectory);
  app.add_option("--tissue", line.tissue, "What the tissue is like: a file as `calibrate` writes it")
      ->needs(garment)
      ->check(CLI::ExistingFile);
  auto* solver_word = app.add_option("--solver", solver, "Solver")
                          ->capture_default_str()
                          ->check(CLI::IsMember(tensegric::kSolverWords.all()));
  auto* volume_word =
      app.add_option("--volume", volume, "Whose volume is kept: the control mesh's or the body's")
          ->capture_default_str()
          ->check(CLI::IsMember(tensegric::kVolumeWords.all()));
  auto* control_triangles =
      app.add_option("--control-triangles", line.settings.control_mesh.control_triangles,
                     fmt::format("Control triangles, at least; of a shape that is simplified about as many, "
                                 "default: {}",
                                 kShapeTriangles))
          ->capture_default_str()
          ->check(whole_in(control_mesh::kControlTriangles));
  app.add_option("--body-triangles", line.settings.reconstruction.body_triangles,
                 "Triangles of the body mesh")
      ->capture_default_str()
      ->check(whole_in(reconstruction::kBodyTriangles))
      ->excludes(mesh);
  app.add_flag("--bust-only", line.settings.reconstruction.bust_only,
               "Legs, hands and head of a scan come coarse, in less time: enough for a bust garment")
      ->excludes(mesh);
  app.add_option("--customer", line.customer,
                 "Your own id of her, for the report: `history` finds her by it");
  app.add_option("--out", line.out, "Folder for the results")->capture_default_str();
  auto* control = app.add_option("--control", line.control,
                                 "Control mesh CONTROL.ply for any shape; none: the shape simplified")
                      ->needs(mesh)
                      ->excludes(control_triangles);
  auto* fixed =
      app.add_option("--fixed", line.fixed,
                     "Fixed nodes of the shape's control mesh, NODES.yaml: by number, or by boxes in "
                     "metres, z up")
          ->needs(mesh);
  auto* force = app.add_option(
      "--gravity", gravity,
      "A force x,y,z, the same on every outer node; of length 1 it would move the node that goes "
      "farthest by a tenth of the shape's size (its box's diagonal), if the shape gave way all along "
      "as it does at rest");
  double twist = 0, lean = 0;
  for (const auto& [name, angle, limit, what] :
       {std::tuple("--twist", &twist, std::round(geometry::kLargestTwist * 180 / M_PI),
                   "Degrees that the chest turns to her left"),
        std::tuple("--lean", &lean, std::round(geometry::kLargestLean * 180 / M_PI),
                   "Degrees that the chest leans to her left")})
    app.add_option(name, *angle, what)->needs(garment)->check(number_in(-limit, limit));
  auto* overlay = app.add_flag("--overlay", line.overlay,
                               "front.png and side.png show the registered body model over the body");
  app.add_flag("--quiet", line.quiet, "No progress");
  scan->excludes(mesh);
  control->needs(fixed);
  fixed->excludes(garment);
  overlay->excludes(fixed);

  const auto exit_code = parsed(app, argc, argv, errors, [&] {
    if (line.scans.empty() && line.mesh.empty()) throw CLI::RequiredError("--scan or --mesh");
    for (const std::string& text : ratios) line.ratios.push_back(ratio_from(text));
    if (!band.empty()) line.band = band_from(band);
    for (const CLI::Option* option : {solver_word, volume_word, control_triangles, force})
      if (option->count() > 0 && line.garment.empty() && !line.is_shape())
        throw CLI::ValidationError(option->get_name(), "needs --garment or --fixed");
    if (!gravity.empty()) line.gravity = vector_from(gravity, "--gravity");
  });
  if (exit_code) return exit_code;
  if (line.is_shape() && control_triangles->count() == 0)
    line.settings.control_mesh.control_triangles = kShapeTriangles;
  if (line.is_shape()) line.settings.model = tensegric::papers_model();  // a shape has no bones
  line.posture = {twist * M_PI / 180, lean * M_PI / 180};
  line.settings.solver.volume = *tensegric::kVolumeWords.find(volume);
  line.settings.solver.solver = tensegric::solver_from(solver);
  return std::nullopt;
}

std::optional<int> parse(const std::vector<std::string>& arguments, CommandLine& line, std::ostream& errors) {
  std::vector<const char*> words{"fit"};
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  return parse(static_cast<int>(words.size()), words.data(), line, errors);
}

tensegric::Garment adjusted(tensegric::Garment garment, const CommandLine& line) {
  for (const RatioRequest& request : line.ratios) tensegric::set_ratio(garment, request.line, request.ratio);
  if (line.band)
    for (tensegric::GarmentLine& l : garment.lines) l.law = *line.band;
  return garment;
}

}  // namespace tensegric_fit::fit
