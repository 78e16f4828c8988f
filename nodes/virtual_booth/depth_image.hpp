/// One virtual depth sensor: a pinhole camera with a z-buffer.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::virtual_booth {

struct Sensor {
  Eigen::Vector3d position;
  Eigen::Matrix3d axes;            ///< rows: right, up, forward; a proper or mirrored orthonormal frame
  double half_width, half_height;  ///< of the image, at unit distance
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
  Eigen::Vector3d ray(int row, int column) const;  // sensor frame, forward component 1

  Sensor sensor_;
  int rows_, columns_;
  std::vector<Pixel> pixels_;
};

}  // namespace tensegric_fit::virtual_booth
