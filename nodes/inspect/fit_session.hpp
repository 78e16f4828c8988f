/// What a clerk does with a garment: its lines, regions, steps back.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace tensegric_fit::inspect {

/// A line as it is asked for.
struct AskedLine {
  std::string name;
  double ratio;        ///< neutral length / length at rest
  std::string region;  ///< of the control mesh, empty where it is not known
};

/// A garment as it is asked for. Lines of regions that are off are kept here, and not worn.
struct Wish {
  std::string garment;
  std::vector<AskedLine> lines;
  std::set<std::string> off;

  std::vector<AskedLine> worn() const;
  /// Of all lines, each once, in order of the lines.
  std::vector<std::string> regions() const;
};

/// The newest wish and those before it. Changes of one line are one step until settle() is called: a slider
/// that is dragged is taken back at once.
class FitSession {
 public:
  /// The limits of what a clerk may ask for; what the solver takes is wider.
  static constexpr double kLeast = 0.5, kMost = 1.2;

  const Wish& now() const { return now_; }

  /// What is worn, as somebody else, a service call or the pipeline itself says it. The same lines keep the
  /// regions that are off; no change is no step, and a garment whose ratios are no numbers is ignored.
  /// True where something changed.
  bool adopt(const std::string& garment, const std::vector<AskedLine>& worn);

  /// Brought within the limits; where sides are linked, the same line of the other side (..._L, ..._R) goes
  /// along. A line that is not there, or no number: no change. True where it changed.
  bool ask(const std::string& line, double ratio);
  void link_sides(bool linked) { linked_ = linked; }
  bool has_pairs() const;
  void settle() { dragged_.clear(); }

  /// False, and no change: the last region that is on, or one that is not there.
  bool switch_region(const std::string& region, bool on);

  bool can_undo() const { return !before_.empty(); }
  bool undo();
  /// What was undone, until something else is changed.
  bool can_redo() const { return !after_.empty(); }
  bool redo();
  /// They were the last customer's; what is worn stays.
  void forget_steps();

  /// Which region each line is in, once that is known. No step.
  void place(const std::map<std::string, std::string>& region_of_line);

  /// Length at rest, metres, as the fit says it; nothing is known of a line until then.
  void set_length(const std::string& line, double metres);
  /// Metres, 0 where its length is not known.
  double length(const std::string& line) const;
  void forget_lengths() { lengths_.clear(); }

 private:
  void step();
  bool go_to_last(std::vector<Wish>& from, std::vector<Wish>& keep);

  Wish now_;
  std::vector<Wish> before_, after_;  // the nearest last
  bool linked_ = true;
  std::string dragged_;
  std::map<std::string, double> lengths_;
};

}  // namespace tensegric_fit::inspect
