/// Scans far from their frame's origin, solved near it: coordinates round by their size, and a balance by
/// what they round to.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tensegric/solver.hpp"

namespace tensegric_fit::tensegric {

/// What the scan is moved by so that it lies near the origin; zero where it does. Sums with it and
/// differences from it are exact for points within 7 m of the mean of `points`.
Eigen::Vector3d offset_to_origin(const std::vector<Eigen::Vector3d>& points);

Model moved(Model model, const Eigen::Vector3d& by);
Solution moved(Solution solution, const Eigen::Vector3d& by);
geometry::BoneFrames moved(const geometry::BoneFrames& bones, const Eigen::Vector3d& by);
std::vector<geometry::LaidLine> moved(std::vector<geometry::LaidLine> lines, const Eigen::Vector3d& by);

/// What is asked about a shape that was moved by `by` is asked where it came from; empty where `asked` is.
Progress asked_unmoved(const Progress& asked, const Eigen::Vector3d& by);
SkinFolds asked_unmoved(const SkinFolds& asked, const Eigen::Vector3d& by);
std::vector<PosedVolume> asked_unmoved(const std::vector<PosedVolume>& asked, const Eigen::Vector3d& by);

}  // namespace tensegric_fit::tensegric
