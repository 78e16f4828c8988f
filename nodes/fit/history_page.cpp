#include <fmt/format.h>

#include <opencv2/imgproc.hpp>

#include "files/html.hpp"
#include "fit/history.hpp"
#include "geometry/ply.hpp"
#include "inspect/composition.hpp"
#include "inspect/picture.hpp"
#include "inspect/pointing.hpp"
#include "inspect/words.hpp"

namespace tensegric_fit::fit {
namespace {

namespace fs = std::filesystem;
using files::html_escaped;

constexpr int kWidth = 520, kHeight = 900;               // pixels
constexpr double kTrunkFrom = 0.5, kTrunkTo = 0.8;       // of the stature
const cv::Scalar kFrom(60, 110, 200), kTo(150, 90, 20);  // BGR: orange, blue

constexpr char kStyle[] = R"(
body { font: 15px/1.45 system-ui, sans-serif; color: #333; max-width: 70rem; margin: 0 auto; padding: 1rem }
h1 { font-size: 1.4rem } h2 { font-size: 1.1rem; margin: 1.6rem 0 .3rem }
table { border-collapse: collapse } .wide { overflow-x: auto }
th, td { padding: .15rem .7rem; text-align: right; border-bottom: 1px solid #ddd }
th:first-child, td:first-child { text-align: left } td { white-space: nowrap } td.t { text-align: left }
img { max-width: 100% } .from { color: #c86e3c } .to { color: #145a96 } b { color: #a00 })";

// In the body's frame, her trunk over the origin: two scans lie over each other though she leans otherwise.
geometry::TriangleMesh body_of(const Visit& visit) {
  geometry::TriangleMesh body = geometry::read_ply_mesh((visit.folder / "body.ply").string());
  for (Eigen::Vector3d& vertex : body.vertices) vertex = visit.body_from_scan * vertex;
  double stature = 0;
  if (const auto known = visit.heights.find("stature"); known != visit.heights.end())
    stature = known->second.before;  // exports have no head
  else
    for (const Eigen::Vector3d& vertex : body.vertices) stature = std::max(stature, vertex.z());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int trunk = 0;
  for (const Eigen::Vector3d& vertex : body.vertices) {
    if (vertex.z() < kTrunkFrom * stature || vertex.z() > kTrunkTo * stature) continue;
    sum += vertex;
    ++trunk;
  }
  for (Eigen::Vector3d& vertex : body.vertices) vertex.head<2>() -= sum.head<2>() / std::max(1, trunk);
  return body;
}

cv::Mat outlines(const geometry::TriangleMesh& from, const geometry::TriangleMesh& to,
                 inspect::MakeView make) {
  double top = 0;
  for (const geometry::TriangleMesh* body : {&from, &to})
    for (const Eigen::Vector3d& vertex : body->vertices) top = std::max(top, vertex.z());
  const inspect::View view = make(Eigen::Isometry3d::Identity(), {0, 0, top / 2}, 1.05 * top);
  cv::Mat3b picture(kHeight, kWidth, cv::Vec3b(255, 255, 255));
  for (const auto& [body, colour] : {std::pair(&from, kFrom), {&to, kTo}}) {
    std::vector<std::vector<cv::Point>> contours;
    cv::findContours(inspect::silhouette(*body, view, kWidth, kHeight), contours, cv::RETR_LIST,
                     cv::CHAIN_APPROX_NONE);
    cv::drawContours(picture, contours, -1, colour, body == &from ? 3 : 1, cv::LINE_AA);
  }
  return picture;
}

std::string picture_of(const Visit& from, const Visit& to) {
  const geometry::TriangleMesh one = body_of(from), other = body_of(to);
  const cv::Mat both = inspect::side_by_side(outlines(one, other, inspect::front_view),
                                             outlines(one, other, inspect::side_view));
  return fmt::format("<img alt=\"outlines of both bodies\" src=\"data:image/png;base64,{}\">\n",
                     files::base64(inspect::png_bytes(both)));
}

// The customer's page of an export, else the folder.
std::string link_to(const Visit& visit, const fs::path& page) {
  const fs::path folder = fs::relative(visit.folder, fs::absolute(page).parent_path());
  const fs::path target = fs::exists(visit.folder / "fit.html") ? folder / "fit.html" : folder / "";
  std::string address;
  for (const char letter : target.string())
    address += std::isalnum(static_cast<unsigned char>(letter)) ||
                       std::string("/._-~").find(letter) != std::string::npos
                   ? std::string(1, letter)
                   : fmt::format("%{:02X}", static_cast<unsigned char>(letter));
  return fmt::format("<a href=\"{}\">{}</a>", address, html_escaped(visit.folder.filename().string()));
}

std::string girth_cell(const Visit& visit, const char* name) {
  const auto girth = visit.girths.find(name);
  if (girth == visit.girths.end()) return "<td></td>";
  const VisitMeasure& measure = girth->second;
  return fmt::format("<td>{:.1f}{}</td>", 100 * measure.before,
                     measure.after ? fmt::format(" → {:.1f}", 100 * *measure.after) : "");
}

std::string visits_table(const std::vector<Visit>& visits, const fs::path& page) {
  std::string html =
      "<div class=wide><table><tr><th>visit<th>day<th>garment<th>lines, % of rest<th>bust, cm<th>underbust, "
      "cm"
      "<th>waist, cm<th>hip, cm<th>from file<th>open</tr>\n";
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const Visit& visit = visits[i];
    std::string lines;
    for (const auto& [name, ratio] : visit.lines)
      lines += fmt::format("{}{} {:.1f}", lines.empty() ? "" : ", ", html_escaped(name), 100 * ratio);
    html += fmt::format("<tr><td>{}</td><td>{}</td><td class=t>{}</td><td class=t>{}</td>", i + 1, visit.day,
                        visit.garment.empty() ? "measured" : html_escaped(visit.garment), lines);
    for (const char* name : {"bust", "underbust", "waist", "hip"}) html += girth_cell(visit, name);
    html += fmt::format("<td class=t>{}</td><td class=t>{}</td></tr>\n", html_escaped(visit.source),
                        link_to(visit, page));
  }
  return html + "</table></div>\n";
}

std::string changes_table(const Visit& from, const Visit& to) {
  std::string html =
      "<div class=wide><table><tr><th>cm<th>before<th>now<th>change<th>uncertain by, 95 %</tr>\n";
  for (const VisitChange& change : changes(from, to)) {
    const std::string moved = inspect::words::centimetre_change(change.from, change.to);
    html += fmt::format("<tr><td>{} {}</td><td>{:.1f}</td><td>{:.1f}</td><td>{}</td><td>{}</td></tr>\n",
                        html_escaped(inspect::spoken(change.name)), change.kind, 100 * change.from,
                        100 * change.to, change.beyond_doubt() ? "<b>" + moved + "</b>" : moved,
                        change.half_width > 0 ? fmt::format("{:.1f}", 100 * change.half_width) : "");
  }
  return html + "</table></div>\n";
}

}  // namespace

std::string visits_page(const std::vector<Visit>& visits, std::size_t from, std::size_t to,
                        const fs::path& page) {
  const std::string title = "Customer " + html_escaped(visits.front().customer);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport "
      "content=\"width=device-width\">"
      "<title>{0}</title><style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n{2}",
      title, kStyle, visits_table(visits, page));
  if (visits.size() > 1)
    html += fmt::format(
        "<h2>From <span class=from>visit {} ({})</span> to <span class=to>visit {} ({})</span></h2>\n"
        "<p>Bold: a change beyond what two scans leave open. Without garment; bodies lie over each other by "
        "trunk and "
        "facing, arms may be held otherwise.</p>\n{}{}",
        from + 1, visits[from].day, to + 1, visits[to].day, changes_table(visits[from], visits[to]),
        picture_of(visits[from], visits[to]));
  return html + "</body></html>\n";
}

}  // namespace tensegric_fit::fit
