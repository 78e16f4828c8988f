#include "virtual_booth/truth_file.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "geometry/json.hpp"
#include "virtual_booth/hidden_figures.hpp"

namespace tensegric_fit::virtual_booth {
namespace {

using Json = nlohmann::ordered_json;
using geometry::json_of;

Json measures(const std::vector<geometry::Measure>& list) {
  Json result = Json::object();
  for (const geometry::Measure& measure : list) result[measure.name] = measure.metres;
  return result;
}

Json definitions() {
  return {
      {"frame",
       "metres; body frame: x forward, y to her left, z up, origin on the floor between the feet; landmarks "
       "in the scan's frame, heights along body z"},
      {"bust_point", "tip of the nipple"},
      {"underbust",
       "most hollow place of the sagittal profile below the bust point; height: lowest such place "
       "from there to 55 mm towards the middle, over both sides"},
      {"waist",
       "interior minimum of the hull girth of the torso's loop between hip + 100 mm and underbust - 15 mm; "
       "without one "
       "the navel's level, as waist_ruler"},
      {"hip", "mean height of the apexes of parabolas through the buttocks' profiles"},
      {"girths",
       "hull perimeter of the horizontal section without the arms; bust and hip: all loops; underbust: the "
       "torso's loop "
       "3 mm below its height; neck: least girth in planes parallel to the neck's base, from there to 40 mm "
       "up"},
      {"crotch", "lowest place of the midline between the legs"},
      {"axilla", "highest level at which a gap parts arm and trunk"},
      {"shoulder", "outer edge of the acromion, which does not move out with fat, straight up to the skin"},
      {"vague", "figures that their definition does not settle on this body"},
      {"hidden", "figures at a place that no sensor sees"},
      {"hidden_on_surface", "those of them that no booth's sensors see: for who measures the body's mesh"},
      {"loose", "unit vectors, in the scan's frame, along which a landmark is open"}};
}

}  // namespace

void write_truth(const std::string& path, const virtual_body::VirtualBody& body,
                 const ScannerOptions& scanner) {
  Json truth = {{"name", "virtual_booth"}, {"family", body.family}, {"units", "m"}, {"up", "z"},
                {"facing", "+x"},          {"left", "+y"}};
  for (const geometry::Landmark& landmark : body.truth.landmarks)
    truth["landmarks"][landmark.name] = json_of(landmark.position);
  truth["heights"] = measures(body.truth.heights);
  truth["girths"] = measures(body.truth.girths);
  truth["vague"] = body.doubts.vague;
  truth["hidden"] = doubts_in_booth(body, scanner).hidden;
  truth["hidden_on_surface"] = body.doubts.hidden;
  truth["loose"] = Json::object();
  for (const auto& [name, direction] : body.doubts.loose) truth["loose"][name] = json_of(direction);
  truth["extra"] = {{"waist_method", body.waist_method}};
  truth["definitions"] = definitions();
  truth["mesh"] = {{"vertices", body.mesh.vertices.size()},
                   {"triangles", body.mesh.triangles.size()},
                   {"closed", true},
                   {"volume_m3", geometry::cone_volume(body.mesh.vertices, body.mesh.triangles)}};
  truth["parameters"] = Json::object();
  for (const auto& [name, value] : body.parameters) truth["parameters"][name] = value;
  if (!body.shape.empty()) truth["parameters"]["shape"] = body.shape;
  truth["scan_from_body"] = json_of(body.truth.body_from_scan.inverse());
  truth["scan"] = {{"columns", scanner.columns},   {"sensors_per_column", scanner.sensors_per_column},
                   {"points", scanner.points},     {"noise", scanner.noise},
                   {"outliers", scanner.outliers}, {"misregistration", scanner.misregistration},
                   {"floor", scanner.floor},       {"frame", scanner.frame},
                   {"seed", scanner.seed}};
  for (const DarkPatch& patch : scanner.dark)
    truth["scan"]["dark"].push_back(
        {{"centre", json_of(patch.centre)}, {"radii", json_of(patch.radii)}, {"share", patch.share}});
  if (scanner.fracture.shift.norm() > 0)
    truth["scan"]["fracture"] = {{"centre", json_of(scanner.fracture.centre)},
                                 {"radii", json_of(scanner.fracture.radii)},
                                 {"shift", json_of(scanner.fracture.shift)},
                                 {"from_column", scanner.fracture.from_column}};
  std::ofstream file(path);
  file << truth.dump(1) << '\n';
  file.flush();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace tensegric_fit::virtual_booth
