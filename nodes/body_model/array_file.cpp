#include "body_model/array_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "geometry/checksum.hpp"

namespace tensegric_fit::body_model {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLongestHeader = 1 << 20;  // bytes
constexpr std::size_t kLargestArray = 1 << 26;   // bytes

const std::map<std::string, std::size_t> kSizes = {
    {"float32", 4}, {"int16", 2}, {"uint16", 2}, {"int8", 1}, {"uint8", 1}};

/// Numbers of an array as doubles. Files are little-endian, as every machine is that the product runs on.
std::vector<double> as_doubles(const std::string& type, const std::string& bytes) {
  std::vector<double> result;
  const auto take = [&](auto zero) {
    using Type = decltype(zero);
    const auto* data = reinterpret_cast<const Type*>(bytes.data());
    result.assign(data, data + bytes.size() / sizeof(Type));
  };
  if (type == "float32") take(0.0F);
  if (type == "int16") take(std::int16_t{});
  if (type == "uint16") take(std::uint16_t{});
  if (type == "int8") take(std::int8_t{});
  if (type == "uint8") take(std::uint8_t{});
  return result;
}

/// Of all bytes of the file, which is read to its end.
std::string checksum_of(std::istream& file) {
  std::uint64_t value = geometry::kEmptyChecksum;
  std::vector<char> bytes(1 << 16);
  while (file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) || file.gcount() > 0)
    value = geometry::checksum(value, bytes.data(), static_cast<std::size_t>(file.gcount()));
  std::ostringstream text;
  text << std::hex << std::setw(16) << std::setfill('0') << value;
  return text.str();
}

}  // namespace

ArrayFile::ArrayFile(const std::string& path, const std::string& magic, const std::string& kind)
    : path_(path) {
  const Check check{path_};
  std::ifstream file(path, std::ios::binary);
  check(file.good(), "cannot be read");
  checksum_ = checksum_of(file);
  file.clear();
  file.seekg(0);
  std::string first, length;
  std::getline(file, first);
  check(first == magic, "not a " + kind + " of this format");
  std::getline(file, length);
  check(!length.empty() && length.size() < 8 && length.find_first_not_of("0123456789") == std::string::npos &&
            std::stoul(length) <= kLongestHeader,
        "length of the header");
  std::string text(std::stoul(length), '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  try {
    header_ = Json::parse(text);
    read_arrays(file);
  } catch (const Json::exception& error) {
    check(false, error.what());
  }
}

void ArrayFile::read_arrays(std::istream& file) {
  const Check check{path_};
  for (const Json& entry : header_.at("arrays")) {
    Array array{entry.at("type"), entry.at("shape"), {}};
    check(kSizes.count(array.type) > 0, "array of an unknown type");
    std::size_t bytes = kSizes.at(array.type);
    for (const std::size_t extent : array.shape) {
      check(extent <= kLargestArray && bytes * extent <= kLargestArray, "an array is too large");
      bytes *= extent;
    }
    array.bytes.resize(bytes);
    file.read(array.bytes.data(), static_cast<std::streamsize>(bytes));
    check(static_cast<std::size_t>(file.gcount()) == bytes, "truncated");
    arrays_[entry.at("name")] = std::move(array);
  }
  check(file.peek() == std::char_traits<char>::eof(), "bytes after the last array");
}

std::vector<double> ArrayFile::numbers(const std::string& name, const std::vector<std::size_t>& shape) const {
  const Check check{path_};
  check(arrays_.count(name) > 0, "no array '" + name + "'");
  const Array& found = arrays_.at(name);
  check(found.shape.size() == shape.size(), "shape of '" + name + "'");
  for (std::size_t i = 0; i < shape.size(); ++i)
    check(shape[i] == 0 || found.shape[i] == shape[i], "shape of '" + name + "'");
  const std::vector<double> values = as_doubles(found.type, found.bytes);
  check(
      !values.empty() && std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }),
      "'" + name + "' is empty or not finite");
  return values;
}

std::vector<Eigen::Vector3d> points(const std::vector<double>& xyz) {
  std::vector<Eigen::Vector3d> result(xyz.size() / 3);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
  return result;
}

}  // namespace tensegric_fit::body_model
