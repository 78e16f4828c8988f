#include "virtual_booth/virtual_scanner.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/range.hpp"
#include "geometry/status.hpp"
#include "virtual_body/random.hpp"
#include "virtual_booth/depth_image.hpp"

namespace tensegric_fit::virtual_booth {
namespace {

using Eigen::Vector3d;

void check_options(const ScannerOptions& options) {
  geometry::check_option("columns", options.columns, {2, 12});
  geometry::check_option("sensors_per_column", options.sensors_per_column, {1, 6});
  geometry::check_option("distance", options.distance, {1.0, 4.0});
  geometry::check_option("points", options.points, {1000, 2000000});
  geometry::check_option("noise", options.noise, {0, 0.01});
  geometry::check_option("outliers", options.outliers, {0, 0.2});
  geometry::check_option("misregistration", options.misregistration, {0, 0.01});
  geometry::check_option("grazing", options.grazing, {0, 0.9});
  geometry::check_option("floor_radius", options.floor_radius, {0.1, 3.0});
  for (const DarkPatch& patch : options.dark) {
    geometry::check_option("dark.share", patch.share, {0, 1});
    geometry::check_option("dark.radii", patch.radii.minCoeff(), {1e-6, 10});
  }
  geometry::check_option("fracture.radii", options.fracture.radii.minCoeff(), {1e-6, 10});
  geometry::check_option("fracture.shift", options.fracture.shift.norm(), {0, 0.05});
}

// Each sensor sees its share of the height, and half as much again for overlap.
std::vector<Sensor> sensors(const ScannerOptions& options, const geometry::TriangleMesh& body,
                            double height) {
  double half_width = 0.75;  // metres to either side of the axis: room for arms held out
  for (const Vector3d& p : body.vertices) half_width = std::max(half_width, p.head<2>().norm() + 0.02);
  std::vector<Sensor> result;
  const double share = height / options.sensors_per_column;
  for (int column = 0; column < options.columns; ++column) {
    const double angle = M_PI / 4 + 2 * M_PI * column / options.columns;
    const Vector3d outward(std::cos(angle), std::sin(angle), 0);
    for (int i = 0; i < options.sensors_per_column; ++i) {
      Sensor sensor;
      sensor.position = options.distance * outward + Vector3d(0, 0, (i + 0.5) * share);
      sensor.axes << Vector3d::UnitZ().cross(outward).transpose(), Vector3d::UnitZ().transpose(),
          -outward.transpose();
      sensor.half_width = half_width / options.distance;
      sensor.half_height = 0.75 * share / options.distance;
      result.push_back(sensor);
    }
  }
  return result;
}

// Four beams in a square over her head.
geometry::TriangleMesh booth_frame() {
  constexpr double kHeight = 2.0, kReach = 0.86, kThickness = 0.03;
  geometry::TriangleMesh frame;
  for (const auto& [radius, z] : {std::pair{kReach, kHeight},
                                  {kReach, kHeight - kThickness},
                                  {kReach - kThickness, kHeight - kThickness},
                                  {kReach - kThickness, kHeight}})
    for (const auto& [x, y] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}})
      frame.vertices.emplace_back(radius * x, radius * y, z);
  for (int face = 0; face < 4; ++face) {
    for (int side = 0; side < 4; ++side) {
      const int a = 4 * face + side, b = 4 * face + (side + 1) % 4, c = (a + 4) % 16, d = (b + 4) % 16;
      frame.triangles.emplace_back(a, b, d);
      frame.triangles.emplace_back(a, d, c);
    }
  }
  return frame;
}

int pixels(double half, double pixels_per_unit) {
  return std::max(8, static_cast<int>(2 * half * pixels_per_unit));
}

std::vector<Hit> look(const Sensor& sensor, const geometry::TriangleMesh& body, const ScannerOptions& options,
                      double pixels_per_unit) {
  DepthImage image(sensor, pixels(sensor.half_height, pixels_per_unit),
                   pixels(sensor.half_width, pixels_per_unit));
  image.draw(body);
  if (options.frame) image.draw(booth_frame());
  if (options.floor) image.draw_floor(options.floor_radius);
  return image.hits();
}

// Share of rays that return from a surface met at this cosine of incidence.
double return_share(double incidence, double grazing) {
  return grazing == 0 ? 1 : std::clamp(incidence / grazing - 1, 0.0, 1.0);
}

// Share of them that hair and cloth let return.
double bright_share(const Vector3d& p, const std::vector<DarkPatch>& patches) {
  double share = 1;
  for (const DarkPatch& patch : patches)
    if ((p - patch.centre).cwiseQuotient(patch.radii).norm() < 1) share *= 1 - patch.share;
  return share;
}

// Where a column sees a point of the skin.
Vector3d fractured(const Vector3d& p, const Fracture& fracture, int column) {
  if (column < fracture.from_column) return p;
  const double inside = 1 - (p - fracture.centre).cwiseQuotient(fracture.radii).squaredNorm();
  return inside > 0 ? Vector3d(p + inside * inside * fracture.shift) : p;
}

// Resolution at which somewhat more rays return than points are wanted.
double resolution(const std::vector<Sensor>& all, const geometry::TriangleMesh& body,
                  const ScannerOptions& options) {
  constexpr double kTrial = 100, kMargin = 1.03;
  double returns = 0;
  for (const Sensor& sensor : all)
    for (const Hit& hit : look(sensor, body, options, kTrial))
      returns += return_share(hit.incidence, options.grazing) * bright_share(hit.point, options.dark);
  if (returns == 0) throw geometry::Refusal(geometry::refusal::kNotABody, "the sensors see no surface");
  return kTrial * std::sqrt(kMargin * options.points / returns);
}

// How far off a column is believed to stand.
Eigen::Isometry3d column_error(virtual_body::Random& random, double deviation) {
  constexpr double kLever = 1.0;  // metres: a turn moves points that far away as much as the shift does
  const auto triple = [&random]() {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return Vector3d(x, y, z);
  };
  const Vector3d shift = deviation * triple(), turn = deviation / kLever / std::sqrt(3.0) * triple();
  const Vector3d middle(0, 0, kLever);
  const double angle = turn.norm();
  const Eigen::AngleAxisd rotation(angle, angle > 0 ? Vector3d(turn / angle) : Vector3d::UnitX());
  return Eigen::Translation3d(middle + shift) * rotation * Eigen::Translation3d(-middle);
}

// Sensors have their y up, optical frames have it down.
Eigen::Isometry3d optical_frame(const Sensor& sensor) {
  Eigen::Isometry3d booth_from_sensor = Eigen::Isometry3d::Identity();
  booth_from_sensor.linear() = sensor.axes.transpose() * Vector3d(1, -1, 1).asDiagonal();
  booth_from_sensor.translation() = sensor.position;
  return booth_from_sensor;
}

// How far along its ray a point is seen from where it is.
double off_along_ray(virtual_body::Random& random, const ScannerOptions& options) {
  constexpr double kFarthestOutlier = 0.050;
  return random.uniform() < options.outliers ? kFarthestOutlier * (2 * random.uniform() - 1)
                                             : options.noise * random.normal();
}

double height_of(const geometry::TriangleMesh& body) {
  const double height = body.vertices.empty() ? 0 : geometry::bounding_box(body.vertices)[1].z();
  geometry::check_option("height of the body over z = 0", height, {0.1, 3.0});
  return height;
}

// In the booth's own frame.
VirtualScan scan_upright(const geometry::TriangleMesh& body, const ScannerOptions& options) {
  const std::vector<Sensor> all = sensors(options, body, height_of(body));
  const double pixels_per_unit = resolution(all, body, options);

  virtual_body::Random random(options.seed);
  VirtualScan scan;
  std::vector<std::pair<Vector3d, int>> points;
  Eigen::Isometry3d error = Eigen::Isometry3d::Identity();
  for (std::size_t s = 0; s < all.size(); ++s) {
    const int column = static_cast<int>(s) / options.sensors_per_column;
    if (s % options.sensors_per_column == 0) error = column_error(random, options.misregistration);
    scan.sensors.push_back({column, error * optical_frame(all[s]), error});
    for (const Hit& hit : look(all[s], body, options, pixels_per_unit)) {
      if (random.uniform() >=
          return_share(hit.incidence, options.grazing) * bright_share(hit.point, options.dark))
        continue;
      const Vector3d ray = (hit.point - all[s].position).normalized();
      const double off = off_along_ray(random, options);
      const Vector3d skin = fractured(hit.point, options.fracture, column);
      points.emplace_back(error * Vector3d(skin + off * ray), static_cast<int>(s));
    }
  }
  random.shuffle(points);
  points.resize(std::min(points.size(), static_cast<std::size_t>(options.points)));

  for (const auto& [point, sensor] : points) {
    scan.cloud.points.push_back(point);
    scan.sensor.push_back(sensor);
  }
  return scan;
}

}  // namespace

VirtualScan scan_body(const geometry::TriangleMesh& body, const ScannerOptions& options) {
  check_options(options);
  geometry::check_mesh(body);
  const Eigen::Isometry3d& booth = options.booth_from_scan;
  if (booth.matrix().isIdentity(0)) return scan_upright(body, options);

  geometry::TriangleMesh upright = body;
  for (Vector3d& p : upright.vertices) p = booth * p;
  ScannerOptions there = options;
  for (DarkPatch& patch : there.dark) patch.centre = booth * patch.centre;
  there.fracture.centre = booth * there.fracture.centre;
  there.fracture.shift = booth.linear() * there.fracture.shift;
  VirtualScan scan = scan_upright(upright, there);
  const Eigen::Isometry3d back = booth.inverse();
  for (Vector3d& p : scan.cloud.points) p = back * p;
  for (SensorPose& sensor : scan.sensors) {
    sensor.booth_from_sensor = back * sensor.booth_from_sensor;
    sensor.error = back * sensor.error * booth;
  }
  return scan;
}

std::vector<Vector3d> seen_places(const geometry::TriangleMesh& body, const ScannerOptions& options,
                                  double spacing) {
  check_options(options);
  geometry::check_option("spacing", spacing, {0.0005, 0.1});
  geometry::check_mesh(body);
  geometry::TriangleMesh upright = body;
  for (Vector3d& p : upright.vertices) p = options.booth_from_scan * p;
  ScannerOptions empty = options;  // the booth's floor and frame lie behind her
  empty.floor = empty.frame = false;
  std::vector<Vector3d> places;
  for (const Sensor& sensor : sensors(options, upright, height_of(upright)))
    for (const Hit& hit : look(sensor, upright, empty, options.distance / spacing))
      if (return_share(hit.incidence, options.grazing) > 0)
        places.push_back(options.booth_from_scan.inverse() * hit.point);
  return places;
}

std::vector<DepthPicture> depth_pictures(const geometry::TriangleMesh& body, const ScannerOptions& options,
                                         const Lens& lens) {
  check_options(options);
  geometry::check_mesh(body);
  std::vector<Sensor> all = sensors(options, body, height_of(body));
  for (Sensor& sensor : all) sensor.lens = lens;
  const double pixels_per_unit = resolution(all, body, options);
  virtual_body::Random random(options.seed);
  std::vector<DepthPicture> pictures;
  Eigen::Isometry3d error = Eigen::Isometry3d::Identity();
  for (std::size_t s = 0; s < all.size(); ++s) {
    const Sensor& sensor = all[s];
    if (s % options.sensors_per_column == 0) error = column_error(random, options.misregistration);
    DepthPicture picture;
    picture.rows = pixels(sensor.half_height, pixels_per_unit);
    picture.columns = pixels(sensor.half_width, pixels_per_unit);
    picture.fx = picture.columns / (2 * sensor.half_width);
    picture.fy = picture.rows / (2 * sensor.half_height);
    picture.cx = (picture.columns - 1) / 2.0;
    picture.cy = (picture.rows - 1) / 2.0;
    picture.lens = lens;
    picture.pose = {static_cast<int>(s) / options.sensors_per_column, error * optical_frame(sensor), error};
    picture.depth.assign(static_cast<std::size_t>(picture.rows) * picture.columns,
                         std::numeric_limits<float>::quiet_NaN());
    for (const Hit& hit : look(sensor, body, options, pixels_per_unit)) {
      if (random.uniform() >=
          return_share(hit.incidence, options.grazing) * bright_share(hit.point, options.dark))
        continue;
      const Vector3d way = hit.point - sensor.position;
      const Vector3d seen = way + off_along_ray(random, options) * way.normalized();
      picture.depth[static_cast<std::size_t>(hit.row) * picture.columns + hit.column] =
          static_cast<float>(sensor.axes.row(2).dot(seen));
    }
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

std::vector<SensorScan> by_sensor(const VirtualScan& scan) {
  std::vector<SensorScan> scans;
  for (const SensorPose& pose : scan.sensors) scans.push_back({{}, pose});
  for (std::size_t i = 0; i < scan.sensor.size(); ++i)
    scans[scan.sensor[i]].cloud.points.push_back(scan.cloud.points[i]);
  return scans;
}

}  // namespace tensegric_fit::virtual_booth
