/// scan/points -> body/mesh
#pragma once

#include <sensor_msgs/PointCloud2.h>
#include <tensegric_fit/TriangleMesh.h>

#include <memory>

#include "reconstruction/reconstruct.hpp"
#include "ros/facts.hpp"
#include "ros/parameters.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::node {

/// Options of the reconstruction by their names. \throw Refusal bad_option
reconstruction::Options reconstruction_options(Parameters& parameters);

class ReconstructionHandler {
 public:
  /// \throw Refusal bad_option
  explicit ReconstructionHandler(Parameters parameters);

  struct Output {
    TriangleMesh::ConstPtr mesh;
    std::shared_ptr<const reconstruction::BodyMesh> body;
    Facts facts;
  };
  /// `tag` is the scan's. \throw Refusal as reconstruct
  Output handle(const sensor_msgs::PointCloud2& scan, const ScanTag& tag) const;

 private:
  reconstruction::Options options_;
};

}  // namespace tensegric_fit::node
