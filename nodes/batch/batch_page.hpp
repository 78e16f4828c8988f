/// A batch's results as one HTML page that needs no other file but pictures.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "batch/drift.hpp"
#include "batch/table.hpp"

namespace tensegric_fit::batch {

/// Rows whose measures are least sure, worst first: by the mean confidence of their girths.
std::vector<std::size_t> least_sure(const Table& table, std::size_t count);

/// Refusals by reason, distributions, the least sure and the slowest, changes against another version.
/// `pictures`: the folder of a row's pictures, relative to the page.
std::string batch_page(const Table& table, const std::optional<Comparison>& comparison,
                       const std::map<std::size_t, std::string>& pictures);

}  // namespace tensegric_fit::batch
