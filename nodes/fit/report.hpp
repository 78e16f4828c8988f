/// report.json and history.csv (launch/pages/results.md).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fit/chain.hpp"
#include "geometry/status.hpp"
#include "mesh_files/reading.hpp"

namespace tensegric_fit::fit {

/// Where the body came from.
struct Source {
  std::string file;
  std::size_t points = 0;
  std::vector<std::string> more = {};  ///< further files of the same scan
  mesh_files::Reading reading = {};    ///< of all of them
  std::string customer = {};           ///< the shop's own id of her; empty: none
  std::string garment = {};            ///< its name
};

/// The report of a run that went through; `fitting` and `fit` are null where only measured. `warnings`: of
/// the fit.
nlohmann::ordered_json report_of(const Source& source, const Body& body, const Fitting* fitting,
                                 const Fit* fit, const std::vector<geometry::FitWarning>& warnings,
                                 const Settings& settings, const StageTimes& times);

/// The report of a refused run.
nlohmann::ordered_json report_of(const Source& source, const geometry::Refusal& refusal);

/// P2 Fig. 11: iteration, line ratios, volume errors, nipple heights above the soles, residual.
std::string history_csv(const Body& body, const Fitting& fitting, const tensegric::Solution& solution);

/// Outer nodes whose way the history shows: the bust points, where the control mesh has them.
std::vector<int> tracked_nodes(const geometry::ControlMesh& control);

}  // namespace tensegric_fit::fit
