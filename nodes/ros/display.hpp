/// What a stage shows to people: ~markers, ~polygon_mesh and ~image, made only while someone listens.
#pragma once

#include <pcl_msgs/PolygonMesh.h>
#include <sensor_msgs/Image.h>
#include <visualization_msgs/MarkerArray.h>

#include "geometry/body_measures.hpp"
#include "inspect/picture.hpp"
#include "ros/kept_publisher.hpp"

namespace tensegric_fit::node {

class Display {
 public:
  explicit Display(const ros::NodeHandle& private_node)
      : markers(private_node, "markers"),
        polygon_mesh(private_node, "polygon_mesh"),
        image(private_node, "image") {}

  KeptPublisher<visualization_msgs::MarkerArray> markers;
  KeptPublisher<pcl_msgs::PolygonMesh> polygon_mesh;
  KeptPublisher<sensor_msgs::Image> image;
};

/// Colours in the light that falls on the body from the front, above and her left. One per vertex.
std::vector<inspect::Colour> lit_skin(const geometry::TriangleMesh& mesh,
                                      const std::vector<inspect::Colour>& colours,
                                      const Eigen::Isometry3d& body_from_scan);

/// Neutral skin, or skin coloured by distortion, in the same light. `distortion` is empty or has one value a
/// vertex.
std::vector<inspect::Colour> skin_colours(const geometry::TriangleMesh& mesh,
                                          const std::vector<double>& distortion,
                                          const Eigen::Isometry3d& body_from_scan);

/// The whole mesh seen from the front.
sensor_msgs::Image::ConstPtr front_image(const std_msgs::Header& header, const geometry::TriangleMesh& mesh,
                                         const std::vector<double>& distortion,
                                         const std::vector<inspect::Polyline>& lines,
                                         const Eigen::Isometry3d& body_from_scan);

/// Scan to body frame as far as it shows in a mesh without landmarks: upright, seen across its widest side.
Eigen::Isometry3d facing(const geometry::TriangleMesh& mesh);

}  // namespace tensegric_fit::node
