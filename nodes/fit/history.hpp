/// A customer's earlier scans and fits, read from the folders that `fit` and exports wrote.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fit/result_documents.hpp"

namespace tensegric_fit::fit {

/// Metres.
struct VisitMeasure {
  double before = 0, half_width = 0;  ///< half_width 0: nothing is said
  std::optional<double> after;        ///< with the garment on
};

/// One folder.
struct Visit {
  std::filesystem::path folder;
  std::string customer, scan, source;  ///< empty: not known; `scan` is the scan_id of an export
  std::string day;  ///< YYYY-MM-DD, by the machine's time zone: of the scan, else of the folder's document
  double time = 0;  ///< s since 1970, the same
  std::string garment;                  ///< empty: measured only
  std::map<std::string, double> lines;  ///< worn / rest
  std::map<std::string, VisitMeasure> girths, heights;
  Eigen::Isometry3d body_from_scan = Eigen::Isometry3d::Identity();
};

/// What a folder is known by: an export's document, or else a report.
inline constexpr std::array<const char*, 2> kVisitDocuments{kExportDocument, kFitReport};

/// Nothing where a folder holds neither fit.json nor a report.json that went through.
std::optional<Visit> read_visit(const std::filesystem::path& folder);

/// Of these folders and all folders in them, the oldest first; of one customer, or of all where `customer` is
/// empty. \throw Refusal broken_file: a folder is not there
std::vector<Visit> find_visits(const std::vector<std::string>& folders, const std::string& customer);

/// Who was here: a line per customer with the number of visits and the first and last day.
std::string customers_text(const std::vector<Visit>& visits);

/// How a measure changed from one visit to another.
struct VisitChange {
  std::string kind, name;   ///< girth or height
  double from = 0, to = 0;  ///< m
  double half_width = 0;    ///< of the change at 95 %, m; 0: not known
  bool beyond_doubt() const { return half_width > 0 && std::abs(to - from) > half_width; }
};
std::vector<VisitChange> changes(const Visit& from, const Visit& to);

/// A row per visit, then what changed between two of them, for a terminal.
std::string visits_text(const std::vector<Visit>& visits, std::size_t from, std::size_t to);

/// The same as a page that needs no network, with outlines of both bodies over each other and links to the
/// folders (`page`: where it will lie). \throw Refusal broken_file: a body is not there
std::string visits_page(const std::vector<Visit>& visits, std::size_t from, std::size_t to,
                        const std::filesystem::path& page);

}  // namespace tensegric_fit::fit
