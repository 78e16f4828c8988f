#include "inspect/page_view.hpp"

#include <fmt/format.h>

#include "files/html.hpp"
#include "files/page_template.hpp"
#include "geometry/shipped_files.hpp"
#include "inspect/colours.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr std::size_t kMostModel = 5'000'000;  // bytes: with all else the page is below 8 MB

std::string page_file(const char* name) {
  return files::bytes_of(geometry::shipped_folder("page") + "/" + name);
}

/// The two-sided colours as stops of a CSS gradient.
std::string scale_stops() {
  constexpr int kSteps = 10;
  std::string stops;
  for (int i = 0; i <= kSteps; ++i) {
    const Colour c = two_sided_colour(2.0 * i / kSteps - 1);
    stops += fmt::format("{}rgb({},{},{})", i ? "," : "", c[0], c[1], c[2]);
  }
  return stops;
}

std::string script(const std::string& code) {
  return "<script>\n" + code + "</script>\n";
}

std::string facts_of(const PageView& view) {
  const Colour neutral = two_sided_colour(0);
  const nlohmann::json facts{{"loops", view.loops},
                             {"reading", view.reading},
                             {"neutral", {neutral[0] / 255.0, neutral[1] / 255.0, neutral[2] / 255.0}}};
  std::string text = facts.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at))
    text.replace(at, 1, "\\u003c");  // a name must not end the script that holds it
  return text;
}

}  // namespace

std::string view_section(const PageView& view) {
  return files::filled_in(page_file("view.html"), {{"scale", scale_stops()},
                                                   {"name", files::html_escaped(view.name)},
                                                   {"before", files::html_escaped(view.before)},
                                                   {"after", files::html_escaped(view.after)},
                                                   {"beside", files::html_escaped(view.beside)},
                                                   {"low", files::html_escaped(view.low)},
                                                   {"middle", files::html_escaped(view.middle)},
                                                   {"high", files::html_escaped(view.high)},
                                                   {"notes", view.notes}});
}

std::string view_scripts(const PageView& view) {
  if (view.model.size() > kMostModel) return "";
  const std::string three = TENSEGRIC_FIT_THREE_JS;
  return "<script type=\"application/json\" id=\"facts\">" + facts_of(view) +
         "</script>\n<script type=\"model/gltf-binary\" id=\"glb\">" + files::base64(view.model) +
         "</script>\n" + script(files::bytes_of(three + "/three.min.js")) +
         script(files::bytes_of(three + "/examples/js/controls/OrbitControls.js")) +
         script(page_file("view.js"));
}

}  // namespace tensegric_fit::inspect
