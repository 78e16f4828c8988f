/// A scan, solved about the middle of its control mesh: coordinates round by their size, and a balance by
/// what they round to.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tensegric/solver.hpp"

namespace tensegric_fit::tensegric {

/// What the nodes are moved by so that they lie about the origin, to 0.125 m along each axis, or not at all:
/// there and back they are the same to the last bit.
Eigen::Vector3d offset_to_origin(const geometry::ControlMesh& control);

Model moved(Model model, const Eigen::Vector3d& by);
Solution moved(Solution solution, const Eigen::Vector3d& by);
geometry::BoneFrames moved(const geometry::BoneFrames& bones, const Eigen::Vector3d& by);
std::vector<geometry::LaidLine> moved(std::vector<geometry::LaidLine> lines, const Eigen::Vector3d& by);

/// What is asked about a shape that was moved by `by` is asked where it came from; empty where `asked` is.
Progress asked_unmoved(const Progress& asked, const Eigen::Vector3d& by);
SkinFolds asked_unmoved(const SkinFolds& asked, const Eigen::Vector3d& by);
std::vector<PosedVolume> asked_unmoved(const std::vector<PosedVolume>& asked, const Eigen::Vector3d& by);

}  // namespace tensegric_fit::tensegric
