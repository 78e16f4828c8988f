#include "ros/display.hpp"

#include <Eigen/Eigenvalues>

#include "ros/markers.hpp"

namespace tensegric_fit::node {
namespace {

constexpr int kImageHeight = 900;
constexpr double kMargin = 1.05;    // picture height / mesh height
constexpr double kFlattest = 0.25;  // height / width of a picture, whatever the mesh

std::vector<inspect::Colour> plain_colours(const geometry::TriangleMesh& mesh,
                                           const std::vector<double>& distortion) {
  return distortion.empty() ? std::vector<inspect::Colour>(mesh.vertices.size(), inspect::kNeutral)
                            : inspect::distortion_colours(distortion);
}

}  // namespace

std::vector<inspect::Colour> lit_skin(const geometry::TriangleMesh& mesh,
                                      const std::vector<inspect::Colour>& colours,
                                      const Eigen::Isometry3d& body_from_scan) {
  const Eigen::Vector3d light =
      -Eigen::Vector3d(0.7, 0.8, 0.8).normalized();  // the way it shines, body frame
  return inspect::lit(mesh, colours, body_from_scan.linear().transpose() * light);
}

std::vector<inspect::Colour> skin_colours(const geometry::TriangleMesh& mesh,
                                          const std::vector<double>& distortion,
                                          const Eigen::Isometry3d& body_from_scan) {
  return lit_skin(mesh, plain_colours(mesh, distortion), body_from_scan);
}

sensor_msgs::Image::ConstPtr front_image(const std_msgs::Header& header, const geometry::TriangleMesh& mesh,
                                         const std::vector<double>& distortion,
                                         const std::vector<inspect::Polyline>& lines,
                                         const Eigen::Isometry3d& body_from_scan) {
  std::vector<Eigen::Vector3d> placed;
  for (const Eigen::Vector3d& vertex : mesh.vertices) placed.push_back(body_from_scan * vertex);
  const auto [low, high] = geometry::bounding_box(placed);
  const Eigen::Vector3d size = high - low;

  const inspect::View view =
      inspect::front_view(body_from_scan, body_from_scan.inverse() * Eigen::Vector3d((low + high) / 2),
                          kMargin * std::max(size.z(), kFlattest * size.y()));
  const int width =
      std::max(1, static_cast<int>(kImageHeight * (size.y() + (kMargin - 1) * size.z()) / view.height));
  return inspect::image(
      header, inspect::draw(mesh, plain_colours(mesh, distortion), lines, view, width, kImageHeight));
}

Eigen::Isometry3d facing(const geometry::TriangleMesh& mesh) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    mean += vertex / static_cast<double>(mesh.vertices.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    const Eigen::Vector2d offset = (vertex - mean).head<2>();
    spread += offset * offset.transpose();
  }
  const Eigen::Vector2d narrow = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(0);
  Eigen::Isometry3d isometry = Eigen::Isometry3d::Identity();
  isometry.linear().row(0) << narrow.x(), narrow.y(), 0;
  isometry.linear().row(1) << -narrow.y(), narrow.x(), 0;
  return isometry;
}

}  // namespace tensegric_fit::node
