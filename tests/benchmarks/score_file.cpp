#include "score_file.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "geometry/status.hpp"

namespace tensegric_fit::population {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Figure& figure) {
  Json json = {{"name", figure.name}, {"error", nullptr}, {"limit", figure.limit}};
  if (std::isfinite(figure.error)) json["error"] = figure.error;
  json.update({{"counts", figure.counts},
               {"hidden", figure.hidden},
               {"confidence", figure.confidence},
               {"half_width", figure.half_width},
               {"cause", figure.cause}});
  return json;
}

Figure figure_in(const Json& json) {
  Figure figure{json.at("name"), std::numeric_limits<double>::infinity(), json.at("limit")};
  if (!json.at("error").is_null()) figure.error = json.at("error");
  figure.counts = json.at("counts");
  figure.hidden = json.at("hidden");
  figure.confidence = json.at("confidence");
  figure.half_width = json.at("half_width");
  figure.cause = json.at("cause");
  return figure;
}

Score score_in(const Json& json) {
  Score score{json.at("family"), json.at("input"), json.at("body"), json.at("refusal"), {}};
  for (const Json& figure : json.at("figures")) score.figures.push_back(figure_in(figure));
  return score;
}

}  // namespace

std::vector<Score> read_scores(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  std::stringstream all;
  all << file.rdbuf();
  const std::string text = all.str();
  std::vector<Score> scores;
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
    try {
      scores.push_back(score_in(Json::parse(text.substr(begin, end - begin))));
    } catch (const Json::exception& error) {
      throw geometry::Refusal(geometry::refusal::kBrokenFile, path + ": " + error.what());
    }
    begin = end + 1;
  }
  return scores;
}

void take_off_unfinished(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return;
  std::stringstream all;
  all << file.rdbuf();
  const std::size_t end = all.str().rfind('\n') + 1;  // npos + 1 is 0
  if (end < all.str().size()) std::filesystem::resize_file(path, end);
}

void append_score(const std::string& path, const Score& score) {
  Json json = {
      {"family", score.family}, {"input", score.input}, {"body", score.body}, {"refusal", score.refusal}};
  json["figures"] = Json::array();
  for (const Figure& figure : score.figures) json["figures"].push_back(to_json(figure));
  std::ofstream file(path, std::ios::app | std::ios::binary);
  file << json.dump() << '\n';
  file.flush();
  if (!file) throw geometry::Refusal(geometry::refusal::kCannotWrite, path + ": cannot be written");
}

}  // namespace tensegric_fit::population
