// What mesh and body model say of every figure of known bodies, a line of JSON a body: what fit_precision.py
// and fit_standing.py fit their coefficients to. Bodies that the file has already are left out, so a run goes
// on where it ended. With fewer components the model is worse than it need be: women stand outside its span.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>

#include "body_model/registration.hpp"
#include "geometry/ply.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"
#include "landmarks/find_landmarks.hpp"
#include "reconstruction/reconstruct.hpp"
#include "scan_files/scan_file.hpp"

namespace {

using namespace tensegric_fit;
using Json = nlohmann::json;

Json json_of(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

Json json_of(const body_model::Stance& stance) {
  return {{"up", json_of(stance.up)},
          {"forward", json_of(stance.forward)},
          {"legs", json_of(stance.legs)},
          {"soles", json_of(stance.soles)}};
}

Json readings_of(const landmarks::Reading& reading, const body_model::RegisteredBody& model) {
  Json result{{"residual", model.residual},
              {"scale", std::exp(model.parameters.log_scale)},
              {"stance", json_of(body_model::stance_of(model))},
              {"turn_of_feet", body_model::turn_of_feet(model)},
              {"vertical", json_of(model.vertical)},
              {"ground", model.ground},
              {"ground_deviation", model.ground_deviation},
              {"figures", Json::array()}};
  for (int i = 0; i < 16; ++i)
    result["body_from_scan"].push_back(reading.body_from_scan.matrix()(i / 4, i % 4));
  for (const landmarks::Figure& figure : reading.figures) {
    if (figure.shared > 0) continue;  // its error comes from the body, not from reading it
    Json entry{{"kind", static_cast<int>(figure.kind)},
               {"name", figure.name},
               {"support", figure.support},
               {"seen", figure.seen}};
    if (figure.shift > 0) entry["shift"] = figure.shift;
    if (figure.on_mesh) entry["mesh"] = json_of(*figure.on_mesh);
    if (figure.on_model) entry["model"] = json_of(*figure.on_model);
    result["figures"].push_back(std::move(entry));
  }
  return result;
}

Json read_mesh(const std::string& path, const body_model::Registrar& registrar) {
  const geometry::TriangleMesh mesh = geometry::read_ply_mesh(path);
  const body_model::RegisteredBody model = register_mesh(registrar, mesh);
  return readings_of(landmarks::read_figures(mesh, {}, model, landmarks::shipped_precision()), model);
}

Json read_scan(const std::string& path, const body_model::Registrar& registrar) {
  const auto [body, model] =
      reconstruction::reconstruct(geometry::points_of(scan_files::read_scan_file(path).cloud), {},
                                  {std::cref(registrar), registrar.standing()});
  return readings_of(landmarks::read_figures(body.mesh, body.filled, model, landmarks::shipped_precision()),
                     model);
}

/// The model's first components; 0: all of them.
body_model::Model cut(body_model::Model model, int components) {
  if (components > 0 && components < model.components()) {
    model.basis = Eigen::MatrixXf(model.basis.topRows(components));
    model.inner_basis = Eigen::MatrixXd(model.inner_basis.topRows(components));
  }
  return model;
}

}  // namespace

int main(int argc, char** argv) {
  std::string kind, folder, out, first, last = "~",
                                        model = geometry::shipped_folder("body_model") + "/women.tfb";
  CLI::App app("Readings of bodies with known truth");
  app.add_option("kind", kind, "mesh: NAME_body.ply; scan: NAME_scan.ply")
      ->required()
      ->check(CLI::IsMember({"mesh", "scan"}));
  app.add_option("folder", folder)->required()->check(CLI::ExistingDirectory);
  app.add_option("--out", out, "lines are added to it")->required();
  app.add_option("--first", first, "name of the first body");
  app.add_option("--last", last, "name of the last body");
  app.add_option("--model", model,
                 "a model that was trained without these bodies: precision of those that it knows is none")
      ->check(CLI::ExistingFile);
  int components = 0;
  app.add_option("--components", components, "the model's first ones only; its lines are marked as cut")
      ->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);

  const body_model::Registrar registrar(cut(body_model::load_model(model), components),
                                        body_model::shipped_registrar().standing());
  std::set<std::string> known;
  std::ifstream before(out);
  std::uintmax_t whole = 0;  // bytes
  for (std::string line; std::getline(before, line);) {
    if (before.eof()) break;  // it was cut short when a run was ended
    whole += line.size() + 1;
    const Json read = Json::parse(line);
    if (read.value("cut", 0) == components) known.insert(read.at("name"));
  }
  if (before.is_open() && std::filesystem::file_size(out) > whole) std::filesystem::resize_file(out, whole);
  const std::string ending = kind == "mesh" ? "_body.ply" : "_scan.ply";
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string file = entry.path().filename();
    if (file.size() <= ending.size() || file.substr(file.size() - ending.size()) != ending) continue;
    const std::string name = file.substr(0, file.size() - ending.size());
    if (name >= first && name <= last && known.count(name) == 0) names.insert(name);
  }
  for (const std::string& name : names) {
    try {
      const std::string path = folder + "/" + name + ending;
      Json readings = kind == "mesh" ? read_mesh(path, registrar) : read_scan(path, registrar);
      readings["name"] = name;
      if (components > 0) readings["cut"] = components;
      std::ofstream(out, std::ios::app) << readings.dump() << "\n";
    } catch (const geometry::Refusal& refusal) {
      std::cerr << fmt::format("{}: {}\n", name, refusal.what());
    }
  }
}
