#include "control_mesh/control_mesh_handler.hpp"

#include <fmt/format.h>

#include <boost/make_shared.hpp>

#include "body_model/model_message.hpp"
#include "body_model/registration.hpp"
#include "control_mesh/grid.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"
#include "ros/body_messages.hpp"

namespace tensegric_fit::node {
namespace {

std::optional<body_model::RegisteredBody> registered(const geometry::TriangleMesh& mesh,
                                                     const std::vector<char>& filled,
                                                     const BodyModel::ConstPtr& message,
                                                     std::string& origin) {
  const body_model::Registrar& registrar = body_model::shipped_registrar();
  if (message) return registered_in(*message, registrar.shared_model());
  try {
    origin = "registered to the mesh";
    return body_model::register_mesh(registrar, mesh, filled);
  } catch (const geometry::Refusal& refusal) {
    origin = "none: " + refusal.code();
    return std::nullopt;
  }
}

}  // namespace

ControlMeshHandler::ControlMeshHandler(Parameters parameters) {
  control_mesh::Options& options = options_.front();
  options.control_triangles =
      parameters.integer("control_triangles", options.control_triangles, control_mesh::kControlTriangles);
  options.thickness = parameters.number("thickness", options.thickness, control_mesh::kThickness);
  const int coarse =
      parameters.integer("coarse_triangles", 0, {0, control_mesh::kControlTriangles.high});  // 0: none
  const std::string names = parameters.text("template", "bust+hips");
  const std::string folder = parameters.text("template_directory", geometry::shipped_folder("templates"));
  parameters.check_all_known();
  for (const std::string& name : geometry::joined_words(names)) {
    if (name.empty())
      throw geometry::Refusal(geometry::refusal::kBadOption,
                              "parameter 'template' has an empty name: '" + names + "'");
    patterns_.push_back(
        control_mesh::load_template(geometry::yaml_file(folder, name, geometry::refusal::kBadTemplate)));
  }
  control_mesh::check_together(patterns_);
  if (coarse == 0) return;
  if (coarse >= options.control_triangles)
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            fmt::format("coarse_triangles is {}, not less than control_triangles ({})",
                                        coarse, options.control_triangles));
  options_.push_back({coarse});  // of the thickness that the default tissue, which it is solved with, is for
}

std::optional<ControlMeshHandler::Input> ControlMeshHandler::with_model(
    const std::optional<Join::Joined>& joined) {
  if (!joined) return std::nullopt;
  const auto& [landmarks, mesh] = *joined;
  const bool its = model_ && model_->scan_id == mesh->scan_id;
  if (model_ && !its && model_->header.stamp <= mesh->header.stamp) model_.reset();  // of a scan before
  return Input{landmarks, mesh, its ? model_ : nullptr};
}

ControlMeshHandler::Output ControlMeshHandler::handle(const Input& input) const {
  const auto& [landmarks, mesh, model_message] = input;
  Output output;
  output.body = mesh_in(*mesh);
  const geometry::BodyMeasures measures = measures_in(*landmarks);
  output.body_from_scan = measures.body_from_scan;

  std::string origin = "came with the mesh";
  const std::optional<body_model::RegisteredBody> model =
      registered(output.body, filled_in(*mesh), model_message, origin);

  const control_mesh::BodySkin skin(output.body, measures, model ? &*model : nullptr);
  std::vector<geometry::ControlMesh> parts, coarse_parts;
  std::optional<geometry::Refusal> first;
  for (const control_mesh::Template& pattern : patterns_) {
    try {
      const auto laid = control_mesh::fit_template_for_each(pattern, skin, options_);
      parts.push_back(laid.front());
      if (laid.size() > 1) coarse_parts.push_back(laid.back());
    } catch (const geometry::Refusal& refusal) {
      if (!first) first = refusal;
      output.left_out += (output.left_out.empty() ? "" : "; ") + pattern.name + ": " + refusal.what();
    }
  }
  if (parts.empty()) throw *first;

  output.control_mesh = geometry::joined(parts);
  output.control = boost::make_shared<ControlMesh>(to_message(tag_in(*mesh), output.control_mesh));
  if (!coarse_parts.empty())
    output.coarse =
        boost::make_shared<ControlMesh>(to_message(tag_in(*mesh), geometry::joined(coarse_parts)));
  output.facts = {{"nodes", std::to_string(output.control_mesh.outer.size())},
                  {"triangles", std::to_string(output.control_mesh.triangles.size())},
                  {"body_model", origin},
                  {"left_out", output.left_out}};
  return output;
}

}  // namespace tensegric_fit::node
