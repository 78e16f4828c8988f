/// What is drawn over a body: landmarks, tapes, body model, control mesh, members, garment lines.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/carried_points.hpp"
#include "geometry/control_mesh.hpp"
#include "inspect/body_view.hpp"
#include "inspect/model_skin.hpp"
#include "inspect/strokes.hpp"

namespace tensegric_fit::inspect {

/// A dot with its name.
struct NamedDot {
  Eigen::Vector3d position;
  std::string name;
  Colour colour;
};

/// Members of a tensegric model, numbered as the nodes: outer ones, inner ones, then those between layers,
/// level by level from the skin.
struct MemberPulls {
  std::vector<Eigen::Vector3d> nodes;
  std::vector<int> ends;       ///< two a member
  std::vector<double> forces;  ///< one per member, over the mean pull at rest
};

/// Everything is kept with the scan that it is of, and drawn over a body of that scan only. Landmarks,
/// tapes and the body model go where the skin goes. Metres, scan frame. For one thread.
class Overlays {
 public:
  void take_measures(const std::string& scan_id, geometry::BodyMeasures measures);
  /// \throw Refusal as check_model_skin
  void take_model(const std::string& scan_id, ModelSkin skin);
  void take_control(const std::string& scan_id, geometry::ControlMesh control);
  /// While a fit is on its way, `lines` is empty and those before stay.
  void take_fit(const std::string& scan_id, std::vector<Eigen::Vector3d> outer, std::vector<TenseLine> lines);
  /// Bands of a fit; those of the fit that is shown stand for its lines of the same name. \throw Refusal
  /// bad_mesh: arrays that do not fit each other
  void take_bands(const std::string& scan_id, std::vector<BandOnSkin> bands);
  /// \throw Refusal bad_mesh: arrays that do not fit each other
  void take_members(const std::string& scan_id, MemberPulls members);

  /// Holds nothing of that scan any more. False: it held nothing of it.
  bool forget(const std::string& scan_id);

  // `blend`: from rest (0) to worn (1). Empty where there is nothing of the body's scan.
  std::vector<NamedDot> dots(const BodyView& body, double blend);
  std::vector<Stroke> tapes(const BodyView& body, double blend);
  std::vector<Stroke> model(const BodyView& body, double blend);
  std::vector<Stroke> edges(const BodyView& body, double blend) const;
  std::vector<Stroke> lines(const BodyView& body, double blend) const;
  std::vector<Ribbon> ribbons(const BodyView& body, double blend) const;
  std::vector<Stroke> members(const BodyView& body, double blend) const;

  /// Of the body's scan, or null.
  const geometry::BodyMeasures* measures(const BodyView& body) const;

 private:
  template <typename Value>
  struct Of {
    std::string scan_id;
    Value value;
  };
  struct Fit {
    std::vector<Eigen::Vector3d> outer;
    std::vector<TenseLine> lines;
  };
  struct Carried {
    int revision;  // of the body's mesh
    geometry::CarriedPoints landmarks;
    std::vector<geometry::CarriedPoints> loops;
  };

  struct CarriedModel {
    int revision;
    geometry::CarriedPoints skin;
  };

  bool carry(const BodyView& body);
  std::optional<std::vector<Eigen::Vector3d>> outer(const BodyView& body, double blend) const;

  std::optional<Of<geometry::BodyMeasures>> measures_;
  std::optional<Of<ModelSkin>> model_;
  std::optional<Of<geometry::ControlMesh>> control_;
  std::optional<Of<Fit>> fit_;
  std::optional<Of<std::vector<BandOnSkin>>> bands_;
  std::optional<Of<MemberPulls>> members_;
  std::optional<Carried> carried_;
  std::optional<CarriedModel> carried_model_;  // made when it is first drawn: no one may ask for it
};

}  // namespace tensegric_fit::inspect
