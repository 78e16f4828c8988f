#include "fit/fitted_folder.hpp"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "geometry/ply.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::fit {
namespace {

namespace fs = std::filesystem;
namespace refusal = geometry::refusal;
using geometry::Refusal;
using nlohmann::json;

json read_report(const fs::path& path) {
  std::ifstream file(path);
  if (!file)
    throw Refusal(refusal::kBrokenFile, path.string() + ": cannot be read; is this a folder that fit wrote?");
  try {
    return json::parse(file);
  } catch (const json::exception&) {
    throw Refusal(refusal::kBrokenFile, path.string() + ": not JSON");
  }
}

}  // namespace

FittedFolder read_fitted_folder(const std::string& folder) {
  const fs::path root(folder);
  const json report = read_report(root / "report.json");
  FittedFolder fitted;
  try {
    if (report.at("status") != "ok")
      throw Refusal(refusal::kNothingYet, folder + ": fit refused its scan: " +
                                              report.at("reason").at("message").get<std::string>());
    if (!report.contains("lines"))
      throw Refusal(refusal::kNothingYet,
                    folder + ": fit measured a body without a garment: simulate one first");
    fitted.scan = report.at("scan").at("file").get<std::string>();
    for (const json& line : report.at("lines"))
      fitted.lines.push_back({line.at("name").get<std::string>(), line.at("request").get<double>(),
                              line.at("ratio").get<double>()});
  } catch (const json::exception&) {
    throw Refusal(refusal::kBrokenFile, (root / "report.json").string() + ": not a report as fit writes it");
  }
  fitted.rest = geometry::read_ply_mesh((root / "body.ply").string());
  geometry::TriangleMesh deformed = geometry::read_ply_mesh((root / "deformed.ply").string());
  fitted.control = geometry::read_ply_mesh((root / "control.ply").string());
  if (deformed.vertices.size() != fitted.rest.vertices.size() || deformed.triangles != fitted.rest.triangles)
    throw Refusal(refusal::kBadMesh,
                  folder + ": body.ply has " + std::to_string(fitted.rest.vertices.size()) +
                      " vertices and deformed.ply " + std::to_string(deformed.vertices.size()) +
                      ", or other triangles: they are not of one fit");
  fitted.deformed = std::move(deformed.vertices);
  return fitted;
}

}  // namespace tensegric_fit::fit
