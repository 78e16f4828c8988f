#include "booth/truth_file.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace tensegric_fit::booth {
namespace {

using Json = nlohmann::ordered_json;

Json measures(const std::vector<geometry::Measure>& list) {
  Json result = Json::object();
  for (const geometry::Measure& measure : list) result[measure.name] = measure.metres;
  return result;
}

Json triple(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

Json matrix(const Eigen::Isometry3d& transform) {
  Json rows = Json::array();
  for (int r = 0; r < 4; ++r) {
    Json row = Json::array();
    for (int c = 0; c < 4; ++c) row.push_back(transform.matrix()(r, c));
    rows.push_back(row);
  }
  return rows;
}

Json definitions() {
  return {
      {"frame",
       "metres; body frame: x forward, y to her left, z up, origin on the floor between the feet; landmarks "
       "in the scan's frame, heights along body z"},
      {"bust_point", "tip of the nipple"},
      {"underbust",
       "most concave point of the sagittal profile under the bust point; height: lowest such point "
       "from there to 55 mm towards the middle, over both sides"},
      {"waist",
       "interior minimum of the hull girth between hip + 100 mm and underbust - 15 mm, 5 mm or more "
       "below both ends; without one the navel's level, as waist_ruler"},
      {"hip", "mean height of the rearmost points of the buttocks"},
      {"girths",
       "hull perimeter of the horizontal section without the arms; bust: all loops at the mean height of "
       "the bust points; underbust: the trunk's loop 3 mm below its height; neck: in the plane across "
       "the neck"},
      {"crotch", "perineum, on the level bridge between the legs"},
      {"axilla", "where trunk and arm part"},
      {"shoulder", "over the outer end of the collarbone"}};
}

}  // namespace

void write_truth(const std::string& path, const VirtualBody& body, const BodyParameters& parameters,
                 const ScannerOptions& scanner) {
  Json truth = {{"name", "virtual_booth"}, {"units", "m"}, {"up", "z"}, {"facing", "+x"}, {"left", "+y"}};
  for (const geometry::Landmark& landmark : body.truth.landmarks)
    truth["landmarks"][landmark.name] = triple(landmark.position);
  truth["heights"] = measures(body.truth.heights);
  truth["girths"] = measures(body.truth.girths);
  truth["extra"] = {{"waist_method", body.waist_method}};
  truth["definitions"] = definitions();
  truth["mesh"] = {{"vertices", body.mesh.vertices.size()},
                   {"triangles", body.mesh.triangles.size()},
                   {"closed", true},
                   {"volume_m3", geometry::cone_volume(body.mesh.vertices, body.mesh.triangles)}};
  truth["parameters"] = {
      {"stature", parameters.stature},     {"build", parameters.build}, {"bust", parameters.bust},
      {"firmness", parameters.firmness},   {"waist", parameters.waist}, {"asymmetry", parameters.asymmetry},
      {"belly", parameters.belly},         {"hip", parameters.hip},     {"stoop", parameters.stoop},
      {"arm_angle", parameters.arm_angle}, {"yaw", parameters.yaw},     {"tilt", parameters.tilt}};
  truth["scan_from_body"] = matrix(body.truth.body_from_scan.inverse());
  truth["scan"] = {{"columns", scanner.columns},   {"sensors_per_column", scanner.sensors_per_column},
                   {"points", scanner.points},     {"noise", scanner.noise},
                   {"outliers", scanner.outliers}, {"misregistration", scanner.misregistration},
                   {"floor", scanner.floor},       {"frame", scanner.frame},
                   {"seed", scanner.seed}};
  for (const DarkPatch& patch : scanner.dark)
    truth["scan"]["dark"].push_back(
        {{"centre", triple(patch.centre)}, {"radii", triple(patch.radii)}, {"share", patch.share}});
  if (scanner.fracture.shift.norm() > 0)
    truth["scan"]["fracture"] = {{"centre", triple(scanner.fracture.centre)},
                                 {"radii", triple(scanner.fracture.radii)},
                                 {"shift", triple(scanner.fracture.shift)},
                                 {"from_column", scanner.fracture.from_column}};
  std::ofstream file(path);
  file << truth.dump(1) << '\n';
  file.flush();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace tensegric_fit::booth
