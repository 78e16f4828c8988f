/// What a stage found, as rviz draws it.
#pragma once

#include <pcl_msgs/PolygonMesh.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/control_mesh.hpp"
#include "geometry/triangle_mesh.hpp"
#include "inspect/colours.hpp"
#include "inspect/model_skin.hpp"
#include "inspect/strokes.hpp"

namespace tensegric_fit::inspect {

/// The scene of one stage in one frame. Each scene first clears what the same topic showed before.
class Markers {
 public:
  explicit Markers(const std_msgs::Header& header);

  /// `colours`: one per vertex, with a light baked in (`lit`), since rviz draws coloured triangles unlit.
  Markers& body(const geometry::TriangleMesh& mesh, const std::vector<Colour>& colours);

  /// Edges of the registered model in the colours of its parts.
  Markers& model(const ModelSkin& skin);

  /// Dots with their names, and the tapes of the girths; orange where the confidence is below 0.5.
  Markers& landmarks(const geometry::BodyMeasures& measures);

  /// Edges over the outer nodes at `outer`; fixed nodes dark, free ones bright.
  Markers& control_mesh(const geometry::ControlMesh& control, const std::vector<Eigen::Vector3d>& outer);

  /// Coloured by tension_colour.
  Markers& lines(const geometry::ControlMesh& control, const std::vector<Eigen::Vector3d>& outer,
                 const std::vector<TenseLine>& lines);

  visualization_msgs::MarkerArray::ConstPtr share() const;

 private:
  visualization_msgs::Marker& add(const std::string& what, int type, double size);

  std_msgs::Header header_;
  visualization_msgs::MarkerArray array_;
};

/// Mesh with x y z and rgb per vertex. `colours` is empty or has one per vertex.
pcl_msgs::PolygonMesh::ConstPtr polygon_mesh(const std_msgs::Header& header,
                                             const geometry::TriangleMesh& mesh,
                                             const std::vector<Colour>& colours);

/// A BGR picture as a message.
sensor_msgs::Image::ConstPtr image(const std_msgs::Header& header, const cv::Mat& picture);

}  // namespace tensegric_fit::inspect
