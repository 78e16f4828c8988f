/// Where worn skin passes through skin: every shipped garment on bodies, a row a fit as CSV on standard
/// output, a table by request on standard error (README.md). Bodies whose skin lies inside them at rest,
/// where the garment moves it, count apart: they are no bodies there.
///   skin_contact BODY.ply... --control-triangles 480 --tissue launch/tissue/fine.yaml > contact.csv
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <queue>
#include <tuple>

#include "control_mesh/template.hpp"
#include "fit/chain.hpp"
#include "fit/tissue_file.hpp"
#include "geometry/crossing_triangles.hpp"
#include "geometry/ply.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"
#include "scan_files/scan_file.hpp"
#include "skin_inside.hpp"

namespace {

using namespace tensegric_fit;
using Pairs = std::vector<std::pair<int, int>>;

constexpr double kMoved = 1e-4;     // m: skin that moved less does not count
constexpr double kSunken = 0.5e-3;  // m: skin that lies deeper than this inside the body at rest is sunken
// m along the skin at rest: triangles farther apart than this are other skin that came near, no fold between
// neighbours.
constexpr double kOtherSkin = 0.03;

// A body's skin at rest.
struct Rest {
  const geometry::TriangleMesh& mesh;
  Pairs pairs;                 // that cross
  std::vector<double> depths;  // inside the body, m, one a vertex; mostly 0
  std::vector<std::vector<int>> neighbours;
};

std::vector<double> depths_of(const geometry::TriangleMesh& mesh, const Pairs& pairs) {
  std::vector<double> depths(mesh.vertices.size());
  for (const stability::SkinInside& patch : stability::skin_inside(mesh, pairs))
    for (std::size_t i = 0; i < patch.vertices.size(); ++i) depths[patch.vertices[i]] = patch.depths[i];
  return depths;
}

/// \pre `mesh` outlives it
Rest rest_of(const geometry::TriangleMesh& mesh) {
  Rest rest{mesh, {}, {}, {}};
  rest.pairs =
      geometry::crossing_pairs(mesh.vertices, mesh.triangles, std::vector<char>(mesh.vertices.size(), 1));
  rest.depths = depths_of(mesh, rest.pairs);
  rest.neighbours = geometry::neighbours_of(mesh.vertices.size(), mesh.triangles);
  return rest;
}

bool is_other_skin(const Rest& rest, int a, int b) {
  const Eigen::Vector3i &from = rest.mesh.triangles[a], &to = rest.mesh.triangles[b];
  std::map<int, double> ways;
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> queue;
  for (const int v : from) queue.emplace(0, v);
  while (!queue.empty()) {
    const auto [way, v] = queue.top();
    queue.pop();
    if (!ways.emplace(v, way).second) continue;
    if (v == to[0] || v == to[1] || v == to[2]) return false;
    for (const int next : rest.neighbours[v]) {
      const double on = way + (rest.mesh.vertices[next] - rest.mesh.vertices[v]).norm();
      if (on <= kOtherSkin) queue.emplace(on, next);
    }
  }
  return true;
}

struct Contact {
  int pairs = 0, other_skin = 0;  // that cross worn and did not at rest; of them not neighbours
  int pairs_at_rest = 0;          // that cross, of skin that moves
  double depth_at_rest = 0;       // m, of skin that moves
  double deepest = 0;             // m, deeper inside than at rest
  double area = 0;                // m^2 at rest, of triangles with a corner that is deeper inside by 0.1 mm
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
};

Contact contact_of(const Rest& rest, const std::vector<Eigen::Vector3d>& worn) {
  const geometry::TriangleMesh skin{worn, rest.mesh.triangles};
  std::vector<char> moved(worn.size());
  for (std::size_t v = 0; v < moved.size(); ++v) moved[v] = (worn[v] - rest.mesh.vertices[v]).norm() > kMoved;
  const auto moves = [&](int triangle) {
    const Eigen::Vector3i& t = rest.mesh.triangles[triangle];
    return moved[t[0]] || moved[t[1]] || moved[t[2]];
  };
  const Pairs pairs = geometry::crossing_pairs(worn, rest.mesh.triangles, moved);
  Contact contact;
  for (std::size_t v = 0; v < moved.size(); ++v)
    if (moved[v]) contact.depth_at_rest = std::max(contact.depth_at_rest, rest.depths[v]);
  for (const auto& [a, b] : rest.pairs) contact.pairs_at_rest += moves(a) || moves(b);
  for (const auto& pair : pairs)
    if (!std::binary_search(rest.pairs.begin(), rest.pairs.end(), pair)) {
      ++contact.pairs;
      contact.other_skin += is_other_skin(rest, pair.first, pair.second);
    }
  if (pairs.empty()) return contact;
  Pairs all = pairs;  // with those of skin that stays
  std::copy_if(rest.pairs.begin(), rest.pairs.end(), std::back_inserter(all),
               [&](const auto& pair) { return !moves(pair.first) && !moves(pair.second); });
  const std::vector<double> depths = depths_of(skin, all);
  const auto deeper = [&](int v) { return depths[v] - rest.depths[v]; };
  for (std::size_t v = 0; v < depths.size(); ++v)
    if (deeper(v) > contact.deepest) {
      contact.deepest = deeper(v);
      contact.place = worn[v];
    }
  for (const Eigen::Vector3i& t : rest.mesh.triangles)
    if (deeper(t[0]) > kMoved || deeper(t[1]) > kMoved || deeper(t[2]) > kMoved)
      contact.area +=
          geometry::area_vector(rest.mesh.vertices[t[0]], rest.mesh.vertices[t[1]], rest.mesh.vertices[t[2]])
              .norm() /
          2;
  return contact;
}

struct Row {
  int fits = 0, crossing = 0, other_skin = 0, half = 0, two = 0;
  double deepest = 0;
};

class Bodies {
 public:
  explicit Bodies(fit::Settings settings) : settings_(std::move(settings)) {}

  void wear_all(const std::string& path, bool scans, const std::vector<std::string>& garments,
                const std::vector<double>& ratios) {
    const std::string name = std::filesystem::path(path).stem().string();
    fit::StageTimes times;
    std::optional<fit::Body> body;
    std::optional<Rest> rest;
    try {
      body = scans ? fit::measure_scan(geometry::points_of(scan_files::read_scan_file(path).cloud), settings_,
                                       times)
                   : fit::measure_mesh(geometry::read_ply_mesh(path), settings_, times);
      rest.emplace(rest_of(body->mesh.mesh));
    } catch (const geometry::Refusal& refusal) {
      fmt::print(stderr, "{} refused: {}: {}\n", path, refusal.code(), refusal.what());
      for (const std::string& word : garments) refuse(name, word, ratios, refusal);
      return;
    }
    fmt::print(stderr, "{}: {} pairs cross at rest, {:.2f} mm\n", name, rest->pairs.size(),
               rest->depths.empty() ? 0 : 1e3 * *std::max_element(rest->depths.begin(), rest->depths.end()));
    std::map<std::string, fit::Fitting> fittings;  // by region
    for (const std::string& word : garments) {
      tensegric::Garment garment = tensegric::take_garment(word, geometry::shipped_folder("garments"));
      const std::string region = garment.regions.front();
      try {
        if (fittings.count(region) == 0) {
          const control_mesh::Template pattern = control_mesh::load_template(geometry::yaml_file(
              geometry::shipped_folder("templates"), region, geometry::refusal::kBadGarment));
          fittings.emplace(
              region, fit::prepare(*body, std::vector<control_mesh::Template>{pattern}, settings_, times));
        }
      } catch (const geometry::Refusal& refusal) {
        refuse(name, word, ratios, refusal);
        continue;
      }
      for (const double ratio : ratios) {
        try {
          tensegric::set_ratio(garment, "", ratio);
          const fit::Fit fit = fit::wear(*body, fittings.at(region), garment, settings_, times);
          add(name, word, ratio, contact_of(*rest, fit.deformed), to_string(fit.solution.status));
        } catch (const geometry::Refusal& refusal) {
          refuse(name, word, {ratio}, refusal);
        }
      }
    }
  }

  std::string table() const {
    std::string text =
        "| garments | sunken at rest | request | fits | newly crossing | of them other skin | over 0.5 mm | "
        "over 2 mm "
        "| deepest, mm |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const auto& [key, row] : rows_) {
      const auto& [letter, sunken, request] = key;
      text += fmt::format("| {} | {} | {:.2f} | {} | {} | {} | {} | {} | {:.2f} |\n", letter,
                          sunken ? "yes" : "no", -request, row.fits, row.crossing, row.other_skin, row.half,
                          row.two, 1e3 * row.deepest);
    }
    return text + fmt::format("refused: {} fits\n", refused_);
  }

 private:
  void refuse(const std::string& body, const std::string& garment, const std::vector<double>& ratios,
              const geometry::Refusal& refusal) {
    for (const double ratio : ratios) {
      fmt::print("{},{},{:.2f},refused: {},,,,,,,,,\n", body, garment, ratio, refusal.code());
      ++refused_;
    }
  }

  void add(const std::string& body, const std::string& garment, double ratio, const Contact& contact,
           const std::string& status) {
    fmt::print("{},{},{:.2f},{},{},{:.3f},{},{},{:.3f},{:.2f},{:.3f},{:.3f},{:.3f}\n", body, garment, ratio,
               status, contact.pairs_at_rest, 1e3 * contact.depth_at_rest, contact.pairs, contact.other_skin,
               1e3 * contact.deepest, 1e4 * contact.area, contact.place.x(), contact.place.y(),
               contact.place.z());
    std::fflush(stdout);
    Row& row = rows_[{garment.front(), contact.depth_at_rest > kSunken, -ratio}];
    ++row.fits;
    row.crossing += contact.pairs > 0;
    row.other_skin += contact.other_skin > 0;
    row.half += contact.deepest > 0.5e-3;
    row.two += contact.deepest > 2e-3;
    row.deepest = std::max(row.deepest, contact.deepest);
  }

  fit::Settings settings_;
  std::map<std::tuple<char, bool, double>, Row> rows_;  // by garments' letter, whether sunken, -ratio
  int refused_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Where worn skin passes through skin");
  std::vector<std::string> meshes, garments = {"B1", "B2", "B3", "B4", "H1", "H2", "H3", "H4"};
  std::vector<double> ratios = {0.95, 0.90, 0.88};
  std::string tissue;
  bool scans = false;
  fit::Settings settings;
  app.add_flag("--scans", scans, "the files are scans");
  app.add_option("meshes", meshes, "BODY.ply...")->required();
  app.add_option("--garments", garments, "shipped ones")->delimiter(',');
  app.add_option("--ratios", ratios, "of all lines")->delimiter(',');
  app.add_option("--tissue", tissue, "parameter file");
  app.add_option("--control-triangles", settings.control_mesh.control_triangles, "at least");
  CLI11_PARSE(app, argc, argv);
  try {
    if (!tissue.empty()) fit::take_tissue(tissue, settings);
    fmt::print("body,garment,ratio,status,rest_pairs,rest_mm,pairs,other_skin,deepest_mm,area_cm2,x,y,z\n");
    Bodies bodies(settings);
    for (const std::string& mesh : meshes) bodies.wear_all(mesh, scans, garments, ratios);
    fmt::print(stderr, "{}", bodies.table());
  } catch (const geometry::Refusal& refusal) {
    fmt::print(stderr, "refused: {}: {}\n", refusal.code(), refusal.what());
    return 3;
  }
}
