/// control/mesh + control/coarse + garment -> control/deformed, control/forces
#pragma once

#include <tensegric_fit/ControlMesh.h>
#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/TriangleMesh.h>

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "ros/facts.hpp"
#include "ros/parameters.hpp"
#include "tensegric/coarse_fitter.hpp"
#include "tensegric/fit_messages.hpp"
#include "tensegric/garment_fitter.hpp"
#include "tensegric/heard_garments.hpp"

namespace tensegric_fit::node {

class TensegricHandler {
 public:
  /// `bind_body`: fit::bind_body. \throw Refusal bad_option, bad_garment
  TensegricHandler(Parameters parameters, tensegric::BindBody bind_body);

  // What comes in, for one thread. Each returns the fit that it asks for, if all that it takes is there and
  // of the newest body.

  struct Input {
    ControlMesh::ConstPtr control;  // all of one scan
    Landmarks::ConstPtr landmarks;  ///< needed for a posture, else null
    TriangleMesh::ConstPtr body;
    GarmentRequest request;
    int rest;                    ///< as GarmentFitter::fit
    std::string taken_off = {};  ///< garment that `request` takes the place of and why, in words, else empty
  };
  std::optional<Input> add(const ControlMesh::ConstPtr& control);
  /// Nothing waits for it: fits that have not come to their first answer have it on this one.
  void add_coarse(const ControlMesh::ConstPtr& coarse);
  std::optional<Input> add(const Landmarks::ConstPtr& landmarks);
  std::optional<Input> add(const TriangleMesh::ConstPtr& body);

  /// A garment with lines by points is of the newest body: on the next the first garment takes its place, as
  /// it does of one that came unseen, before this control mesh, and names what this one lacks.
  /// A message that the same publisher sent last is one that it latched (HeardGarments): nothing comes of it.
  /// \throw Refusal unknown_line, bad_garment, bad_option: the garment worn before stays
  std::optional<Input> put_on(const Garment& garment, const std::string& publisher = "",
                              bool latched = false);
  std::optional<Input> put_on(const SetGarment::Request& request);
  /// Back to the first garment, from the body at rest.
  std::optional<Input> reset();

  const GarmentRequest& worn() const { return worn_; }
  /// What becomes of the garment worn: a sentence for people.
  std::string outlook() const;
  /// The garment worn, as the parameter `worn` of a node that is started again.
  std::string kept() const;
  /// Which messages were heard, as its parameter `heard`: says nothing of a body, and outlives `forget`.
  std::string heard() const { return heard_.text(); }
  bool needs_landmarks() const;

  // What goes out, for one thread, which may be another.

  struct Output {
    FitState::ConstPtr fit;
    LineForces::ConstPtr forces;
    FitName name;
    std::shared_ptr<const tensegric::Model> model;
    tensegric::Solution solution;
    Facts facts;
  };
  /// `go_on` is asked after each step; `publish` gets states on the way, none more often than the parameter
  /// `progress_period`: with a coarse mesh its answer alone, carried to the nodes of `control`, as that is
  /// nearer to the end than the way there. Nothing where it was stopped. \throw Refusal as
  /// GarmentFitter::take and fit
  std::optional<Output> handle(const Input& input, const std::function<bool()>& go_on,
                               const std::function<void(const FitState&)>& publish);

 private:
  struct Setup {
    tensegric::FitterOptions fitter;
    double progress_period = 0.05;  ///< seconds
    std::string garment = "B1";     ///< worn until another is asked for, and after a reset
    std::string kept, heard;        ///< what it wore and had heard when it ended, where it was started again
    std::string garment_directory;
  };
  static Setup setup_from(Parameters& parameters);

  GarmentRequest of_body(GarmentRequest request) const;
  std::optional<Input> wear(GarmentRequest request);
  void check(const tensegric::Garment& garment) const;
  std::optional<Input> newly_complete();
  std::string unwearable() const;
  bool complete() const;
  Input input() const;
  ControlMesh::ConstPtr coarse_of(const std::string& scan_id) const;
  std::optional<FitState> first_answer(const Input& input, const ControlMesh::ConstPtr& coarse,
                                       const FitName& name, const std::function<bool()>& go_on);

  const Setup setup_;
  const GarmentRequest first_;
  GarmentRequest worn_;
  bool unseen_ = false;  // worn_ was put on where no control mesh could say whether it fits
  HeardGarments heard_;
  ControlMesh::ConstPtr control_;  // the newest
  mutable std::mutex coarse_mutex_;
  ControlMesh::ConstPtr coarse_;  // the newest; it may come a little later than that of control_
  Landmarks::ConstPtr landmarks_;
  TriangleMesh::ConstPtr body_;
  bool fresh_ = false;  // no fit to control_ was asked for so far
  int rests_ = 0;
  tensegric::GarmentFitter fitter_;
  ControlMesh::ConstPtr taken_;  // by fitter_
  const tensegric::BindBody bind_body_;
  std::optional<tensegric::CoarseFitter>
      coarse_fitter_;                   // none where no mesh of the body in fitter_ was taken
  ControlMesh::ConstPtr coarse_taken_;  // by coarse_fitter_
};

}  // namespace tensegric_fit::node
