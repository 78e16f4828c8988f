#include "geometry/checked_yaml.hpp"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <string_view>

namespace tensegric_fit::geometry {

namespace {

constexpr std::uintmax_t kLargest = 8 << 20;  // bytes; a template of thousands of nodes has one million
constexpr int kMostNodes = 1'000'000;         // with each alias counted as what it stands for
constexpr int kDeepest = 64;

/// A few lines of aliases of aliases can stand for more than any memory holds, or for themselves.
class NodeCount {
 public:
  bool is_too_much(const YAML::Node& node, int depth = 0) {
    if (depth > kDeepest || ++count_ > kMostNodes) return true;
    if (node.IsSequence())
      return std::any_of(node.begin(), node.end(),
                         [&](const auto& entry) { return is_too_much(entry, depth + 1); });
    return node.IsMap() && std::any_of(node.begin(), node.end(), [&](const auto& entry) {
             return is_too_much(entry.first, depth + 1) || is_too_much(entry.second, depth + 1);
           });
  }

 private:
  int count_ = 0;
};

/// Reads over a document.
struct PassedOver : YAML::EventHandler {
  using Mark = YAML::Mark;
  using Anchor = YAML::anchor_t;
  using Style = YAML::EmitterStyle::value;

  bool has_content = false;  // other than nothing at all, or null

  void OnDocumentStart(const Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const Mark&, Anchor) override {}
  void OnAlias(const Mark&, Anchor) override { has_content = true; }
  void OnScalar(const Mark&, const std::string&, Anchor, const std::string&) override { has_content = true; }
  void OnSequenceStart(const Mark&, const std::string&, Anchor, Style) override { has_content = true; }
  void OnSequenceEnd() override {}
  void OnMapStart(const Mark&, const std::string&, Anchor, Style) override { has_content = true; }
  void OnMapEnd() override {}
};

/// Is there anything behind the first document but an empty one, as a last '---' makes? LoadFile does not
/// look, and LoadAllFromFile may never end: of "{a: 1}," it makes one empty document after the other.
bool goes_on(const std::string& path) {
  std::ifstream file(path);
  YAML::Parser parser(file);
  PassedOver first, second;
  return parser.HandleNextDocument(first) && parser.HandleNextDocument(second) &&
         (second.has_content || bool(parser));
}

}  // namespace

YAML::Node load_yaml_map(const std::string& path, const std::string& code) {
  std::error_code error_code;
  if (!std::filesystem::is_regular_file(path, error_code)) throw Refusal(code, path + ": cannot be read");
  if (std::filesystem::file_size(path, error_code) > kLargest)
    throw Refusal(code, path + ": is larger than 8 MB");
  YAML::Node root;
  try {
    root = YAML::LoadFile(path);
    if (NodeCount().is_too_much(root))
      throw Refusal(code, path + ": has more than a million entries, or is nested too deeply");
    if (goes_on(path)) throw Refusal(code, path + ": has a second YAML document, which nothing reads");
  } catch (const YAML::BadFile&) {
    throw Refusal(code, path + ": cannot be read");
  } catch (const YAML::Exception& error) {
    throw Refusal(code, path + ": not YAML: " + error.what());
  }
  if (!root.IsMap()) throw Refusal(code, path + ": is not a YAML map");
  return root;
}

void check_keys(const YAML::Node& map, const std::vector<const char*>& known, const std::string& where,
                const std::string& code) {
  if (!map.IsMap()) throw Refusal(code, where + ": must be a map");
  std::set<std::string> met;
  for (const auto& entry : map) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "(not a scalar)";
    const bool is_known =
        std::any_of(known.begin(), known.end(), [&key](std::string_view k) { return k == key; });
    if (!is_known) throw Refusal(code, where + ": unknown key '" + key + "'");
    if (!met.insert(key).second) throw Refusal(code, where + ": key '" + key + "' is given twice");
  }
}

double number_in(const YAML::Node& map, const char* key, double low, double high, const std::string& where,
                 const std::string& code) {
  const double value = required<double>(map, key, where, code);
  if (!(value >= low && value <= high))
    throw Refusal(code, where + ": '" + key + "' is " + map[key].Scalar() + ", outside [" +
                            std::to_string(low) + ", " + std::to_string(high) + "]");
  return value;
}

}  // namespace tensegric_fit::geometry
