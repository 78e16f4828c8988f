/// What differs between two recorded runs: which topic, which field, by how much, where on the body.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "case_pictures.hpp"

namespace tensegric_fit::regression {

struct FieldDifference {
  std::string topic;
  int message = 0;                    ///< how many of the topic came before it, of the same scan
  std::string field;                  ///< girths[bust].value
  std::string one, other;             ///< short fields as they are; of long ones how many values there are
  std::size_t differing = 0, of = 0;  ///< values
  double most = 0;                    ///< largest difference of two numbers, in the field's unit
  std::size_t where = 0;              ///< number of that value
  double share = 0;                   ///< of the larger value; 1 for words and lengths
};

struct TopicDifference {
  std::string topic;
  int one = 0, other = 0;               ///< messages
  std::vector<FieldDifference> fields;  ///< those that differ, the largest share first
};

/// A piece of skin: signed distance of the first run's vertices to the second's surface, positive where the
/// second lies outside; metres.
struct PartDifference {
  std::string part;
  double median = 0, p95 = 0, most = 0;      ///< of the sizes; `most` with its sign
  double forward = 0, left = 0, height = 0;  ///< where that is, body frame
};

struct SkinDifference {
  std::string what;                   ///< body at rest, under B1
  std::vector<PartDifference> parts;  ///< the largest first
  double scale = 0;                   ///< m: full colour in the pictures
  std::vector<CasePicture> pictures;  ///< none where nothing differs
};

struct RunComparison {
  std::string name;                ///< of the case; empty: two bags
  std::string one, other;          ///< bags
  std::vector<std::string> notes;  ///< what could not be compared, and why
  std::vector<TopicDifference> topics;
  std::vector<SkinDifference> skins;

  bool same() const;
};

/// Two bags with what came out of a chain (replay.launch, regression, or recorded live), of any version of
/// the messages. What is not the chain's is left out: header.seq, times of work, progress, /diagnostics.
/// \throw Refusal broken_file
RunComparison compare_bags(const std::string& one, const std::string& other);

/// Two bags, or two folders of `regression --out`: every case, with a note where only one of them has it.
/// \throw Refusal bad_case: nothing to compare; as compare_bags
std::vector<RunComparison> compare_runs(const std::string& one, const std::string& other);

std::string to_text(const RunComparison& comparison);
std::string differences_json(const std::vector<RunComparison>& comparisons);  ///< a line a field and a part
std::string differences_page(const std::vector<RunComparison>& comparisons);  ///< one page, no network

}  // namespace tensegric_fit::regression
