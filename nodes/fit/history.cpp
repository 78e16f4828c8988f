#include "fit/history.hpp"

#include <fmt/format.h>

#include <sys/stat.h>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <set>

#include "geometry/scan_stamp.hpp"
#include "geometry/status.hpp"
#include "inspect/words.hpp"

namespace tensegric_fit::fit {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

double time_of_change(const fs::path& file) {
  struct stat status {};
  return stat(file.c_str(), &status) == 0 ? static_cast<double>(status.st_mtime) : 0;
}

Eigen::Isometry3d pose_in(const json& rows) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) pose.matrix()(r, c) = rows.at(r).at(c).get<double>();
  return pose;
}

std::map<std::string, VisitMeasure> exported(const json& list) {
  std::map<std::string, VisitMeasure> measures;
  for (const json& entry : list) {
    VisitMeasure& measure = measures[entry.at("name").get<std::string>()];
    measure.before = entry.at("before_mm").get<double>() / 1e3;
    measure.half_width = entry.value("half_width_mm", 0.0) / 1e3;
    if (entry.at("after_mm").is_number()) measure.after = entry.at("after_mm").get<double>() / 1e3;
  }
  return measures;
}

std::map<std::string, VisitMeasure> reported(const json& report, const char* kind) {
  std::map<std::string, VisitMeasure> measures;
  for (const auto& [name, value] : report.at(kind).items()) {
    measures[name].before = value.get<double>();
    const json place =
        report.value(json::json_pointer(std::string("/confidence/") + kind + "/" + name), json::object());
    measures[name].half_width = place.value("half_width", 0.0);
  }
  return measures;
}

void add_lines(const json& lines, Visit& visit) {
  for (const json& line : lines)
    visit.lines[line.at("name").get<std::string>()] = line.at("ratio").get<double>();
}

/// Blanks round an id come from a form or a label printer, and cannot be seen.
std::string trimmed(const std::string& id) {
  constexpr const char* kBlank = " \t\r\n";
  const std::size_t first = id.find_first_not_of(kBlank);
  return first == std::string::npos ? "" : id.substr(first, id.find_last_not_of(kBlank) + 1 - first);
}

void read_export(const json& document, Visit& visit) {
  const json& scan = document.at("scan");
  visit.scan = scan.at("scan_id").get<std::string>();
  visit.customer = trimmed(scan.value("customer", ""));
  visit.source = scan.value("source", "");
  visit.body_from_scan = pose_in(scan.at("body_from_scan"));
  const double stamp = std::strtod(visit.scan.c_str(), nullptr);
  if (!geometry::day_of(stamp).empty()) visit.time = stamp;  // else its clock was not set
  visit.garment = document.at("garment").at("name").get<std::string>();
  add_lines(document.at("garment").at("lines"), visit);
  visit.girths = exported(document.at("body").at("girths"));
  visit.heights = exported(document.at("body").at("heights"));
}

// False where the scan was refused.
bool read_report(const json& report, Visit& visit) {
  if (report.at("status") != "ok") return false;
  const json& scan = report.at("scan");
  visit.customer = trimmed(scan.value("customer", ""));
  visit.source = fs::path(scan.at("file").get<std::string>()).filename();
  visit.body_from_scan = pose_in(scan.at("body_from_scan"));
  visit.garment = report.value("garment", "");
  if (report.contains("lines")) add_lines(report.at("lines"), visit);
  visit.girths = reported(report, "girths");
  visit.heights = reported(report, "heights");
  return true;
}

void add_changes(const std::string& kind, const std::map<std::string, VisitMeasure>& from,
                 const std::map<std::string, VisitMeasure>& to, std::vector<VisitChange>& all) {
  for (const auto& [name, measure] : from) {
    const auto other = to.find(name);
    if (other == to.end()) continue;
    const double a = measure.half_width, b = other->second.half_width;
    all.push_back({kind, name, measure.before, other->second.before, a > 0 && b > 0 ? std::hypot(a, b) : 0});
  }
}

}  // namespace

std::optional<Visit> read_visit(const fs::path& folder) {
  Visit visit;
  visit.folder = folder;
  try {
    for (const char* name : kVisitDocuments) {
      const json document = read_document(folder / name);
      if (!document.is_object()) continue;
      visit.time = time_of_change(folder / name);
      if (document.contains("format"))
        read_export(document, visit);
      else if (!read_report(document, visit))
        return std::nullopt;
      visit.day = geometry::day_of(visit.time);
      return visit;
    }
  } catch (const json::exception&) {  // some other program's
  }
  return std::nullopt;
}

std::vector<Visit> find_visits(const std::vector<std::string>& folders, const std::string& customer_id) {
  const std::string customer = trimmed(customer_id);
  if (customer.empty() && !customer_id.empty()) return {};  // blanks are nobody
  std::vector<Visit> visits;
  std::set<fs::path> seen;  // folders may lie in one another
  const auto look = [&](const fs::path& folder) {
    std::error_code gone;
    const fs::path place = fs::canonical(folder, gone);
    if (gone || !seen.insert(place).second) return;
    const std::optional<Visit> visit = read_visit(folder);
    if (visit && (customer.empty() || visit->customer == customer)) visits.push_back(*visit);
  };
  for (const std::string& folder : folders) {
    if (!fs::is_directory(folder))
      throw geometry::Refusal(geometry::refusal::kBrokenFile, folder + ": there is no such folder");
    look(folder);
    constexpr auto kSkip = fs::directory_options::skip_permission_denied;
    constexpr int kMostWalks = 10;
    std::error_code failed;
    int walks = 0;
    do {  // again where a folder was deleted meanwhile, which ends the walk
      failed.clear();
      for (fs::recursive_directory_iterator entry(folder, kSkip, failed), end; entry != end && !failed;
           entry.increment(failed)) {
        std::error_code unknown;
        if (!entry->is_directory(unknown)) continue;
        if (entry->path().extension() == ".unfinished")  // an export, never finished or being deleted
          entry.disable_recursion_pending();
        else
          look(entry->path());
      }
    } while (failed == std::errc::no_such_file_or_directory && ++walks < kMostWalks);
    if (failed) throw fs::filesystem_error("cannot be looked through", folder, failed);
  }
  std::sort(visits.begin(), visits.end(), [](const Visit& a, const Visit& b) {
    return a.time != b.time ? a.time < b.time : a.folder < b.folder;
  });
  return visits;
}

std::string customers_text(const std::vector<Visit>& visits) {
  std::map<std::string, std::vector<const Visit*>> customers;
  for (const Visit& visit : visits) customers[visit.customer].push_back(&visit);
  std::string text;
  for (const auto& [customer, own] : customers)
    text +=
        fmt::format("{:<20} {:>3} {} {} to {}\n", customer.empty() ? "(nobody said who)" : customer,
                    own.size(), own.size() == 1 ? "visit, " : "visits,", own.front()->day, own.back()->day);
  return text;
}

std::vector<VisitChange> changes(const Visit& from, const Visit& to) {
  std::vector<VisitChange> all;
  add_changes("girth", from.girths, to.girths, all);
  add_changes("height", from.heights, to.heights, all);
  return all;
}

std::string visits_text(const std::vector<Visit>& visits, std::size_t from, std::size_t to) {
  std::string text;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const Visit& visit = visits[i];
    std::string lines;
    for (const auto& [name, ratio] : visit.lines) lines += fmt::format(" {} {:.1f} %", name, 100 * ratio);
    text += fmt::format("{:>3}  {}  {}{}  {}\n", i + 1, visit.day,
                        visit.garment.empty() ? "measured" : visit.garment, lines, visit.folder.string());
  }
  if (visits.size() < 2) return text;
  text += fmt::format("from {} to {}, cm:\n", from + 1, to + 1);
  for (const VisitChange& change : changes(visits[from], visits[to]))
    text += fmt::format("  {:<7} {:<12} {:>6.1f} -> {:>6.1f}  {:>5}{}{}\n", change.kind, change.name,
                        100 * change.from, 100 * change.to,
                        inspect::words::centimetre_change(change.from, change.to),
                        change.half_width > 0 ? fmt::format(" +- {:.1f}", 100 * change.half_width) : "",
                        change.beyond_doubt() ? "  changed" : "");
  return text;
}

}  // namespace tensegric_fit::fit
