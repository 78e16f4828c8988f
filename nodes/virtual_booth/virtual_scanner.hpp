/// Depth sensors on columns round a body: what a scan booth would see of it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "geometry/point_cloud.hpp"
#include "geometry/triangle_mesh.hpp"
#include "virtual_booth/depth_image.hpp"

namespace tensegric_fit::virtual_booth {

/// Hair and black cloth: in an ellipsoid this share of the points does not return.
struct DarkPatch {
  Eigen::Vector3d centre, radii;
  double share;  ///< 0 to 1
};

/// She moved while the columns looked one after the other: those from `from_column` on see the skin in an
/// ellipsoid shifted, most in its middle.
struct Fracture {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), radii = Eigen::Vector3d::Ones(),
                  shift = Eigen::Vector3d::Zero();  ///< at most 0.05 long
  int from_column = 0;
};

/// Field defaults are the parameters' defaults. Metres, radians.
struct ScannerOptions {
  int columns = 4;  ///< 2 to 12, evenly round the z axis, the first at 45 degrees from x
  int sensors_per_column =
      3;                   ///< 1 to 6, evenly spread over the body's height, each looking level at the z axis
  double distance = 1.40;  ///< 1.0 to 4.0, of the columns from the z axis
  int points = 180000;     ///< 1000 to 2000000, of body, floor and frame together
  double noise = 0.0008;   ///< 0 to 0.01, standard deviation along the ray
  double outliers = 0.001;  ///< 0 to 0.2, share of points that lie up to 50 mm off along their ray
  double misregistration =
      0.0005;             ///< 0 to 0.01, deviation of each column's shift; its turn fits it 1 m away
  double grazing = 0.15;  ///< 0 to 0.9, cosine of incidence below which no point returns; twice that, all do
  bool floor = false;     ///< whether the floor z = 0 is seen, as a disc
  double floor_radius = 0.60;  ///< 0.1 to 3.0
  bool frame = false;          ///< whether the booth's square frame is seen, 2 m up, 0.86 m to each side
  std::vector<DarkPatch> dark;
  Fracture fracture;
  /// Columns, floor and frame stand upright in the booth's frame; z axis and floor are meant there. A scan
  /// given out in another frame leans with its floor.
  Eigen::Isometry3d booth_from_scan = Eigen::Isometry3d::Identity();
  std::uint64_t seed = 1;
};

/// One sensor of the booth.
struct SensorPose {
  int column;
  Eigen::Isometry3d booth_from_sensor;  ///< as the booth believes; x right, y down, z the way it looks
  Eigen::Isometry3d error;  ///< of its column's registration: a point of the scan is error * its true place
};

struct VirtualScan {
  geometry::PointCloud cloud;  ///< no normals, shuffled
  std::vector<int> sensor;     ///< of each point: column * sensors_per_column + sensor, the lowest first
  std::vector<SensorPose> sensors;
};

/// What one sensor sends of a scan.
struct SensorScan {
  geometry::PointCloud cloud;  ///< in the booth's frame, as far off as its column; may be empty
  SensorPose pose;             ///< its viewpoint is booth_from_sensor's translation
};

/// What one sensor sees as a depth camera with a lens.
struct DepthPicture {
  int rows, columns;
  std::vector<float> depth;  ///< metres along z of the sensor's frame, row by row; NaN where nothing was seen
  double fx, fy, cx, cy;     ///< of the camera matrix, pixels
  Lens lens;
  SensorPose pose;
};

/// Every point is where a ray meets the first surface on its way, so occlusion is real. Same arguments, same
/// bits. \throw Refusal bad_option naming the option and its range
VirtualScan scan_body(const geometry::TriangleMesh& body, const ScannerOptions& options);

/// Places of the true skin from which rays return, `spacing` (0.0005 to 0.1 m) apart where a sensor at the
/// columns' distance looks straight at them; in the scan's frame. Hair and cloth let some rays return, so
/// they hide nothing. \throw Refusal as scan_body
std::vector<Eigen::Vector3d> seen_places(const geometry::TriangleMesh& body, const ScannerOptions& options,
                                         double spacing);

/// The same points, one cloud a sensor, in the order of VirtualScan::sensors.
std::vector<SensorScan> by_sensor(const VirtualScan& scan);

/// A lens as those of wide depth cameras: straight lines at the edge bend by some tens of pixels.
inline constexpr Lens kWideLens{-0.18, 0.04, 0.001, -0.0008, 0};

/// One picture a sensor, in the order of VirtualScan::sensors, with noise, outliers, misregistration and what
/// does not return as in scan_body, and about as many points. \pre options.booth_from_scan is the identity;
/// there is no fracture. Same arguments, same bits. \throw Refusal as scan_body
std::vector<DepthPicture> depth_pictures(const geometry::TriangleMesh& body, const ScannerOptions& options,
                                         const Lens& lens);

}  // namespace tensegric_fit::virtual_booth
