/// scan/points -> body/model, body/mesh
#pragma once

#include <sensor_msgs/PointCloud2.h>
#include <tensegric_fit/BodyModel.h>
#include <tensegric_fit/TriangleMesh.h>

#include <memory>
#include <string>

#include "reconstruction/reconstruct.hpp"
#include "ros/facts.hpp"
#include "ros/parameters.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::node {

/// Options of the reconstruction by their names. \throw Refusal bad_option
reconstruction::Options reconstruction_options(Parameters& parameters);

/// The shipped body model, loaded now. \throw Refusal broken_file
reconstruction::Anatomy shipped_anatomy();

/// The frames that tf knows from others than this chain and those of other booths, whose landmarks publish
/// where `body_frame` stands, in a namespace of their own, in each scan's own frame: `transforms` as tf2
/// lists them (tf2::BufferCore::allFramesAsYAML). None where that is no YAML, as with odd names.
std::vector<std::string> frames_of_others(const std::string& transforms, const std::string& body_frame);

/// What a scan's header lacks, named (`no_stamp`, `no_frame`, `unknown_frame`), with what to do about it; ""
/// where nothing. `known`: frames of tf; of a booth that has none of its own in there nothing is said. The
/// scan is taken all the same.
std::string lacks_of(const std_msgs::Header& header, const std::vector<std::string>& known = {});

/// Somebody else in the scan (`two_persons`), with what to do about it; "" where there is nobody.
std::string company_of(const body_model::RegisteredBody& body);

class ReconstructionHandler {
 public:
  /// \throw Refusal bad_option, broken_file: the body model
  explicit ReconstructionHandler(Parameters parameters);

  struct Output {
    TriangleMesh::ConstPtr mesh;
    BodyModel::ConstPtr model;  ///< to be published before the mesh, which says that there is a new body
    std::shared_ptr<const reconstruction::Reconstruction> result;
    Facts facts;
  };
  /// `tag` is the scan's. \throw Refusal as reconstruct
  Output handle(const sensor_msgs::PointCloud2& scan, const ScanTag& tag) const;

 private:
  reconstruction::Options options_;
  reconstruction::Anatomy anatomy_;
};

}  // namespace tensegric_fit::node
