/// Places on the skin of a registered body model, in the body frame.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "body_model/registered_body.hpp"
#include "control_mesh/grid.hpp"
#include "control_mesh/template.hpp"
#include "geometry/oriented_tree.hpp"

namespace tensegric_fit::control_mesh {

class ModelSurface {
 public:
  /// `model` must outlive it.
  ModelSurface(const body_model::RegisteredBody& model, const Eigen::Isometry3d& body_from_scan);

  struct Place {
    Eigen::Vector3d point;   ///< m
    Eigen::Vector3d normal;  ///< outward, unit
  };
  /// The weighted mean of points as a template writes them for her left; on her right of their mirror images.
  /// \throw Refusal bad_template: a vertex or a name that the model does not have; `where` is said first
  Place place(const std::vector<ModelPoint>& points, Side side, const std::string& where) const;

  /// Of both sides. \throw Refusal as place
  void check(const std::vector<ModelPoint>& points, const std::string& where) const;

  /// Is the skin there, which faces along `normal`, part of a breast?
  bool on_breast(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;

 private:
  std::vector<std::pair<int, double>> vertices_of(const ModelPoint& point, Side side,
                                                  const std::string& where) const;
  const body_model::RegisteredBody& model_;
  Eigen::Isometry3d body_from_scan_;
  std::vector<Eigen::Vector3d> normals_;
  geometry::OrientedTree tree_;
};

}  // namespace tensegric_fit::control_mesh
