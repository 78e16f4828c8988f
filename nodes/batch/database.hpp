/// A batch's results as an SQLite database (launch/pages/many_scans.md has its schema).
#pragma once

#include <string>

#include "batch/table.hpp"

namespace tensegric_fit::batch {

/// Takes the place of a file that is there, when it is whole. \throw Refusal cannot_write
void write_database(const Table& table, const std::string& file);

}  // namespace tensegric_fit::batch
