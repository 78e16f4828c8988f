#include "scan_files/pcd_file.hpp"

#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <limits>
#include <sstream>
#include <vector>

#include "geometry/status.hpp"

namespace tensegric_fit::scan_files {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

// In the order that the format asks for (PCL, "The PCD file format"). PCL takes lines in another order, twice
// or misspelt for what they resemble, and may crash then.
constexpr std::array<const char*, 10> kKeys{"VERSION", "FIELDS", "SIZE",      "TYPE",   "COUNT",
                                            "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};

struct Header {
  std::size_t fields = 0;
  std::vector<std::string> types;
  std::vector<std::uint64_t> sizes, counts;
  std::uint64_t width = 0, height = 1, points = 0;
  bool has_points = false;
  std::string data;
};

std::vector<std::string> words_of(std::istringstream& line) {
  return {std::istream_iterator<std::string>(line), std::istream_iterator<std::string>()};
}

/// False: something on the line is no number. PCL would read 0, or what stood there before.
bool take_numbers(std::istringstream& line, std::vector<std::uint64_t>& numbers) {
  // Above 2^31 no product below can be meant.
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  for (const std::string& word : words_of(line)) {
    std::istringstream digits(word);
    std::int64_t value = 0;
    if (!(digits >> value) || !digits.eof()) return false;
    numbers.push_back(value < 0 || value > most ? most : value);
  }
  return true;
}

/// False: the line is not understood.
bool take_line(const std::string& key, std::istringstream& line, Header& header) {
  if (key == "FIELDS") header.fields = words_of(line).size();
  if (key == "TYPE") header.types = words_of(line);
  if (key == "SIZE") return take_numbers(line, header.sizes);
  if (key == "COUNT") return take_numbers(line, header.counts) && !header.counts.empty();
  if (key == "DATA") line >> header.data;
  if (key != "WIDTH" && key != "HEIGHT" && key != "POINTS") return true;
  std::vector<std::uint64_t> value;
  if (!take_numbers(line, value) || value.size() != 1) return false;
  if (key == "WIDTH") header.width = value[0];
  if (key == "HEIGHT") header.height = value[0];
  if (key == "POINTS") header.points = value[0], header.has_points = true;
  return true;
}

Header read_header(std::istream& file, const std::string& path) {
  Header header;
  std::string line;
  constexpr int kHeaderLines = 1000;
  auto next = kKeys.begin();
  for (int i = 0; i < kHeaderLines && std::getline(file, line); ++i) {
    // PCL parts words at blanks, tabs and returns alone, and ends the header at a line of nothing else.
    const auto is_odd = [](unsigned char c) { return c < ' ' && c != '\t' && c != '\r'; };
    if (std::any_of(line.begin(), line.end(), is_odd)) break;
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key.empty() && !line.empty()) break;
    if (key.empty() || key[0] == '#') continue;
    const auto known = std::find(next, kKeys.end(), key);
    if (known == kKeys.end() || !take_line(key, words, header)) break;
    if (key == "DATA") return header;
    next = known + 1;
  }
  throw Refusal(refusal::kBrokenFile, path + ": has no whole PCD header");
}

// PCL goes on after DATA for as long as lines look like those of a header, and takes what they say in place
// of what stood before.
bool goes_on(std::istream& file) {
  constexpr int kLongest = 9;  // of keys: no more of a word is read
  for (std::string word; file >> std::setw(kLongest) >> word;) {
    if (word[0] != '#')
      return word.compare(0, 7, "COLUMNS") == 0 ||  // its other word for FIELDS
             std::any_of(kKeys.begin(), kKeys.end(),
                         [&word](const std::string& key) { return word.compare(0, key.size(), key) == 0; });
    file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return false;
}

// The types that the format knows, and their bytes.
bool is_type(const std::string& type, std::uint64_t bytes) {
  if (type == "F") return bytes == 4 || bytes == 8;
  return (type == "I" || type == "U") && (bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8);
}

// The header must not promise more points than the bytes after it can hold.
void check_header(const std::string& path) {
  std::error_code none;
  std::ifstream file;
  if (std::filesystem::is_regular_file(path, none)) file.open(path, std::ios::binary);
  if (!file.is_open()) throw Refusal(refusal::kBrokenFile, path + ": does not exist or cannot be read");
  Header header = read_header(file, path);
  const std::istream::pos_type data = file.tellg();
  if (goes_on(file)) throw Refusal(refusal::kBrokenFile, path + ": its PCD header goes on after DATA");
  file.clear();
  file.seekg(data);
  const std::uint64_t rest = std::filesystem::file_size(path) - static_cast<std::uint64_t>(data);
  const Refusal shorter(refusal::kBrokenFile, path + ": is shorter than its header says");

  if (header.fields == 0) throw Refusal(refusal::kBrokenFile, path + ": its PCD header names no fields");
  if (header.counts.empty()) header.counts.assign(header.sizes.size(), 1);
  for (const std::size_t entries : {header.sizes.size(), header.types.size(), header.counts.size()})
    if (entries != header.fields)
      throw Refusal(refusal::kBrokenFile,
                    path + ": its PCD header has unlike numbers of FIELDS, SIZE, TYPE and COUNT entries");
  std::uint64_t step = 0, values = 0;
  for (std::size_t f = 0; f < header.sizes.size(); ++f) {
    constexpr std::uint64_t kLargestField = 1 << 20, kLargestPoint = 1 << 24;
    if (!is_type(header.types[f], header.sizes[f]))
      throw Refusal(refusal::kBrokenFile, path + ": no PCD type '" + header.types[f] + "' has " +
                                              std::to_string(header.sizes[f]) + " bytes");
    if (header.counts[f] == 0)  // PCL removes such a field, and may be left without any
      throw Refusal(refusal::kBrokenFile, path + ": its PCD header has a field of no values");
    if (header.counts[f] > kLargestField) throw shorter;
    step += header.sizes[f] * header.counts[f];
    values += header.counts[f];
    if (step > kLargestPoint) throw shorter;  // keeps the products below in range
  }
  const std::uint64_t points = header.width * header.height;
  if (header.has_points && header.points != points)
    throw Refusal(refusal::kBrokenFile, path + ": POINTS is not WIDTH times HEIGHT");
  if (points > rest * 100) throw shorter;
  if (header.data == "binary") {
    if (points * step > rest) throw shorter;
  } else if (header.data == "binary_compressed") {
    std::uint32_t sizes[2] = {0, 0};              // compressed, uncompressed
    constexpr std::uint64_t kLargestRatio = 100;  // LZF makes at most 264 bytes of 3
    if (!file.read(reinterpret_cast<char*>(sizes), sizeof sizes) || sizes[0] > rest - sizeof sizes ||
        sizes[0] == 0 || sizes[1] != points * step || sizes[1] > kLargestRatio * sizes[0])
      throw shorter;
  } else if (header.data == "ascii") {
    if (points * values * 2 > rest + 1) throw shorter;  // a digit and a separator each
  } else {
    throw Refusal(refusal::kBrokenFile, path + ": PCD data of the unknown kind '" + header.data + "'");
  }
}

}  // namespace

pcl::PCLPointCloud2 read_pcd(const std::string& path) {
  check_header(path);
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // what it would print is in the refusal
  pcl::PCLPointCloud2 cloud;
  int result = -1;
  try {
    result = pcl::PCDReader().read(path, cloud);
  } catch (const std::exception&) {
  }
  if (result < 0) throw Refusal(refusal::kBrokenFile, path + ": is truncated or is not a PCD file");
  return cloud;
}

}  // namespace tensegric_fit::scan_files
