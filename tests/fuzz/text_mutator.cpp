// For targets whose inputs are text after a first byte, which chooses what is read: whole lines and words
// change, so that inputs stay near enough to sound ones to get beyond the grammar. Every third change is one
// of libFuzzer's own.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

constexpr std::array<const char*, 30> kWords{
    "0",      "1",    "2",      "3",   "-1",  "0.5",        "0.95",  "1.5",  "1e300", "-1e300",
    "1e-300", ".nan", "nan",    "inf", "-0",  "''",         "true",  "null", "false", "[]",
    "{}",     "[1]",  "[1, 2]", "a",   "a_L", "4294967295", "99999", "~",    "[[1]]", " "};
constexpr const char* kBetween = " \t\r\n,;:[]{}\"'";

class TextChange {
 public:
  TextChange(std::string text, unsigned seed) : text_(std::move(text)), random_(seed) {}

  std::string operator()() {
    switch (below(5)) {
      case 0:
        erase_line();
        break;
      case 1:
        repeat_line();
        break;
      case 2:
        replace_word(word_of_text());
        break;
      default:
        replace_word(kWords[below(kWords.size())]);
    }
    return text_;
  }

 private:
  using Span = std::array<std::size_t, 2>;  // begin and end

  std::size_t below(std::size_t end) { return end == 0 ? 0 : random_() % end; }

  Span line() {  // with its line end
    const std::size_t at = below(text_.size());
    const std::size_t before = at == 0 ? std::string::npos : text_.rfind('\n', at - 1);
    const std::size_t after = text_.find('\n', at);
    return {before == std::string::npos ? 0 : before + 1,
            after == std::string::npos ? text_.size() : after + 1};
  }

  void erase_line() {
    const auto [begin, end] = line();
    text_.erase(begin, end - begin);
  }

  void repeat_line() {
    const auto [begin, end] = line();
    text_.insert(below(2) == 0 ? begin : text_.size(), text_.substr(begin, end - begin));
  }

  Span word() {
    const std::size_t begin = std::min(text_.find_first_not_of(kBetween, below(text_.size())), text_.size());
    return {begin, std::min(text_.find_first_of(kBetween, begin), text_.size())};
  }

  std::string word_of_text() {
    const auto [begin, end] = word();
    return text_.substr(begin, end - begin);
  }

  void replace_word(const std::string& by) {
    const auto [begin, end] = word();
    text_.replace(begin, end - begin, by);
  }

  std::string text_;
  std::mt19937 random_;
};

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
  if (size < 2 || seed % 3 == 0) return LLVMFuzzerMutate(data, size, most);
  std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  for (unsigned change = 0; change <= seed / 3 % 3; ++change) text = TextChange(text, seed + change)();
  const std::size_t kept = std::min(text.size(), most - 1);
  std::memcpy(data + 1, text.data(), kept);
  return kept + 1;
}
