#include "batch/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "files/csv.hpp"
#include "fit/command_line.hpp"
#include "geometry/json_text.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::batch {
namespace {

namespace fs = std::filesystem;
using geometry::Refusal;
using UnorderedJson = nlohmann::json;

enum class Kind { path, paths, word, words, flag };

/// A path is relative to the manifest; so is a garment with a slash or .yaml, others are shipped ones.
const std::map<std::string, Kind>& columns() {
  static const std::map<std::string, Kind> all{
      {"scan", Kind::paths},          {"mesh", Kind::path},
      {"unit", Kind::word},           {"up", Kind::word},
      {"garment", Kind::word},        {"ratio", Kind::words},
      {"band", Kind::word},           {"templates", Kind::path},
      {"tissue", Kind::path},         {"solver", Kind::word},
      {"volume", Kind::word},         {"control_triangles", Kind::word},
      {"body_triangles", Kind::word}, {"bust_only", Kind::flag},
      {"twist", Kind::word},          {"lean", Kind::word}};
  return all;
}

class Reader {
 public:
  explicit Reader(const std::string& file) : file_(file), folder_(fs::absolute(file).parent_path()) {}

  std::vector<Job> operator()() {
    std::ifstream stream(file_, std::ios::binary);
    if (!stream) throw fault("cannot be read");
    const std::string kind = fs::path(file_).extension();
    if (kind == ".csv") {
      read_csv(stream);
    } else if (kind == ".jsonl") {
      read_lines(stream);
    } else {
      throw fault("is neither .csv nor .jsonl");
    }
    if (jobs_.empty()) throw fault("has no row");
    return std::move(jobs_);
  }

 private:
  Refusal fault(const std::string& what) const {
    return Refusal(geometry::refusal::kBrokenFile, "manifest " + file_ + ": " + what);
  }
  Refusal fault_here(const std::string& what) const { return fault(fmt::format("line {}: {}", line_, what)); }

  void read_csv(std::istream& stream) {
    std::vector<std::string> names, fields;
    for (line_ = 1; read_row(stream, fields); ++line_) {
      if (fields.size() == 1 && fields[0].empty()) continue;
      for (const std::string& field : fields)
        if (!is_text(field)) throw fault_here("is not UTF-8");
      if (names.empty()) {
        names = fields;
        check_names(names);
        continue;
      }
      if (fields.size() != names.size())
        throw fault_here(fmt::format("has {} fields, the first line {}", fields.size(), names.size()));
      Job job;
      for (std::size_t i = 0; i < names.size(); ++i) add(job, names[i], split(names[i], fields[i]));
      take(std::move(job));
    }
  }

  bool read_row(std::istream& stream, std::vector<std::string>& fields) {
    const std::size_t first = line_;
    try {
      return files::read_csv_row(stream, fields, line_);
    } catch (const files::CsvFault& wrong) {
      line_ = first;
      throw fault_here(wrong.what());
    }
  }

  /// UTF-8: workers are given it as JSON.
  static bool is_text(const std::string& field) {
    try {
      UnorderedJson(field).dump();
      return true;
    } catch (const UnorderedJson::type_error&) {
      return false;
    }
  }

  void check_names(const std::vector<std::string>& names) const {
    for (std::size_t i = 0; i < names.size(); ++i) {
      check_name(names[i]);
      if (std::find(names.begin(), names.begin() + static_cast<long>(i), names[i]) !=
          names.begin() + static_cast<long>(i))
        throw fault_here("column '" + names[i] + "' is there twice");
    }
  }

  void check_name(const std::string& name) const {
    if (name != "name" && columns().count(name) == 0) throw fault_here("there is no column '" + name + "'");
  }

  static std::vector<std::string> split(const std::string& name, const std::string& field) {
    if (field.empty()) return {};
    const bool many =
        name != "name" && (columns().at(name) == Kind::paths || columns().at(name) == Kind::words);
    if (!many) return {field};
    std::vector<std::string> parts;
    std::stringstream stream(field);
    for (std::string part; std::getline(stream, part, ';');) parts.push_back(part);
    return parts;
  }

  void read_lines(std::istream& stream) {
    line_ = 0;
    for (std::string text; std::getline(stream, text);) {
      ++line_;
      if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
      const UnorderedJson object = geometry::json_in(text);
      if (!object.is_object()) throw fault_here("is no JSON object, or is nested too deeply");
      Job job;
      for (const auto& [name, value] : object.items()) {
        check_name(name);
        add(job, name, words_of(name, value));
      }
      check_keys_once(text);
      take(std::move(job));
    }
  }

  /// Of a row that was read: an object of words, numbers and lists of them. The last of two counts for the
  /// parser.
  void check_keys_once(const std::string& text) const {
    std::set<std::string> names;
    std::string twice;
    const auto note = [&](int, UnorderedJson::parse_event_t event, const UnorderedJson& parsed) {
      if (event == UnorderedJson::parse_event_t::key && !names.insert(parsed.get<std::string>()).second)
        twice = parsed.get<std::string>();
      return true;
    };
    if (UnorderedJson::parse(text, note).is_object() && !twice.empty())
      throw fault_here("'" + twice + "' is there twice");
  }

  std::vector<std::string> words_of(const std::string& name, const UnorderedJson& value) const {
    if (!value.is_array()) return {word_of(name, value)};
    std::vector<std::string> words;
    for (const UnorderedJson& part : value) words.push_back(word_of(name, part));
    return words;
  }

  std::string word_of(const std::string& name, const UnorderedJson& value) const {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return value.dump();
    if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
    throw fault_here("'" + name + "' is no text, number or list of them");
  }

  void add(Job& job, const std::string& name, std::vector<std::string> words) const {
    if (words.empty()) return;
    const Kind kind = name == "name" ? Kind::word : columns().at(name);
    if (kind != Kind::paths && kind != Kind::words && words.size() != 1)
      throw fault_here("'" + name + "' has several values");
    if (name == "name") {
      job.name = words.front();
      return;
    }
    if (kind == Kind::flag) {
      if (words[0] == "false" || words[0] == "0") return;
      if (words[0] != "true" && words[0] != "1") throw fault_here("'" + name + "' is neither true nor false");
      words.clear();
    }
    if (kind == Kind::path || kind == Kind::paths)
      for (std::string& word : words) word = path_of(word);
    if (name == "garment") words[0] = garment_of(words[0]);
    job.options[name] = std::move(words);
  }

  std::string path_of(const std::string& word) const { return (folder_ / word).lexically_normal().string(); }

  std::string garment_of(const std::string& word) const {
    const auto is_file = [](const std::string& part) {  // as for `fit`
      return part.find('/') != std::string::npos || fs::path(part).extension() == ".yaml";
    };
    std::error_code error;
    if (is_file(word) && fs::is_regular_file(folder_ / word, error)) return path_of(word);  // may have a +
    std::string all;
    for (const std::string& part : geometry::joined_words(word))
      all += (all.empty() ? "" : "+") + (is_file(part) ? path_of(part) : part);
    return all;
  }

  /// `fit` itself says what is wrong with the options of a row.
  void take(Job job) {
    fit::CommandLine line;
    std::ostringstream errors;
    if (fit::parse(job.arguments(), line, errors)) {
      std::string text = errors.str();
      throw fault_here(text.substr(0, text.find('\n')));
    }
    if (jobs_.size() == kMostRows) throw fault(fmt::format("has more than {} rows", kMostRows));
    job.row = jobs_.size() + 1;
    jobs_.push_back(std::move(job));
  }

  std::string file_;
  fs::path folder_;
  std::size_t line_ = 0;
  std::vector<Job> jobs_;
};

}  // namespace

std::vector<std::string> Job::inputs() const {
  for (const char* kind : {"scan", "mesh"})
    if (const auto found = options.find(kind); found != options.end()) return found->second;
  return {};
}

std::vector<std::string> Job::arguments() const {
  std::vector<std::string> words;
  for (const auto& [column, values] : options) {
    std::string option = "--" + column;
    std::replace(option.begin(), option.end(), '_', '-');
    if (values.empty()) words.push_back(option);
    for (const std::string& value : values) words.push_back(option + "=" + value);
  }
  return words;
}

std::vector<Job> read_manifest(const std::string& file) {
  return Reader(file)();
}

}  // namespace tensegric_fit::batch
