/// The fit as files that programs read: fit.json (launch/schemas/fit.schema.json) and measurements.csv.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ros/fit_figures.hpp"

namespace tensegric_fit::node {

inline constexpr char kFitDocument[] = "fit.json";
inline constexpr char kSealedDocument[] = "sealed.json";  ///< beside an encrypted export

/// `files`: names of the files beside it.
std::string fit_json(const FitFigures& figures, const std::vector<std::string>& files);

/// Says only which scan an encrypted export is of, so that it can be deleted.
std::string sealed_json(const std::string& scan_id);

/// Which scan a fit.json or sealed.json is of; nothing where the text is neither.
std::optional<std::string> scan_id_in(const std::string& text);

/// A row a height and girth, millimetres.
std::string measurements_csv(const FitFigures& figures);

}  // namespace tensegric_fit::node
