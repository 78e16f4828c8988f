#include "fit/fitted_folder.hpp"

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "fit/result_documents.hpp"
#include "geometry/ply.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::fit {
namespace {

namespace fs = std::filesystem;
namespace refusal = geometry::refusal;
using geometry::Refusal;
using nlohmann::json;

json known_document(const fs::path& path) {
  const json document = read_document(path);
  if (document.is_discarded()) throw Refusal(refusal::kBrokenFile, path.string() + ": no file of JSON");
  return document;
}

void add_lines(const json& lines, FittedFolder& fitted) {
  for (const json& line : lines)
    fitted.lines.push_back({line.at("name").get<std::string>(), line.at("request").get<double>(),
                            line.at("ratio").get<double>()});
}

// The worn scan is aligned on skin that the garment leaves alone; a posture moves that, too.
void check_posture(const json& posture, std::initializer_list<const char*> angles, const std::string& which) {
  for (const char* angle : angles)
    if (posture.at(angle).get<double>() != 0)
      throw Refusal(refusal::kBadOption,
                    which + ": its fit is in a posture, twisted or leaning: fit once more without one");
}

// What `fit` wrote.
void read_report(const json& report, const std::string& folder, FittedFolder& fitted) {
  if (report.at("status") != "ok")
    throw Refusal(refusal::kNothingYet,
                  folder + ": fit refused its scan: " + report.at("reason").at("message").get<std::string>());
  if (!report.contains("lines"))
    throw Refusal(refusal::kNothingYet,
                  folder + ": fit measured a body without a garment: simulate one first");
  check_posture(report.at("posture"), {"twist", "lean"}, folder);
  fitted.scan = report.at("scan").at("file").get<std::string>();
  add_lines(report.at("lines"), fitted);
}

// What the pipeline exported.
void read_export(const json& document, FittedFolder& fitted) {
  if (!document.at("body").value("head", true))
    throw Refusal(
        std::string(refusal::kMissingPart) + ":head",
        "this export has no head, without which its body cannot be measured again: export it with tffd's "
        "parameter with_head, or take a folder of fit");
  check_posture(document.at("posture"), {"twist_rad", "side_lean_rad"}, "this export");
  fitted.scan = "scan " + document.at("scan").at("scan_id").get<std::string>();
  add_lines(document.at("garment").at("lines"), fitted);
}

}  // namespace

FittedFolder read_fitted_folder(const std::string& folder) {
  const fs::path root(folder), report = root / kFitReport, document = root / kExportDocument;
  FittedFolder fitted;
  const bool by_fit = fs::exists(report);
  if (!by_fit && !fs::exists(document))
    throw Refusal(refusal::kBrokenFile, folder + ": has neither " + kFitReport + ", as fit writes it, nor " +
                                            kExportDocument + ", as an export has it");
  try {
    if (by_fit)
      read_report(known_document(report), folder, fitted);
    else
      read_export(known_document(document), fitted);
  } catch (const json::exception&) {
    throw Refusal(refusal::kBrokenFile, (by_fit ? report : document).string() + ": not as " +
                                            (by_fit ? "fit writes it" : "an export has it"));
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
