/// What `correlate` found, as files.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "correlation/correlate.hpp"
#include "correlation/differences.hpp"
#include "fit/chain.hpp"
#include "fit/fitted_folder.hpp"
#include "fit/report.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::fit {

/// A correlation that went through, with what it is of. Only borrowed.
struct Correlated {
  const FittedFolder& fitted;
  const Source& worn;
  double thickness;  ///< m
  const correlation::Correlation& result;
  const correlation::Differences& differences;
  bool same_scan;  ///< the worn scan is the one without the garment once more
};

/// correlate.json, metres.
nlohmann::ordered_json report_of(const Correlated& correlated);

/// distance.csv: one row per vertex of deformed.ply: its part, whether it is compared, and its distance in
/// mm.
std::string distance_csv(const correlation::Correlation& result);

/// A picture with what stands under it.
struct PagePicture {
  std::string png;  ///< bytes
  std::string caption;
};

/// HTML that needs no other file, for a screen of any width or A4. \param model of inspect::correlation_glb
std::string correlation_page(const Correlated& correlated, const std::vector<PagePicture>& pictures,
                             const std::string& model);

}  // namespace tensegric_fit::fit
