#include "landmarks/figures.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/checked_yaml.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::landmarks {
namespace {

constexpr const char* kCode = geometry::refusal::kBrokenFile;
constexpr double kLargest = 100;  // of any coefficient
// m, of a deviation. Numerical tolerance: readings are weighed by its inverse square, and 0 would give 0 / 0;
// those that were fitted are 8e-5 and more.
constexpr double kLeast = 1e-6;
constexpr double kSteepest = 10;  // power of the misfit that a file may give: fit_precision.py stops at 4
constexpr double kSure = 1.5;     // of ISO 20685's limits: on training scans 3 % of the figures within it are
                                  // off by more than the limit
constexpr double kGrossLimits = 3;  // of ISO 20685: less is no gross error, however sure both are
constexpr double kUnit =
    0.002;  // m of misfit that Spread::base is for (definition; also in fit_precision.py)
constexpr double kNormal = 1.96;  // quantile of the normal distribution at 97.5 % (definition)
constexpr double kGross = 4;  // spreads between two readings of one thing: with Gaussian errors 1 in 16,000
constexpr double kNearlyGross = 0.75;  // of that distance (any share below 1 does): from here on the mesh
                                       // counts less, so that no figure jumps

Spread spread_in(const YAML::Node& node, const std::string& where) {
  geometry::check_keys(node, {"bias", "base", "growth", "support", "outside", "shift"}, where, kCode);
  return {geometry::number_in(node, "bias", -kLargest, kLargest, where, kCode),
          geometry::number_in(node, "base", kLeast, kLargest, where, kCode),
          geometry::number_in(node, "growth", 0, kSteepest, where, kCode),
          geometry::number_in(node, "support", 0, kLargest, where, kCode),
          geometry::number_in(node, "outside", 0, kLargest, where, kCode),
          node["shift"] ? geometry::number_in(node, "shift", 0, kLargest, where, kCode) : 0};
}

Span span_in(const YAML::Node& map, const char* key, const std::string& where) {
  const auto ends = geometry::required<std::vector<double>>(map, key, where, kCode);
  if (ends.size() != 2 || !(ends[0] > 0) || !(ends[1] > ends[0]) || !(ends[1] < kLargest))
    throw geometry::Refusal(kCode,
                            where + ": " + key + " must be two misfits in m, the second the larger one");
  return {ends[0], ends[1]};
}

std::map<std::string, FigurePrecision> figures_in(const YAML::Node& node, const std::string& where) {
  if (!node || !node.IsMap()) throw geometry::Refusal(kCode, where + " must be a map of figures");
  std::map<std::string, FigurePrecision> figures;
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) throw geometry::Refusal(kCode, where + ": the name of a figure is no text");
    const std::string name = entry.first.Scalar(), here = where + ", " + name;
    geometry::check_keys(
        entry.second,
        {"mesh", "model", "disagreement", "half_width", "half_width_of_model", "error", "covered", "n"}, here,
        kCode);
    const FigurePrecision figure{
        spread_in(geometry::required<YAML::Node>(entry.second, "mesh", here, kCode), here + ", mesh"),
        spread_in(geometry::required<YAML::Node>(entry.second, "model", here, kCode), here + ", model"),
        geometry::number_in(entry.second, "disagreement", 0, kLargest, here, kCode),
        geometry::number_in(entry.second, "half_width", 0, kLargest, here, kCode),
        geometry::number_in(entry.second, "half_width_of_model", 0, kLargest, here, kCode)};
    if (!figures.emplace(name, figure).second) throw geometry::Refusal(kCode, here + " is given twice");
  }
  return figures;
}

std::string key_of(const Figure& figure) {
  constexpr const char* kKinds[] = {"point ", "height ", "girth "};
  std::string name = figure.name;
  if (name.size() > 2 && (name.substr(name.size() - 2) == "_L" || name.substr(name.size() - 2) == "_R"))
    name.resize(name.size() - 2);
  return kKinds[static_cast<int>(figure.kind)] + name;
}

double deviation(const Spread& spread, const Figure& figure) {
  return std::hypot(std::hypot(spread.base * std::pow(figure.misfit / kUnit, spread.growth),
                               spread.support * figure.support),
                    spread.shift * figure.shift);
}

/// 0 to 1: how far the body is outside what the model can make.
double share_outside(const Span& span, double misfit) {
  return misfit <= span.women ? 0 : std::min((misfit - span.women) / (span.others - span.women), 1.0);
}

const FigurePrecision& precision_of(const Figure& figure, const Precision& precision, bool scanned) {
  const auto& of_source = scanned ? precision.of_scan : precision.of_mesh;
  const auto found = of_source.find(key_of(figure));
  if (found == of_source.end())
    throw geometry::Refusal(
        kCode, "the precision of '" + key_of(figure) + "' is not known: the file does not fit this version");
  return found->second;
}

}  // namespace

Precision load_precision(const std::string& path) {
  const YAML::Node root = geometry::load_yaml_map(path, kCode);
  geometry::check_keys(root, {"made", "bodies", "span", "mesh", "scan"}, path, kCode);
  if (!root["span"] || !root["span"].IsMap())
    throw geometry::Refusal(kCode, path + ": span must be a map of mesh and scan");
  geometry::check_keys(root["span"], {"mesh", "scan"}, path + ": span", kCode);
  return {figures_in(root["mesh"], path + ": mesh"), figures_in(root["scan"], path + ": scan"),
          span_in(root["span"], "mesh", path + ": span"), span_in(root["span"], "scan", path + ": span")};
}

const Precision& shipped_precision() {
  static const Precision precision =
      load_precision(geometry::shipped_folder("body_model") + "/precision.yaml");
  return precision;
}

double spread_of_model(const Figure& figure, const Precision& precision, bool scanned) {
  return deviation(precision_of(figure, precision, scanned).model, figure);
}

Settled settle(const Figure& figure, const Precision& precision, bool scanned) {
  const FigurePrecision& p = precision_of(figure, precision, scanned);
  const double outside = share_outside(scanned ? precision.scan_span : precision.mesh_span, figure.misfit);
  const double mesh = std::hypot(deviation(p.mesh, figure), outside * p.mesh.outside),
               model = std::hypot(deviation(p.model, figure), outside * p.model.outside);
  const auto unbiased = [](const Eigen::Vector3d& reading, const Spread& spread) {
    return Eigen::Vector3d(reading - spread.bias * Eigen::Vector3d::UnitX());
  };
  const auto half_width = [&](double spreads, double own, double distance) {
    return std::hypot(spreads * std::hypot(own, p.disagreement * distance),
                      kNormal * std::hypot(figure.ground, figure.shared));
  };
  if (!figure.on_mesh)
    return {unbiased(*figure.on_model, p.model), half_width(p.half_width_of_model, model, 0), true};
  const Eigen::Vector3d on_mesh = unbiased(*figure.on_mesh, p.mesh);
  if (!figure.on_model) return {on_mesh, half_width(p.half_width, mesh, 0), false};
  const Eigen::Vector3d on_model = unbiased(*figure.on_model, p.model), apart = on_mesh - on_model;
  // A web, a fold of the belly, an arm that was cut off elsewhere: the mesh then shows something else. How
  // far off says no more of how well the model is right.
  const double gross = std::max(kGross * std::hypot(mesh, model), kGrossLimits * limit_of(figure)),
               distance = std::min(apart.norm(), gross);
  const double doubt =
      figure.seen ? 0 : std::clamp((apart.norm() / gross - kNearlyGross) / (1 - kNearlyGross), 0.0, 1.0);
  const double share = (1 - doubt) * model * model / (mesh * mesh + model * model);
  return {on_model + share * apart,
          half_width(p.half_width + doubt * (p.half_width_of_model - p.half_width),
                     std::hypot(share * mesh, (1 - share) * model), figure.seen ? apart.norm() : distance),
          doubt == 1};
}

const std::vector<Eigen::Vector3d>& tape_of(const Figure& figure, const Settled& settled) {
  return settled.rests_on_model ? figure.loop_on_model : figure.loop;
}

double limit_of(const Figure& figure) {
  // ISO 20685-1:2018, table 1: small girths and heights 4 mm, large girths 9 mm; points of the torso 10 mm,
  // of which bust points half.
  const auto is = [&](const char* name) { return figure.name.rfind(name, 0) == 0; };
  if (figure.kind == Kind::point) return is("bust_point") ? 0.005 : 0.010;
  return figure.kind == Kind::height || figure.name == "neck" || is("upper_arm") ? 0.004 : 0.009;
}

double confidence_of(const Figure& figure, const Settled& settled) {
  const double usual = kSure * limit_of(figure);
  return usual / (usual + settled.half_width);
}

std::string reason_of(const Figure& figure, const Settled& settled) {
  if (kNormal * figure.shared > kSure * limit_of(figure)) return figure.shared_reason;
  if (kNormal * figure.ground > kSure * limit_of(figure))
    return "where the ground is, is uncertain: no foot is there, or soles and lowest place do not agree";
  if (!settled.rests_on_model) return "surface and body model leave it open by more than ISO 20685 allows";
  if (!figure.on_mesh) return "the surface does not show it; it is where the body model has it";
  return "the surface shows something else there; it is where the body model has it";
}

}  // namespace tensegric_fit::landmarks
