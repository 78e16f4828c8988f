#include "compare_skin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "geometry/surface_tree.hpp"
#include "inspect/composition.hpp"
#include "inspect/picture.hpp"
#include "recording.hpp"
#include "ros/body_messages.hpp"
#include "ros/flat.hpp"
#include "surface_distance.hpp"

namespace tensegric_fit::regression {
namespace {

using Eigen::Vector3d;

constexpr int kPanel = 440;                                                                       // pixels
constexpr double kScales[] = {0.0001, 0.0002, 0.0005, 0.001, 0.002, 0.005, 0.010, 0.020, 0.050};  // m
constexpr double kSame = 1e-9;  // m; a vertex of float32 to its own triangle

std::vector<double> distances(const geometry::TriangleMesh& one, const geometry::TriangleMesh& other) {
  const geometry::SurfaceTree tree(other);
  const std::vector<Vector3d> normals = geometry::vertex_normals(one.vertices, one.triangles);
  std::vector<double> all;
  for (std::size_t v = 0; v < one.vertices.size(); ++v) {
    const Vector3d off = tree.nearest(one.vertices[v]).position - one.vertices[v];
    all.push_back(std::copysign(off.norm(), off.dot(normals[v])));
  }
  return all;
}

std::string part_of(std::size_t vertex, const BodyModel::ConstPtr& model) {
  if (!model || vertex >= model->mesh_parts.size()) return "skin";
  const std::size_t part = model->mesh_parts[vertex];
  return part < model->parts.size() ? model->parts[part] : "other";
}

std::vector<PartDifference> by_parts(const geometry::TriangleMesh& skin, const std::vector<double>& distance,
                                     const BodyModel::ConstPtr& model,
                                     const Eigen::Isometry3d& body_from_scan) {
  std::map<std::string, std::vector<std::size_t>> vertices;
  for (std::size_t v = 0; v < distance.size(); ++v) vertices[part_of(v, model)].push_back(v);
  std::vector<PartDifference> parts;
  for (const auto& [name, own] : vertices) {
    std::vector<double> sizes;
    std::size_t most = own.front();
    for (const std::size_t v : own) {
      sizes.push_back(std::abs(distance[v]));
      if (std::abs(distance[v]) > std::abs(distance[most])) most = v;
    }
    if (std::abs(distance[most]) <= kSame) continue;
    const Vector3d place = body_from_scan * skin.vertices[most];
    parts.push_back({name, gauge::quantile(sizes, 0.5), gauge::quantile(sizes, 0.95), distance[most],
                     place.x(), place.y(), place.z()});
  }
  std::stable_sort(parts.begin(), parts.end(), [](const PartDifference& a, const PartDifference& b) {
    return std::abs(a.most) > std::abs(b.most);
  });
  return parts;
}

CasePicture skin_picture(const std::string& caption, const cv::Mat& image) {
  std::vector<uchar> bytes;
  cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9});
  return {caption, std::string(bytes.begin(), bytes.end())};
}

// The whole body from both sides, and the part that differs most.
void draw(const geometry::TriangleMesh& skin, const std::vector<double>& distance,
          const BodyModel::ConstPtr& model, const Eigen::Isometry3d& body_from_scan,
          SkinDifference& difference) {
  const double most = std::abs(difference.parts.front().most);
  const auto* scale =
      std::find_if(std::begin(kScales), std::end(kScales), [&](double s) { return s >= most; });
  difference.scale = scale == std::end(kScales) ? *std::rbegin(kScales) : *scale;
  std::vector<inspect::Colour> colours;
  std::vector<Vector3d> part;
  double forward = 0;
  const std::vector<Vector3d> normals = geometry::vertex_normals(skin.vertices, skin.triangles);
  for (std::size_t v = 0; v < distance.size(); ++v) {
    colours.push_back(inspect::two_sided_colour(std::clamp(distance[v] / difference.scale, -1.0, 1.0)));
    if (part_of(v, model) != difference.parts.front().part) continue;
    part.push_back(skin.vertices[v]);
    forward += std::abs(distance[v]) * (body_from_scan.linear() * normals[v]).x();
  }
  const auto from = [&](inspect::MakeView make, const std::vector<Vector3d>& shown, double margin) {
    return inspect::draw(skin, colours, {}, inspect::framed(make, body_from_scan, shown, margin), kPanel,
                         kPanel);
  };
  difference.pictures.push_back(
      skin_picture(fmt::format("full colour at {:g} mm: blue where the second lies outside, red where inside",
                               1e3 * difference.scale),
                   inspect::side_by_side(from(inspect::front_view, skin.vertices, 1.05),
                                         from(inspect::back_view, skin.vertices, 1.05))));
  difference.pictures.push_back(
      skin_picture(difference.parts.front().part,
                   from(forward >= 0 ? inspect::oblique_view : inspect::oblique_back_view, part, 2.5)));
}

class Skins {
 public:
  explicit Skins(const RecordedScan& scan) : recording_(recording_in(scan.bag, scan.scan_id)) {
    if (recording_.body) rest_ = node::mesh_in(*recording_.body);
  }

  bool there() const { return recording_.body != nullptr; }
  std::size_t garments() const { return recording_.deformed.size(); }
  std::string garment(std::size_t i) const { return recording_.deformed[i]->garment; }
  const BodyModel::ConstPtr& model() const { return recording_.model; }
  Eigen::Isometry3d frame() const {
    return recording_.landmarks ? node::measures_in(*recording_.landmarks).body_from_scan
                                : Eigen::Isometry3d::Identity();
  }
  const geometry::TriangleMesh& rest() const { return rest_; }
  geometry::TriangleMesh under(std::size_t i) const {
    geometry::TriangleMesh skin = rest_;
    skin.vertices = node::points_in(recording_.deformed[i]->vertices);
    return skin;
  }

 private:
  Recording recording_;
  geometry::TriangleMesh rest_;
};

SkinDifference compare(const std::string& what, const geometry::TriangleMesh& one,
                       const geometry::TriangleMesh& other, const Skins& context) {
  SkinDifference difference;
  difference.what = what;
  const std::vector<double> distance = distances(one, other);
  difference.parts = by_parts(one, distance, context.model(), context.frame());
  if (!difference.parts.empty()) draw(one, distance, context.model(), context.frame(), difference);
  return difference;
}

}  // namespace

void compare_skins(const RecordedScan& one, const RecordedScan& other, RunComparison& result) {
  const Skins a(one), b(other);
  if (!a.there() || !b.there()) {
    if (a.there() != b.there()) result.notes.push_back("one of the runs has no body that this build reads");
    return;
  }
  result.skins.push_back(compare("body at rest", a.rest(), b.rest(), a));
  for (std::size_t i = 0; i < std::min(a.garments(), b.garments()); ++i)
    result.skins.push_back(compare("under " + a.garment(i), a.under(i), b.under(i), a));
}

}  // namespace tensegric_fit::regression
