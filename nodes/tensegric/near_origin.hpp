/// Solves near the origin: the smaller coordinates are, the less they round, and the nearer a balance can
/// come.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tensegric/solver.hpp"

namespace tensegric_fit::tensegric {

/// What moves the middle of the control mesh to within 0.125 m of the origin, along each axis where that
/// makes no coordinate larger, and 0 along the others: nodes at rest go there and back to the last bit.
Eigen::Vector3d offset_to_origin(const geometry::ControlMesh& control);

Model moved(Model model, const Eigen::Vector3d& by);
Solution moved(Solution solution, const Eigen::Vector3d& by);
geometry::BoneFrames moved(const geometry::BoneFrames& bones, const Eigen::Vector3d& by);
std::vector<geometry::LaidLine> moved(std::vector<geometry::LaidLine> lines, const Eigen::Vector3d& by);

/// Functions of shapes in the scan's frame, for shapes that were moved by `by`; empty where they are.
Progress seen_from_scan(const Progress& function, const Eigen::Vector3d& by);
SkinFolds seen_from_scan(const SkinFolds& function, const Eigen::Vector3d& by);
std::vector<PosedVolume> seen_from_scan(const std::vector<PosedVolume>& function, const Eigen::Vector3d& by);

}  // namespace tensegric_fit::tensegric
