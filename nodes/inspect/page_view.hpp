/// A body in 3D in an HTML page, to be turned: three.js (Debian's libjs-three), launch/page/view.js and the
/// model inside the page, which asks no server for anything.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace tensegric_fit::inspect {

/// What is shown, and the words around it (no markup but in `notes`).
struct PageView {
  /// GLB: mesh `body`, at share 1 as its morph target says, coloured per vertex there; tubes `line ...`;
  /// where it has a mesh `beside`, that is shown left of it in place of the body at share 0.
  std::string model;
  std::string name;               ///< of what is seen, for screen readers
  std::string before, after;      ///< ends of the slider
  std::string beside;             ///< what may stand left of it
  std::string low, middle, high;  ///< of the scale of colours
  std::string notes;
  /// What is read off under the finger: {"attribute": "_DISTORTION", "per_cent": true, "here": "skin here: ",
  /// "low": "pressed together", "same": "unchanged", "high": "stretched"}: per cent of what is above 1, or
  /// millimetres of metres, "none" for values from "none_from" on.
  nlohmann::json reading;
  nlohmann::json loops =
      nlohmann::json::object();  ///< NAME: {"before": [[x, y, z], ...], "after": ...}, in the model's axes
};

/// Where the view stands in the page. Hidden where there is no WebGL.
std::string view_section(const PageView& view);

/// Before the end of the page's body. Empty for a model that would make a page larger than 8 MB.
/// \throw Refusal broken_file: three.js or view.js is not there
std::string view_scripts(const PageView& view);

}  // namespace tensegric_fit::inspect
