/// The statistical, posable body: shapes of women as a mean and principal components, carried by a skeleton.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace tensegric_fit::body_model {

struct Bone {
  std::string name;
  int parent;  ///< -1: the root, the pelvis; a parent stands before its children
};

/// Bones that turn together: bone b by share times the group's rotation vector, in its parent's frame at
/// rest.
struct PoseGroup {
  std::string name;
  std::vector<std::pair<int, double>> bones;  ///< bone, share
  Eigen::Vector3d spread;                     ///< rad, standard deviation of each rotation component
};

/// A point that bones carry though it lies under the skin.
struct BonePoint {
  std::string name;
  int bone;
};

/// A named place on the skin.
struct SkinPoint {
  std::string name;
  std::vector<std::pair<int, double>> vertices;  ///< vertex, share; shares sum to 1
};

/// The skin and what lies in it. Read from a file that tests/body_model/train.py makes (format: README). At
/// rest she stands in metres, z up, facing -y, her left at +x, the pelvis joint at the origin, with one
/// stature for all shapes.
struct Model {
  static constexpr int kWeights = 4;  ///< bones that carry a vertex, at most

  std::vector<Eigen::Vector3d> mean;  ///< vertices of the mean shape, m
  Eigen::MatrixXf basis;              ///< components x 3 vertices: what one standard deviation adds, m
  std::vector<std::array<unsigned char, kWeights>> carriers;  ///< bones of a vertex
  std::vector<std::array<float, kWeights>> weights;           ///< their shares, sum 1
  std::vector<std::array<int, 4>> quads;                      ///< counter-clockwise from outside
  std::vector<Eigen::Vector3i> triangles;                     ///< two per quad
  std::string checksum;  ///< of the file's bytes, FNV-1a of 64 bits in hexadecimal: which model it is
  double stature;        ///< m, of every shape at rest
  std::vector<Bone> bones;
  std::vector<PoseGroup> groups;
  std::vector<std::string> parts;           ///< names
  std::vector<unsigned char> part;          ///< of each vertex, index into parts
  std::vector<double> arm;                  ///< of each vertex: how much of it arm bones carry, 0 to 1
  std::vector<Eigen::Vector3d> inner_mean;  ///< joints (one per bone), then bone points, m
  Eigen::MatrixXd inner_basis;              ///< components x 3 inner points
  std::vector<BonePoint> bone_points;
  std::vector<SkinPoint> skin_points;
  std::vector<int> fit_points;      ///< vertices that stand for the skin round them in a fit
  std::vector<double> fit_weights;  ///< what each of them counts, 0 to 1: its skin's area and how sure it is

  int components() const { return static_cast<int>(basis.rows()); }
  int part_named(const std::string& name) const;   ///< index into parts, or -1
  int group_named(const std::string& name) const;  ///< index into groups, or -1
};

/// \throw Refusal broken_file: not there, another format, or contents that do not fit each other
Model load_model(const std::string& path);

}  // namespace tensegric_fit::body_model
