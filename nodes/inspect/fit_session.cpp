#include "inspect/fit_session.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace tensegric_fit::inspect {
namespace {

constexpr std::size_t kKeptSteps = 200;  // that are kept
constexpr double kSame = 1e-9;           // ratio

bool same(const Wish& one, const Wish& other) {
  return one.garment == other.garment && one.off == other.off &&
         std::equal(one.lines.begin(), one.lines.end(), other.lines.begin(), other.lines.end(),
                    [](const AskedLine& a, const AskedLine& b) {
                      return a.name == b.name && std::abs(a.ratio - b.ratio) < kSame;
                    });
}

AskedLine* find(std::vector<AskedLine>& lines, const std::string& name) {
  const auto line = std::find_if(lines.begin(), lines.end(), [&](const auto& l) { return l.name == name; });
  return line == lines.end() ? nullptr : &*line;
}

// Empty where the line is of neither side.
std::string on_the_other_side(std::string line) {
  if (line.size() < 2 || line[line.size() - 2] != '_') return "";
  char& side = line.back();
  if (side != 'L' && side != 'R') return "";
  side = side == 'L' ? 'R' : 'L';
  return line;
}

// Into the garment that is known already; lines that are not worn are those of regions that are off. False
// where that is not so.
bool take_ratios(const std::string& garment, const std::vector<AskedLine>& worn, Wish& wish) {
  if (garment != wish.garment || worn.empty()) return false;
  std::set<std::string> names;
  for (const AskedLine& line : worn) {
    AskedLine* known = find(wish.lines, line.name);
    if (known == nullptr) return false;
    known->ratio = line.ratio;
    names.insert(line.name);
  }
  wish.off.clear();
  for (const AskedLine& line : wish.lines)
    if (names.count(line.name) == 0) wish.off.insert(line.region);
  return wish.off.count("") == 0 && wish.worn().size() == worn.size();
}

}  // namespace

std::vector<AskedLine> Wish::worn() const {
  std::vector<AskedLine> worn;
  std::copy_if(lines.begin(), lines.end(), std::back_inserter(worn),
               [this](const AskedLine& line) { return off.count(line.region) == 0; });
  return worn;
}

std::vector<std::string> Wish::regions() const {
  std::vector<std::string> regions;
  for (const AskedLine& line : lines)
    if (!line.region.empty() && std::find(regions.begin(), regions.end(), line.region) == regions.end())
      regions.push_back(line.region);
  return regions;
}

void FitSession::step() {
  after_.clear();
  before_.push_back(now_);
  if (before_.size() > kKeptSteps) before_.erase(before_.begin());
  dragged_.clear();
}

bool FitSession::adopt(const std::string& garment, const std::vector<AskedLine>& worn) {
  if (!std::all_of(worn.begin(), worn.end(), [](const AskedLine& line) { return std::isfinite(line.ratio); }))
    return false;
  Wish wish = now_;
  if (!take_ratios(garment, worn, wish)) {
    wish = {garment, worn, {}};
    forget_lengths();
  }
  if (same(wish, now_)) return false;
  if (!now_.lines.empty()) step();
  now_ = std::move(wish);
  return true;
}

bool FitSession::ask(const std::string& line, double ratio) {
  AskedLine* asked = find(now_.lines, line);
  if (asked == nullptr || !std::isfinite(ratio)) return false;
  ratio = std::clamp(ratio, kLeast, kMost);
  if (std::abs(asked->ratio - ratio) < kSame) return false;
  if (dragged_ != line) step();
  dragged_ = line;
  asked->ratio = ratio;
  if (AskedLine* other = linked_ ? find(now_.lines, on_the_other_side(line)) : nullptr) other->ratio = ratio;
  return true;
}

bool FitSession::has_pairs() const {
  return std::any_of(now_.lines.begin(), now_.lines.end(), [this](const AskedLine& line) {
    const std::string other = on_the_other_side(line.name);
    return std::any_of(now_.lines.begin(), now_.lines.end(),
                       [&other](const AskedLine& each) { return each.name == other; });
  });
}

bool FitSession::switch_region(const std::string& region, bool on) {
  const std::vector<std::string> regions = now_.regions();
  if (std::find(regions.begin(), regions.end(), region) == regions.end()) return false;
  Wish changed = now_;
  if (on)
    changed.off.erase(region);
  else
    changed.off.insert(region);
  if (changed.off == now_.off || changed.worn().empty()) return false;
  step();
  now_ = std::move(changed);
  return true;
}

bool FitSession::go_to_last(std::vector<Wish>& from, std::vector<Wish>& keep) {
  if (from.empty()) return false;
  if (from.back().garment != now_.garment) forget_lengths();
  keep.push_back(std::move(now_));
  now_ = std::move(from.back());
  from.pop_back();
  dragged_.clear();
  return true;
}

bool FitSession::undo() {
  return go_to_last(before_, after_);
}

bool FitSession::redo() {
  return go_to_last(after_, before_);
}

void FitSession::forget_steps() {
  before_.clear();
  after_.clear();
  dragged_.clear();
}

void FitSession::place(const std::map<std::string, std::string>& region_of_line) {
  for (AskedLine& line : now_.lines)
    if (const auto found = region_of_line.find(line.name); found != region_of_line.end())
      line.region = found->second;
}

void FitSession::set_length(const std::string& line, double metres) {
  if (metres > 0 && std::isfinite(metres)) lengths_[line] = metres;
}

double FitSession::length(const std::string& line) const {
  const auto found = lengths_.find(line);
  return found == lengths_.end() ? 0 : found->second;
}

}  // namespace tensegric_fit::inspect
