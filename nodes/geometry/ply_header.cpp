#include "geometry/ply_header.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <vector>

#include "geometry/status.hpp"

namespace tensegric_fit::geometry {
namespace {

using Words = std::vector<std::string>;

struct Property {
  std::string name;
  bool is_list;
  int bytes;  // of a number; of a list's length
};

struct Element {
  std::string name;
  std::uint64_t count;
  std::vector<Property> properties;
};

int bytes_of(const std::string& type) {
  static const std::map<std::string, int> kBytes = {
      {"char", 1},  {"uchar", 1},  {"short", 2},   {"ushort", 2}, {"int", 4},   {"uint", 4},
      {"float", 4}, {"double", 8}, {"int8", 1},    {"uint8", 1},  {"int16", 2}, {"uint16", 2},
      {"int32", 4}, {"uint32", 4}, {"float32", 4}, {"float64", 8}};
  const auto found = kBytes.find(type);
  return found == kBytes.end() ? 0 : found->second;
}

class Header {
 public:
  explicit Header(const std::string& path) : path_(path) {}

  void check() {
    std::error_code none;
    if (!std::filesystem::is_regular_file(path_, none)) throw fault("does not exist or is no regular file");
    std::ifstream file(path_, std::ios::binary);
    std::string line;
    if (!std::getline(file, line) || (line != "ply" && line != "ply\r")) throw fault("is not a PLY file");
    ends_in_return_ = line.back() == '\r';
    constexpr int kMostLines = 1000;
    for (int i = 0; i < kMostLines && std::getline(file, line); ++i) {
      const Words words = words_of(line);
      if (words == Words{"end_header"}) return check_size(std::filesystem::file_size(path_) - file.tellg());
      if (!words.empty()) take(words);
    }
    throw fault("has no complete PLY header");
  }

  std::uint64_t faces() const {
    std::uint64_t faces = 0;
    for (const Element& element : elements_)
      if (element.name == "face" || element.name == "tristrips") faces += element.count;
    return faces;
  }

 private:
  Refusal fault(const std::string& what) const { return {refusal::kBrokenFile, path_ + ": " + what}; }
  Refusal fault_in(const Words& words) const {
    return fault("has a line in its PLY header that is not understood, '" + words.front() + " ...'");
  }

  Words words_of(std::string line) const {
    if (ends_in_return_) {
      if (line.empty() || line.back() != '\r')
        throw fault("has lines in its PLY header that end in another way");
      line.pop_back();
    }
    const auto is_odd = [](unsigned char c) { return c < ' ' && c != '\t'; };
    if (std::any_of(line.begin(), line.end(), is_odd) ||
        (!line.empty() && (line[0] == ' ' || line[0] == '\t')))
      throw fault("has a line in its PLY header that begins with a blank or has control characters");
    std::istringstream stream(line);
    return {std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>()};
  }

  void take(const Words& words) {
    if (words[0] == "comment") return;
    if (words[0] == "obj_info") {
      if (words.size() > 1 && (words[1] == "num_cols" || words[1] == "num_rows"))
        throw fault("is a range grid");
    } else if (words[0] == "format" && words.size() == 3 && format_.empty() && elements_.empty()) {
      format_ = words[1];
    } else if (words[0] == "element" && words.size() == 3) {
      take_element(words);
    } else if (words[0] == "property" && !elements_.empty()) {
      take_property(words);
    } else {
      throw fault_in(words);
    }
  }

  void take_element(const Words& words) {
    const std::string& digits = words[2];
    constexpr std::size_t kMostDigits = 12;  // more than any file holds
    if (digits.size() > kMostDigits || digits.find_first_not_of("0123456789") != std::string::npos)
      throw fault_in(words);
    if (words[1] == "range_grid") throw fault("is a range grid");
    for (const Element& other : elements_)
      if (other.name == words[1]) throw fault("has the element " + words[1] + " twice");
    elements_.push_back({words[1], std::stoull(digits), {}});
  }

  void take_property(const Words& words) {
    Element& element = elements_.back();
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (!is_list && words.size() != 3) throw fault_in(words);
    if (is_list && element.name == "vertex") throw fault("has a list among the properties of its vertices");
    for (std::size_t type = is_list ? 2 : 1; type + 1 < words.size(); ++type)
      if (bytes_of(words[type]) == 0) throw fault_in(words);
    const Property property{words.back(), is_list, bytes_of(words[is_list ? 2 : 1])};
    for (const Property& other : element.properties)
      if (other.name == property.name) throw fault("has the property " + property.name + " twice");
    if (element.name == "vertex") check_colour(element.properties, property.name);
    element.properties.push_back(property);
  }

  /// PCL packs a colour into one field, and counts on this order.
  void check_colour(const std::vector<Property>& before, const std::string& name) const {
    const auto is = [](const std::string& property, const std::string& colour) {
      return property == colour || property == "diffuse_" + colour;
    };
    const auto last_is = [&](const std::string& colour) {
      return !before.empty() && is(before.back().name, colour);
    };
    const bool has_red =
        std::any_of(before.begin(), before.end(), [&](const Property& p) { return is(p.name, "red"); });
    if ((is(name, "red") && has_red) || (is(name, "green") && !last_is("red")) ||
        (is(name, "blue") && !last_is("green")) || (name == "alpha" && !last_is("blue")) ||
        (last_is("red") && !is(name, "green")) || (last_is("green") && !is(name, "blue")))
      throw fault("has colours in another order than red, green, blue, alpha");
  }

  /// The header must not promise more than the bytes after it can hold.
  void check_size(std::uint64_t rest) const {
    if (format_ != "ascii" && format_ != "binary_little_endian" && format_ != "binary_big_endian")
      throw fault("has a PLY format that is not known");
    std::uint64_t least = 0;
    for (const Element& element : elements_) {
      if (element.count == 0) continue;
      if (element.properties.empty()) throw fault("has an element without properties");
      std::uint64_t bytes = 0;
      for (const Property& property : element.properties)
        bytes += format_ == "ascii" ? 2 : property.bytes;  // a digit, a blank
      least += element.count * bytes;                      // below 2^40 times 2^13, 1000 times at most
    }
    if (format_ == "ascii") ++rest;  // the last blank may lack
    if (least > rest) throw fault("is shorter than its header says");
  }

  const std::string path_;
  bool ends_in_return_ = false;
  std::string format_;
  std::vector<Element> elements_;
};

}  // namespace

std::uint64_t check_ply_header(const std::string& path) {
  Header header(path);
  header.check();
  return header.faces();
}

}  // namespace tensegric_fit::geometry
