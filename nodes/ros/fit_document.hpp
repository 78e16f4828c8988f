/// The fit as files that programs read: fit.json (launch/schemas/fit.schema.json) and measurements.csv.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ros/fit_figures.hpp"

namespace tensegric_fit::node {

inline constexpr char kFitDocument[] = "fit.json";

/// `files`: names of the files beside it.
std::string fit_json(const FitFigures& figures, const std::vector<std::string>& files);

/// Which scan a fit.json is of; nothing where the text is no fit.json.
std::optional<std::string> scan_id_in(const std::string& fit_json);

/// A row a height and girth, millimetres.
std::string measurements_csv(const FitFigures& figures);

}  // namespace tensegric_fit::node
