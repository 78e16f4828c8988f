#include "ros/markers.hpp"

#include <pcl/point_types.h>
#include <pcl_conversions/pcl_conversions.h>
#include <sensor_msgs/image_encodings.h>

namespace tensegric_fit::inspect {
namespace {

using visualization_msgs::Marker;

constexpr double kDot = 0.012, kNode = 0.005, kEdge = 0.0015, kModelEdge = 0.0006, kTape = 0.003,
                 kBand = 0.006,
                 kLetter = 0.02;  // metres
constexpr Colour kFixed{30, 30, 30}, kFree{250, 200, 40};

std_msgs::ColorRGBA rgba(const Colour& colour) {
  std_msgs::ColorRGBA result;
  result.r = static_cast<float>(colour[0]) / 255;
  result.g = static_cast<float>(colour[1]) / 255;
  result.b = static_cast<float>(colour[2]) / 255;
  result.a = 1;
  return result;
}

geometry_msgs::Point point_of(const Eigen::Vector3d& position) {
  geometry_msgs::Point point;
  point.x = position.x();
  point.y = position.y();
  point.z = position.z();
  return point;
}

}  // namespace

Markers::Markers(const std_msgs::Header& header) : header_(header) {
  Marker clear;
  clear.header = header_;
  clear.action = Marker::DELETEALL;
  array_.markers.push_back(clear);
}

Marker& Markers::add(const std::string& what, int type, double size) {
  Marker marker;
  marker.header = header_;
  marker.ns = what;
  marker.id = static_cast<int>(array_.markers.size());
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1;
  marker.scale.x = marker.scale.y = marker.scale.z = size;
  marker.color.a = 1;
  array_.markers.push_back(std::move(marker));
  return array_.markers.back();
}

Markers& Markers::body(const geometry::TriangleMesh& mesh, const std::vector<Colour>& colours) {
  Marker& marker = add("body", Marker::TRIANGLE_LIST, 1);
  marker.points.reserve(3 * mesh.triangles.size());
  marker.colors.reserve(3 * mesh.triangles.size());
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      marker.points.push_back(point_of(mesh.vertices[triangle[corner]]));
      marker.colors.push_back(rgba(colours[triangle[corner]]));
    }
  }
  return *this;
}

Markers& Markers::model(const ModelSkin& skin) {
  Marker& edges = add("body_model", Marker::LINE_LIST, kModelEdge);
  for (const Stroke& edge : model_strokes(skin, lifted(skin.vertices, triangles_of(skin)))) {
    for (const Eigen::Vector3d& end : edge.points) {
      edges.points.push_back(point_of(end));
      edges.colors.push_back(rgba(edge.colour));
    }
  }
  return *this;
}

Markers& Markers::landmarks(const geometry::BodyMeasures& measures) {
  Marker& dots = add("landmarks", Marker::SPHERE_LIST, kDot);
  for (const geometry::Landmark& landmark : measures.landmarks) {
    dots.points.push_back(point_of(landmark.position));
    dots.colors.push_back(rgba(landmark.confidence < geometry::kUnsure ? kUnsureColour : kSureColour));
  }
  const Eigen::Vector3d up = measures.body_from_scan.linear().row(2);
  for (const geometry::Landmark& landmark : measures.landmarks) {
    Marker& text = add("landmark_names", Marker::TEXT_VIEW_FACING, kLetter);
    text.text = landmark.name;
    text.pose.position = point_of(landmark.position + 1.5 * kDot * up);
    text.color = rgba(kFixed);
  }
  for (const geometry::GirthLoop& loop : measures.loops) {
    if (loop.points.empty()) continue;
    Marker& tape = add("girths", Marker::LINE_STRIP, kTape);
    tape.color = rgba(kSureColour);
    for (const Eigen::Vector3d& position : loop.points) tape.points.push_back(point_of(position));
    tape.points.push_back(tape.points.front());
  }
  return *this;
}

Markers& Markers::control_mesh(const geometry::ControlMesh& control,
                               const std::vector<Eigen::Vector3d>& outer) {
  Marker& edges = add("control_mesh", Marker::LINE_LIST, kEdge);
  for (const Stroke& edge : edge_strokes(control, outer)) {
    edges.color = rgba(edge.colour);
    for (const Eigen::Vector3d& end : edge.points) edges.points.push_back(point_of(end));
  }
  const std::vector<Eigen::Vector3d> positions = lifted(outer, control.triangles);
  Marker& nodes = add("control_nodes", Marker::SPHERE_LIST, kNode);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    nodes.points.push_back(point_of(positions[i]));
    nodes.colors.push_back(rgba(control.outer_fixed[i] ? kFixed : kFree));
  }
  return *this;
}

Markers& Markers::lines(const geometry::ControlMesh& control, const std::vector<Eigen::Vector3d>& outer,
                        const std::vector<TenseLine>& lines) {
  for (const Stroke& line : line_strokes(control, outer, lines)) {
    Marker& band = add("lines", Marker::LINE_STRIP, kBand);
    band.color = rgba(line.colour);
    for (const Eigen::Vector3d& point : line.points) band.points.push_back(point_of(point));
  }
  return *this;
}

visualization_msgs::MarkerArray::ConstPtr Markers::share() const {
  return boost::make_shared<visualization_msgs::MarkerArray>(array_);
}

pcl_msgs::PolygonMesh::ConstPtr polygon_mesh(const std_msgs::Header& header,
                                             const geometry::TriangleMesh& mesh,
                                             const std::vector<Colour>& colours) {
  pcl::PointCloud<pcl::PointXYZRGB> cloud;
  cloud.reserve(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Colour& colour = colours.empty() ? kNeutral : colours[i];
    pcl::PointXYZRGB point(colour[0], colour[1], colour[2]);
    point.getVector3fMap() = mesh.vertices[i].cast<float>();
    cloud.push_back(point);
  }
  auto message = boost::make_shared<pcl_msgs::PolygonMesh>();
  pcl::toROSMsg(cloud, message->cloud);
  message->header = message->cloud.header = header;
  message->polygons.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    message->polygons.emplace_back();
    message->polygons.back().vertices.assign(triangle.data(), triangle.data() + 3);
  }
  return message;
}

sensor_msgs::Image::ConstPtr image(const std_msgs::Header& header, const cv::Mat& picture) {
  auto message = boost::make_shared<sensor_msgs::Image>();
  message->header = header;
  message->height = static_cast<std::uint32_t>(picture.rows);
  message->width = static_cast<std::uint32_t>(picture.cols);
  message->encoding = sensor_msgs::image_encodings::BGR8;
  message->step = static_cast<std::uint32_t>(picture.cols * picture.elemSize());
  message->data.reserve(message->height * message->step);
  for (int row = 0; row < picture.rows; ++row)
    message->data.insert(message->data.end(), picture.ptr(row), picture.ptr(row) + message->step);
  return message;
}

}  // namespace tensegric_fit::inspect
