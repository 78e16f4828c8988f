/// One virtual depth sensor: a pinhole camera with a z-buffer.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::virtual_booth {

/// Lens distortion after Brown (1966), with the names of OpenCV and of sensor_msgs/CameraInfo's plumb_bob.
/// Coordinates are those of the image plane at unit distance, x right, y down.
struct Lens {
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;

  bool none() const { return k1 == 0 && k2 == 0 && p1 == 0 && p2 == 0 && k3 == 0; }
  /// Where the image of a straight ray lies.
  Eigen::Vector2d bent(const Eigen::Vector2d& straight) const;
  /// The inverse, to 1e-12, for lenses whose image does not fold over.
  Eigen::Vector2d straight(const Eigen::Vector2d& seen) const;
};

struct Sensor {
  Eigen::Vector3d position;
  Eigen::Matrix3d axes;            ///< rows: right, up, forward; a proper or mirrored orthonormal frame
  double half_width, half_height;  ///< of the image, at unit distance
  Lens lens = {};
};

/// Where the ray of one pixel first meets the surface.
struct Hit {
  int row, column;
  Eigen::Vector3d point;
  double incidence;  ///< cosine between ray and surface normal, 0 to 1
};

/// Rays through the pixel centres of a rows x columns image.
class DepthImage {
 public:
  DepthImage(const Sensor& sensor, int rows, int columns);
  void draw(const geometry::TriangleMesh& mesh);
  /// The plane z = 0 within `radius` of the z axis.
  void draw_floor(double radius);
  /// Row by row.
  std::vector<Hit> hits() const;

 private:
  struct Pixel {
    double depth;  // along the sensor's forward axis; infinite where nothing was met
    double incidence;
  };
  Eigen::Vector3d ray(int row, int column) const;            // sensor frame, forward component 1
  Eigen::Vector2d pixel_of(const Eigen::Vector3d& p) const;  // column and row, of a point in the sensor frame

  Sensor sensor_;
  int rows_, columns_;
  std::vector<Pixel> pixels_;
  std::vector<Eigen::Vector2d> rays_;  // row by row, right and up; none where there is no lens
};

}  // namespace tensegric_fit::virtual_booth
