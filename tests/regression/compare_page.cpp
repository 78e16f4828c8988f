#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "compare.hpp"
#include "files/html.hpp"
#include "report.hpp"

namespace tensegric_fit::regression {
namespace {

constexpr std::size_t kFieldsInText = 6, kFieldsOnPage = 60;  // of a topic

std::string how_far(const FieldDifference& field) {
  if (field.most == 0) return fmt::format("{} -> {}", field.one, field.other);
  if (field.of > 4)
    return fmt::format("{} of {} values, by {:.3g} at most (number {})", field.differing, field.of,
                       field.most, field.where);
  return fmt::format("{} -> {}, by {:.3g}", field.one, field.other, field.most);
}

std::string name_of(const FieldDifference& field) {
  return field.message == 0 ? field.field : fmt::format("{} (message {})", field.field, field.message + 1);
}

std::string verdict_of(const TopicDifference& topic) {
  if (topic.one != topic.other)
    return fmt::format("{} messages in one, {} in the other", topic.one, topic.other);
  return topic.fields.empty() ? "the same" : fmt::format("{} fields differ", topic.fields.size());
}

std::string place_of(const PartDifference& part) {
  return fmt::format("{:.0f} cm above the floor, {:.0f} cm to her {}, {:.0f} cm {}", 100 * part.height,
                     100 * std::abs(part.left), part.left >= 0 ? "left" : "right",
                     100 * std::abs(part.forward), part.forward >= 0 ? "forward" : "back");
}

std::string side_of(const PartDifference& part) {
  return part.most > 0 ? "outside" : "inside";
}

std::string topics_table(const RunComparison& comparison) {
  std::string html;
  for (const TopicDifference& topic : comparison.topics) {
    if (topic.fields.empty()) {
      html += fmt::format("<p><b>{}</b>: {}</p>\n", topic.topic, verdict_of(topic));
      continue;
    }
    html += fmt::format(
        "<details><summary><b>{}</b>: {}</summary><div class=wide><table><tr><th>field<th>one<th>other"
        "<th>values that differ<th>by at most</tr>\n",
        topic.topic, verdict_of(topic));
    for (std::size_t i = 0; i < std::min(kFieldsOnPage, topic.fields.size()); ++i) {
      const FieldDifference& field = topic.fields[i];
      html += fmt::format(
          "<tr><td>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{} of {}</td><td "
          "class=n>{:.4g}</td></tr>\n",
          files::html_escaped(name_of(field)), files::html_escaped(field.one),
          files::html_escaped(field.other), field.differing, field.of, field.most);
    }
    html += "</table></div>";
    if (topic.fields.size() > kFieldsOnPage)
      html += fmt::format("<p>and {} more: differences.jsonl</p>", topic.fields.size() - kFieldsOnPage);
    html += "</details>\n";
  }
  return html;
}

std::string skins_section(const RunComparison& comparison) {
  std::string html;
  for (const SkinDifference& skin : comparison.skins) {
    if (skin.parts.empty()) {
      html += fmt::format("<h3>{}: the same skin</h3>\n", files::html_escaped(skin.what));
      continue;
    }
    html += fmt::format("<h3>{}</h3>\n", files::html_escaped(skin.what));
    for (const CasePicture& picture : skin.pictures)
      html += fmt::format(
          "<figure><img alt=\"{0}\" "
          "src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
          files::html_escaped(picture.caption), files::base64(picture.png));
    html +=
        "<div class=wide><table><tr><th>part<th>median, mm<th>95 %, mm<th>most, mm<th>where, and on which "
        "side the second lies</tr>\n";
    for (const PartDifference& part : skin.parts)
      html += fmt::format(
          "<tr><td>{}</td><td class=n>{:.3f}</td><td class=n>{:.3f}</td><td class=n>{:+.3f}</td><td>{}, "
          "{}</td></tr>\n",
          part.part, 1e3 * part.median, 1e3 * part.p95, 1e3 * part.most, place_of(part), side_of(part));
    html += "</table></div>\n";
  }
  return html;
}

}  // namespace

std::string to_text(const RunComparison& comparison) {
  std::string text = fmt::format("{}{}\n", comparison.name.empty() ? "" : comparison.name + ": ",
                                 comparison.same() ? "the same" : "DIFFERS");
  for (const std::string& note : comparison.notes) text += "  " + note + "\n";
  for (const TopicDifference& topic : comparison.topics) {
    text += fmt::format("  {:<17} {}\n", topic.topic, verdict_of(topic));
    for (std::size_t i = 0; i < std::min(kFieldsInText, topic.fields.size()); ++i)
      text += fmt::format("      {}: {}\n", name_of(topic.fields[i]), how_far(topic.fields[i]));
    if (topic.fields.size() > kFieldsInText)
      text += fmt::format("      and {} more\n", topic.fields.size() - kFieldsInText);
  }
  for (const SkinDifference& skin : comparison.skins)
    for (std::size_t i = 0; i < std::min<std::size_t>(3, skin.parts.size()); ++i) {
      const PartDifference& part = skin.parts[i];
      text += fmt::format("  {:<17} {}: {:.2f} mm at most, {}, second {}; median {:.2f}, 95 % {:.2f} mm\n",
                          i == 0 ? skin.what : "", part.part, 1e3 * std::abs(part.most), place_of(part),
                          side_of(part), 1e3 * part.median, 1e3 * part.p95);
    }
  return text;
}

std::string differences_json(const std::vector<RunComparison>& comparisons) {
  std::string lines;
  for (const RunComparison& comparison : comparisons) {
    for (const TopicDifference& topic : comparison.topics)
      for (const FieldDifference& f : topic.fields)
        lines +=
            nlohmann::ordered_json{{"case", comparison.name},  {"topic", f.topic}, {"message", f.message},
                                   {"field", f.field},         {"one", f.one},     {"other", f.other},
                                   {"differing", f.differing}, {"of", f.of},       {"most", f.most},
                                   {"number", f.where}}
                .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
            "\n";
    for (const SkinDifference& skin : comparison.skins)
      for (const PartDifference& p : skin.parts)
        lines += nlohmann::ordered_json{{"case", comparison.name},
                                        {"skin", skin.what},
                                        {"part", p.part},
                                        {"median_mm", 1e3 * p.median},
                                        {"p95_mm", 1e3 * p.p95},
                                        {"most_mm", 1e3 * p.most},
                                        {"place", {p.forward, p.left, p.height}}}
                     .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
                 "\n";
  }
  return lines;
}

std::string differences_page(const std::vector<RunComparison>& comparisons) {
  const auto others = std::count_if(comparisons.begin(), comparisons.end(),
                                    [](const RunComparison& comparison) { return !comparison.same(); });
  std::string html = page_begin(
      "Comparison", others == 0
                        ? "<span class=good>the same</span>"
                        : fmt::format("<span class=bad>{} of {} differ</span>", others, comparisons.size()));
  for (const RunComparison& comparison : comparisons) {
    html += fmt::format("<h2>{}{}</h2>\n<p>one: {}<br>other: {}</p>\n",
                        comparison.name.empty() ? "" : files::html_escaped(comparison.name) + ": ",
                        comparison.same() ? "the same" : "differs", files::html_escaped(comparison.one),
                        files::html_escaped(comparison.other));
    for (const std::string& note : comparison.notes)
      html += "<p class=bad>" + files::html_escaped(note) + "</p>\n";
    html += skins_section(comparison) + topics_table(comparison);
  }
  return html + "</body></html>\n";
}

}  // namespace tensegric_fit::regression
