/// The skin over the tissue as an elastic membrane: it resists being stretched and being pushed together.
/// Ours; the papers' skin is tensile parts, which pull only.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tensegric/model.hpp"
#include "tensegric/node_matrix.hpp"

namespace tensegric_fit::tensegric {

/// An outer triangle. With F its deformation gradient in its plane, J its area over that at rest A0, it adds
/// the energy 1/2 stiffness A0 (|F|^2 - 2 - 2 (J - 1) + 3 (J - 1)^2): of small strains that of an
/// incompressible membrane, Young's modulus times thickness 3 stiffness.
struct SkinTriangle {
  Eigen::Vector3i nodes;
  Eigen::Matrix3d form;  ///< A0 |F|^2 as a quadratic form of the corners
  Eigen::Vector3d origin;
  double rest;       ///< area at rest, m^2
  double stiffness;  ///< pseudo force / m
};

/// One a triangle that can move and is not flat; none where the model has no skin.
std::vector<SkinTriangle> skin_triangles(const Model& model, const std::vector<int>& free_index);

double skin_energy(const std::vector<SkinTriangle>& skin, const Positions& x);

/// Add the energy's first and second derivative by the free nodes, with `whole` of the part of the second one
/// that may be negative.
void add_skin_gradient(const std::vector<SkinTriangle>& skin, const Positions& x,
                       const std::vector<int>& free_index, Eigen::VectorXd& gradient);
void add_skin_hessian(const std::vector<SkinTriangle>& skin, const Positions& x,
                      const std::vector<int>& free_index, NodeMatrix& hessian, double whole = 1);

}  // namespace tensegric_fit::tensegric
