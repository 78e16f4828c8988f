#include "batch/table.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "batch/manifest.hpp"
#include "batch/shard_file.hpp"
#include "files/csv.hpp"
#include "files/whole_folder.hpp"
#include "geometry/json_text.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::batch {
namespace {

namespace fs = std::filesystem;
using geometry::Refusal;
using Json = nlohmann::ordered_json;

constexpr const char* kBroken = geometry::refusal::kBrokenFile;

void add(const std::string& name, const Json& value, std::vector<Figure>& figures);

void add_list(const std::string& name, const Json& list, std::vector<Figure>& figures) {
  const auto all = [&list](auto is) { return !list.empty() && std::all_of(list.begin(), list.end(), is); };
  constexpr const char* kAxes[] = {"x", "y", "z"};
  if (list.size() == 3 && all([](const Json& v) { return v.is_number(); })) {
    for (std::size_t i = 0; i < 3; ++i) add(name + "." + kAxes[i], list[i], figures);
  } else if (list.size() == 2 && all([](const Json& v) { return v.is_number(); })) {
    add(name + ".before", list[0], figures);
    add(name + ".after", list[1], figures);
  } else if (all([](const Json& v) {
               return v.is_object() && v.contains("name") && v["name"].is_string();
             })) {
    for (const Json& part : list) {
      Json rest = part;
      rest.erase("name");
      add(name + "." + part["name"].get<std::string>(), rest, figures);
    }
  } else {
    figures.emplace_back(name + ".count", static_cast<double>(list.size()));
  }
}

void add(const std::string& name, const Json& value, std::vector<Figure>& figures) {
  if (value.is_object()) {
    for (const auto& [key, part] : value.items()) add(name.empty() ? key : name + "." + key, part, figures);
  } else if (value.is_array()) {
    add_list(name, value, figures);
  } else if (value.is_number()) {
    figures.emplace_back(name, value.get<double>());
  } else if (value.is_boolean()) {
    figures.emplace_back(name, value.get<bool>() ? 1.0 : 0.0);
  } else if (value.is_string()) {
    figures.emplace_back(name, value.get<std::string>());
  }
}

/// batch.json and the lines of a folder that are of its manifest and build.
struct Folder {
  Json description;
  std::map<std::size_t, Json> lines;
  std::set<std::size_t> conflicts;  ///< rows that files of other numbers of shards have other scans of
};

/// Whether a line stays although one of the same row comes after it.
bool stays(const Json& line, const Json& later) {
  return is_settled(line) && !is_settled(later) &&
         (later.at("key") == "" || later.at("key") == line.at("key"));
}

bool is_description(const Json& value) {
  return value.is_object() && value.contains("rows") && value["rows"].is_number_unsigned() &&
         value["rows"] <= kMostRows && value.value("build", Json("")).is_string() &&
         value.value("manifest_identity", Json("")).is_string();
}

/// Nothing where there is no batch.json: the shard never began. Of several lines of a row the last counts,
/// but one that is settled before one that is not: scans are moved once their results are there, and the
/// names of files of other numbers of shards say nothing of which is the later.
std::optional<Folder> read_folder(const std::string& path) {
  const fs::path description = fs::path(path) / "batch.json";
  if (!fs::exists(description)) return std::nullopt;
  constexpr std::size_t kLargest = 1 << 20;                       // bytes; it has some hundred
  const std::string place = fs::canonical(description).string();  // it may be a link
  Folder folder{geometry::json_in<Json>(files::bytes_of_plain_file(place, kLargest).value_or("")), {}, {}};
  if (!is_description(folder.description))
    throw Refusal(kBroken, description.string() + " is not of fit_batch");
  const std::size_t rows = folder.description["rows"];
  const std::string build = folder.description.value("build", ""),
                    manifest = folder.description.value("manifest_identity", "");
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(path))
    if (fnmatch("shard-*-of-*.jsonl", entry.path().filename().c_str(), 0) == 0) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::map<std::size_t, std::string> settled_in;  // the file of a row's settled line
  for (const std::string& file : files) {
    for_each_line(file, [&](Json&& line, std::size_t) {
      const std::size_t row = line.at("row");
      if (row > rows || line.value("build", "") != build || line.value("manifest", "") != manifest) return;
      if (!has_all_parts(line))
        throw Refusal(kBroken, file + ": row " + std::to_string(row) + " lacks a part that each line has");
      const auto known = folder.lines.find(row);
      if (is_settled(line)) {
        const std::string& before = settled_in[row];
        if (!before.empty() && before != file && is_settled(known->second) &&
            known->second.at("key") != line.at("key"))
          folder.conflicts.insert(row);
        settled_in[row] = file;
      }
      if (known == folder.lines.end() || !stays(known->second, line)) folder.lines[row] = std::move(line);
    });
  }
  return folder;
}

Json without_cost(Json line) {
  line.erase("cost");
  return line;
}

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.is_null() ? "" : value.dump();
}

std::string joined(const Json& list) {
  std::string all;
  for (const Json& part : list) all += (all.empty() ? "" : ";") + part.get<std::string>();
  return all;
}

std::string text_of(const Figure& figure) {
  if (const auto* text = std::get_if<std::string>(&figure.second))
    return files::csv_field(files::no_formula(*text));
  return fmt::format("{}", std::get<double>(figure.second));
}

}  // namespace

std::vector<Figure> figures_of(const Json& result) {
  std::vector<Figure> figures;
  add("", result, figures);
  return figures;
}

Table read_table(std::vector<std::string> folders) {
  std::sort(folders.begin(), folders.end());
  folders.erase(std::unique(folders.begin(), folders.end()), folders.end());
  Table table;
  std::string first, manifest, build;
  for (const std::string& path : folders) {
    const std::optional<Folder> folder = read_folder(path);
    if (!folder) {
      table.not_begun.push_back(path);
      continue;
    }
    const std::size_t rows = folder->description["rows"];
    const std::string its_manifest = folder->description.value("manifest_identity", ""),
                      its_build = folder->description.value("build", "");
    if (first.empty()) {
      first = path;
      manifest = its_manifest;
      build = its_build;
      table.rows = rows;
    }
    if (rows != table.rows)
      throw Refusal(kBroken,
                    fmt::format("{} is of a manifest of {} rows, others of {}", path, rows, table.rows));
    if (its_manifest != manifest)
      throw Refusal(kBroken, fmt::format("{} is of another manifest than {}", path, first));
    if (its_build != build)
      throw Refusal(kBroken,
                    fmt::format("{} is of another build than {}: run both with the same", path, first));
    table.conflicts.insert(table.conflicts.end(), folder->conflicts.begin(), folder->conflicts.end());
    for (const auto& [row, line] : folder->lines) {
      const auto [kept, fresh] = table.lines.try_emplace(row, line);
      if (fresh || stays(kept->second, line)) continue;
      if (stays(line, kept->second))
        kept->second = line;
      else if (without_cost(kept->second) != without_cost(line))
        table.conflicts.push_back(row);
    }
  }
  if (first.empty())
    throw Refusal(kBroken, folders.front() + " has no batch.json: it is not a folder of fit_batch");
  std::map<std::string, std::vector<std::size_t>> rows_of;
  for (std::size_t row = 1; row <= table.rows; ++row) {
    const auto found = table.lines.find(row);
    if (found == table.lines.end()) {
      table.missing.push_back(row);
    } else if (const std::string key = found->second["key"]; !key.empty()) {
      rows_of[key].push_back(row);
    }
  }
  for (const auto& [key, rows] : rows_of)
    if (rows.size() > 1) table.doubles[key] = rows;
  return table;
}

std::string table_csv(const Table& table) {
  std::vector<std::string> columns;
  std::map<std::size_t, std::map<std::string, std::string>> cells;
  std::set<std::string> known;
  for (const auto& [row, line] : table.lines)
    for (const Figure& figure : figures_of(line.value("result", Json::object()))) {
      if (known.insert(figure.first).second) columns.push_back(figure.first);
      cells[row][figure.first] = text_of(figure);
    }
  std::sort(columns.begin(), columns.end());
  std::string text = "row,name,inputs,settings,subject,key,version,build,status,reason,message";
  for (const std::string& column : columns) text += "," + files::csv_field(column);
  text += "\n";
  for (const auto& [row, line] : table.lines) {
    const Json reason = line.value("reason", Json());
    text += std::to_string(row);
    for (const std::string& field :
         {text_of(line["name"]), joined(line["inputs"]), line["settings"].dump(), text_of(line["subject"]),
          text_of(line["key"]), text_of(line["version"]), text_of(line["build"]), text_of(line["status"]),
          reason.is_object() ? text_of(reason["code"]) : "",
          reason.is_object() ? text_of(reason["message"]) : ""})
      text += "," + files::csv_field(files::no_formula(field));
    for (const std::string& column : columns) text += "," + cells[row][column];
    text += "\n";
  }
  return text;
}

std::string costs_csv(const Table& table) {
  constexpr const char* kStages[] = {"reconstruction", "body_model", "landmarks",
                                     "control_mesh",   "tensegric",  "tffd"};
  std::string text = "row,seconds,cpu_seconds,peak_MB";
  for (const char* stage : kStages) text += std::string(",") + stage + "_ms";
  text += "\n";
  for (const auto& [row, line] : table.lines) {
    const Json cost = line.value("cost", Json::object()), stages = cost.value("stages", Json::object());
    text += std::to_string(row);
    for (const char* name : {"seconds", "cpu_seconds", "peak_MB"})
      text += "," + (cost.contains(name) ? fmt::format("{:.6g}", cost[name].get<double>()) : "");
    for (const char* stage : kStages)
      text += "," + (stages.contains(stage) ? fmt::format("{:.6g}", stages[stage].get<double>()) : "");
    text += "\n";
  }
  return text;
}

}  // namespace tensegric_fit::batch
