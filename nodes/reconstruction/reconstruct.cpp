#include "reconstruction/reconstruct.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <future>
#include <memory>
#include <optional>

#include "body_model/missing_parts.hpp"
#include "geometry/decimate.hpp"
#include "geometry/moved_cloud.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/status.hpp"
#include "reconstruction/body_points.hpp"
#include "reconstruction/floor.hpp"
#include "reconstruction/fractures.hpp"
#include "reconstruction/handles.hpp"
#include "reconstruction/left_out.hpp"
#include "reconstruction/mending.hpp"
#include "reconstruction/normals.hpp"
#include "reconstruction/plate.hpp"
#include "reconstruction/poisson.hpp"
#include "reconstruction/registration.hpp"
#include "reconstruction/repair.hpp"
#include "reconstruction/standing.hpp"
#include "reconstruction/support.hpp"
#include "reconstruction/surface_fit.hpp"
#include "reconstruction/surface_points.hpp"
#include "reconstruction/thinning.hpp"
#include "reconstruction/unseen_skin.hpp"
#include "reconstruction/validate.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using body_model::RegisteredBody;
using geometry::PointCloud;
using geometry::TriangleMesh;

constexpr double kDuplicate = 0.0005;          // m; closer points are one
constexpr double kCoarsest = 0.005;            // m
constexpr std::size_t kEnoughPoints = 400000;  // of a whole scan
constexpr double kLongestLoop = 0.3;           // m round; a bridge that is thicker is the body's own
constexpr double kSliver = 0.55;               // cells; shorter edges take triangles that the trunk needs
constexpr double kFineCell = 0.005;            // m; coarser cells leave it enough
constexpr double kLowestBust = 0.53, kHighestBust = 0.88;  // of the height: from the waist to the chin
// This share of the triangles halves edges round the bust, from the lower to the higher share of the height:
// nipples are smaller than the others' edges are long.
constexpr double kBeltShare = 0.15, kBeltLow = 0.66, kBeltHigh = 0.78;
constexpr double kOffTheFloor = 0.05;  // m; a body whose lowest point is higher stands on something else
constexpr double kSampleCube = 0.007;  // m: 30,000 samples of a person

PointCloud pick(const PointCloud& cloud, const std::vector<int>& indices) {
  PointCloud result;
  for (int i : indices) {
    result.points.push_back(cloud.points[i]);
    if (!cloud.normals.empty()) result.normals.push_back(cloud.normals[i]);
    if (!cloud.sensor.empty()) result.sensor.push_back(cloud.sensor[i]);
  }
  return result;
}

PointCloud above(const PointCloud& cloud, double height) {
  std::vector<int> indices;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (cloud.points[i].z() > height) indices.push_back(static_cast<int>(i));
  return pick(cloud, indices);
}

/// Without duplicates, and no denser than helps: denser scans do not take longer or more memory.
/// \throw Refusal too_few_points
PointCloud without_surplus(PointCloud scan, const Options& options) {
  scan = merged(scan, kDuplicate);
  if (scan.points.size() < static_cast<std::size_t>(options.min_points))
    throw geometry::Refusal(
        geometry::refusal::kTooFewPoints,
        fmt::format("without duplicates (closer than {:g} mm) the scan has {} points, {} are needed",
                    1000 * kDuplicate, scan.points.size(), options.min_points));
  double cube = kDuplicate;
  while (scan.points.size() > kEnoughPoints && 1.5 * cube < kCoarsest) {
    cube *= 1.5;
    scan = merged(scan, cube, true);  // sensors are brought together by what each of them saw
  }
  if (scan.points.size() > kEnoughPoints) scan = merged(scan, cube);
  return scan;
}

/// The indices from 0 to `count` - 1 that are not among those given.
std::vector<int> all_but(const std::vector<int>& indices, std::size_t count) {
  std::vector<char> given(count, 0);
  for (const int i : indices) given[i] = 1;
  std::vector<int> others;
  for (std::size_t i = 0; i < count; ++i)
    if (!given[i]) others.push_back(static_cast<int>(i));
  return others;
}

double lowest_of(const std::vector<Eigen::Vector3d>& points) {
  return geometry::bounding_box(points)[0].z();
}

/// Lowest and highest, m, of skin whose shape counts.
std::array<double, 2> fine_heights(const std::vector<Eigen::Vector3d>& standing, const Options& options) {
  const double height = geometry::bounding_box(standing)[1].z();
  if (!options.bust_only) return {0, height};
  return {kLowestBust * height, kHighestBust * height};
}

/// Of Poisson's smallest cells, m.
double cell_width(const std::vector<Eigen::Vector3d>& points, int depth) {
  constexpr double kRoom = 1.1;  // that PCL leaves around the points
  const auto box = geometry::bounding_box(points);
  return std::ldexp(kRoom * (box[1] - box[0]).maxCoeff(), -depth);
}

/// The body's points, upright, the ground under the soles at z = 0; `from_scan` takes the scan to them.
/// `floor_at`: m, where a floor was seen. `left_out`: points above the ground that are not taken for hers.
PointCloud standing_body(PointCloud scan, const Options& options, Eigen::Isometry3d& from_scan,
                         std::optional<double>& floor_at, PointCloud& left_out) {
  const std::optional<Floor> floor = find_floor(pick(scan, without_stray(scan.points)).points);
  const Eigen::Vector3d middle = geometry::bounding_box(scan.points)[0];
  from_scan = floor ? level(floor->normal, floor->offset, middle)
                    : level(Eigen::Vector3d::UnitZ(), middle.z(), middle);
  geometry::move(scan, from_scan);
  if (floor) {
    scan = above(scan, reach_of_floor(floor->noise));
  }
  const auto may_be_her = [&](const std::vector<Eigen::Vector3d>& thing) {
    return !fault_of_shape(thing, options);
  };
  const std::vector<int> hers = body_points(scan.points, may_be_her);
  PointCloud body = pick(scan, hers);
  left_out = pick(scan, all_but(hers, scan.points.size()));
  left_out.sensor.clear();  // nobody asks who saw what is left out
  const std::vector<int> on_surface = surface_points(body.points);
  if (on_surface.size() < body.points.size()) {
    body = pick(body, on_surface);
    const std::vector<int> still_hers = body_points(body.points, may_be_her);
    geometry::append(left_out, pick(body, all_but(still_hers, body.points.size())));
    body = pick(body, still_hers);
  }
  if (const auto fault = fault_of_shape(body.points, options)) throw geometry::Refusal(*fault);
  const double lowest = lowest_of(body.points);
  if (floor) floor_at = 0;
  if (!floor || lowest > kOffTheFloor) {
    const Eigen::Isometry3d down(Eigen::Translation3d(0, 0, -lowest));
    geometry::move(body, down);
    geometry::move(left_out, down);
    from_scan = down * from_scan;
    if (floor) floor_at = -lowest;
  }
  return body;
}

/// What a scan shows of a person.
struct Person {
  PointCloud cloud;                ///< with outward normals, upright, the ground under the soles at z = 0
  PointCloud left_out;             ///< points beside her, in the cloud's frame
  Eigen::Isometry3d from_scan;     ///< takes the scan to the cloud's frame
  std::optional<double> floor_at;  ///< m, where a floor was seen: 0 where her lowest points are on it
  /// Finds fractures, scan frame; in the cloud they are mended where it is known who saw what.
  std::function<std::vector<geometry::Fracture>()> fractures;
};

Person find_person(const PointCloud& scan, const Options& options) {
  check_options(options);
  // 1. The points that can be used, as many as help; 2. of these the body's, standing on z = 0, those of each
  // sensor where the others see them.
  Person person;
  PointCloud& body = person.cloud;
  body = standing_body(without_surplus(usable_points(scan, options), options), options, person.from_scan,
                       person.floor_at, person.left_out);
  const std::vector<int> sensor_of = std::move(body.sensor);
  body.sensor.clear();
  register_sensors(body.points, sensor_of);
  // 3. Normals, and fractures mended.
  const std::vector<Eigen::Vector3d> hints = std::move(body.normals);
  body.normals = outward_normals(body.points, hints);
  person.fractures = [torn = body, to_scan = Eigen::Isometry3d(person.from_scan.inverse())] {
    std::vector<geometry::Fracture> found = find_fractures(torn);
    for (geometry::Fracture& fracture : found) fracture.centre = to_scan * fracture.centre;
    return found;
  };
  if (mend_fractures(body.points, body.normals, sensor_of))
    body.normals = outward_normals(body.points, hints);
  return person;
}

/// The cloud as what a model is registered to.
body_model::Samples samples_of(const PointCloud& cloud) {
  const PointCloud means = merged(cloud, kSampleCube);
  body_model::Samples samples;
  for (std::size_t i = 0; i < means.points.size(); ++i) {
    if (means.normals[i].squaredNorm() < 0.5) continue;  // no normal is known
    samples.points.push_back(means.points[i]);
    samples.normals.push_back(means.normals[i]);
  }
  return body_model::shuffled_by_place(samples);
}

// Deviations of the model's soles: of 60 cut bodies the worst was off by 3.6 (Standing::without_feet).
constexpr double kCutOff = 4;
constexpr std::size_t kFewestOfLimb = 20;  // points; fewer show no limb
constexpr int kLimbRounds = 3;             // each finds the limb a little farther out

/// Takes in what was left out of her limbs; whether there was anything.
bool take_limbs(Person& person, const RegisteredBody& model) {
  const std::vector<int> limbs = points_of_limbs(person.left_out.points, model);
  if (limbs.size() < kFewestOfLimb) return false;
  const std::vector<Eigen::Vector3d> skin_normals =
      geometry::vertex_normals(model.skin, model.model->triangles);
  const geometry::PointTree skin(model.skin);
  for (const int i : limbs) {
    person.cloud.points.push_back(person.left_out.points[i]);
    person.cloud.normals.push_back(skin_normals[skin.nearest(person.left_out.points[i])]);
  }
  person.cloud.normals = outward_normals(person.cloud.points, person.cloud.normals, true);
  person.left_out = pick(person.left_out, all_but(limbs, person.left_out.points.size()));
  return true;
}

/// The model on her, with limbs whose points are sparse.
RegisteredBody registered(Person& person, const Anatomy& anatomy) {
  RegisteredBody model = anatomy.registered(samples_of(person.cloud));
  for (int round = 0; round < kLimbRounds && take_limbs(person, model); ++round)
    model = anatomy.registered(samples_of(person.cloud));
  for (body_model::Unexplained& thing :
       things_beside(person.left_out.points, model, person.cloud.points.size()))
    model.unexplained.push_back(std::move(thing));
  return model;
}

/// Where she stands on a plate on the floor, or on a turntable: the ground is its top, and its points are not
/// hers. Heels, or a foot that is lifted, leave the floor her ground.
void leave_plate(Person& person, RegisteredBody& model, const body_model::Standing& standing) {
  const std::optional<Plate> plate = find_plate(person.cloud, model, standing);
  if (!plate) return;
  model.ground = plate->top;
  person.cloud = above(person.cloud, plate->top + reach_of_floor(plate->noise));
  const Eigen::Isometry3d down(Eigen::Translation3d(0, 0, -model.ground));
  geometry::move(person.cloud, down);
  model = moved(model, down);
  person.from_scan = down * person.from_scan;
}

/// Up and the ground, now that it is known where her feet are.
void stand(Person& person, RegisteredBody& model, const body_model::Standing& standing) {
  const body_model::Ground soles = body_model::ground_by_soles(model, standing);
  // A level plane that feet which are not there would have to reach through is where she is cut off.
  if (person.floor_at && body_model::lacks_feet(model) &&
      soles.height < *person.floor_at - kCutOff * soles.deviation)
    person.floor_at.reset();
  if (person.floor_at == 0.0) return leave_plate(person, model, standing);
  if (person.floor_at && std::abs(soles.height - *person.floor_at) < kThinnestPlate) {
    model.ground = *person.floor_at;  // black shoes: her feet were not seen, the floor was
  } else {
    model.vertical = body_model::upright(model, standing);
    const body_model::Ground ground = body_model::ground_under(model, person.cloud.points, standing);
    model.ground = ground.height;
    model.ground_deviation = ground.deviation;
  }
  const Eigen::Isometry3d to_ground = level(model.vertical, model.ground, person.cloud.points.front());
  geometry::move(person.cloud, to_ground);
  model = moved(model, to_ground);
  person.from_scan = to_ground * person.from_scan;
}

BodyMesh surface_of(const Person& person, const Options& options, const RegisteredBody& model,
                    PoissonWorker& poisson) {
  PointCloud body = person.cloud;
  const std::size_t seen = body.points.size();
  // 1. Skin where no sensor sees but the shape is known.
  geometry::append(body, unseen_skin(model, body));
  // 2. One closed surface on the points and above the ground; beside it, what does not need that.
  BodyMesh result;
  auto beside = std::async(std::launch::async, [&] {
    result.fractures = person.fractures();
    return std::make_unique<const geometry::PointTree>(body.points);
  });
  TriangleMesh mesh = one_closed_surface(
      poisson.surface(thinned(body, fine_heights(body.points, options)), options.poisson_depth));
  mesh = without_handles(mesh, kLongestLoop);
  if (const double cell = cell_width(body.points, options.poisson_depth); cell < kFineCell)
    mesh = geometry::without_short_edges(mesh, kSliver * cell);
  // 3. As many triangles as asked for, on the points; what of the surface nobody saw.
  mesh = geometry::with_triangles(mesh, static_cast<int>((1 - kBeltShare) * options.body_triangles));
  const double height = geometry::bounding_box(mesh.vertices)[1].z();
  result.mesh =
      geometry::with_finer_belt(mesh, options.body_triangles, kBeltLow * height, kBeltHigh * height);
  const std::unique_ptr<const geometry::PointTree> tree = beside.get();
  fit_to_points(result.mesh, body, *tree);
  for (Eigen::Vector3d& v : result.mesh.vertices) v.z() = std::max(v.z(), 0.0);  // soles end on the ground
  result.points_used = seen;
  result.filled = filled_vertices(result.mesh, *tree, seen, options.support_distance);
  result.holes = holes_of(result.mesh, result.filled);
  // 4. Back to the scan's frame.
  const Eigen::Isometry3d to_scan = person.from_scan.inverse();
  for (Eigen::Vector3d& v : result.mesh.vertices) v = to_scan * v;
  for (Hole& hole : result.holes) hole.centre = to_scan * hole.centre;
  return result;
}

}  // namespace

Reconstruction reconstruct(const PointCloud& scan, const Options& options, const Anatomy& anatomy) {
  Person person = find_person(scan, options);
  PoissonWorker poisson;
  RegisteredBody model = registered(person, anatomy);
  stand(person, model, anatomy.standing);
  Reconstruction result{surface_of(person, options, model, poisson),
                        moved(model, person.from_scan.inverse())};
  mark_skin_without_surface(result.model, result.body.mesh);
  return result;
}

}  // namespace tensegric_fit::reconstruction
