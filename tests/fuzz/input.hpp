/// Values made of a fuzz target's bytes.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

namespace tensegric_fit::fuzz {

/// Numbers from the front of the input; zeros at its end.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  std::uint32_t number(std::size_t bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes && size_ > 0; ++i, ++data_, --size_) value = value << 8 | *data_;
    return value;
  }

  /// Small or of any size: both happen.
  std::uint32_t any() { return number(1) % 4 != 0 ? number(1) % 65 : number(4); }

  /// Usual, extreme, and no numbers.
  double real() {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN(),
                     kEndless = std::numeric_limits<double>::infinity();
    constexpr std::array<double, 12> kExtremes{0.0,   -0.0, 1.0,     -1.0,   kNone,  kEndless,
                                               1e300, 1e38, -1e-300, 5e-324, 0.9999, 1e9};
    if (number(1) % 2 != 0) return kExtremes[number(1) % kExtremes.size()];
    return (number(2) - 32768.0) / 8192.0;
  }

  std::vector<std::uint8_t> rest() const { return {data_, data_ + size_}; }
  bool at_end() const { return size_ == 0; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

template <typename T>
void draw(Input& input, T& value) {
  if constexpr (std::is_floating_point_v<T>)
    value = static_cast<T>(input.real());
  else
    value = static_cast<T>(input.any());
}

/// Each of them at times.
template <typename... Numbers>
void draw_some(Input& input, Numbers&... numbers) {
  ((input.number(1) % 4 == 0 ? draw(input, numbers) : void()), ...);
}

/// An entry too few or too many, none at all, another value in one place; often nothing.
template <typename T>
void change(Input& input, std::vector<T>& values) {
  switch (input.number(1) % 8) {
    case 0:
      if (!values.empty()) values.pop_back();
      break;
    case 1:
      values.emplace_back();
      break;
    case 2:
      values.clear();
      break;
    case 3:
    case 4:
      if constexpr (std::is_arithmetic_v<T>) {
        if (!values.empty()) draw(input, values[input.number(2) % values.size()]);
      } else if (!values.empty()) {
        values.push_back(values[input.number(2) % values.size()]);  // twice
      }
      break;
    default:
      break;
  }
}

}  // namespace tensegric_fit::fuzz
