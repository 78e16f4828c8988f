#include "mesh_files/measures_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "geometry/section.hpp"
#include "mesh_files/frame.hpp"

namespace tensegric_fit::mesh_files {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

/// Numbers of ISO 8559-1:2017 as other vendors' public tables have them; heights have none there.
struct Standard {
  const char *kind, *name, *iso_name, *iso_number, *vit;
};
constexpr Standard kStandards[] = {
    {"girth", "neck", "neck girth", "5.3.2", "neck_mid_circ"},
    {"girth", "bust", "bust girth", "5.3.4", "bust_circ"},
    {"girth", "underbust", "under bust girth", "5.3.8", "lowbust_circ"},
    {"girth", "waist", "waist girth", "5.3.10", "waist_circ"},
    {"girth", "hip", "hip girth", "5.3.13", "hip_circ"},
    {"girth", "upper_arm_R", "upper-arm girth", "5.3.16", "arm_upper_circ"},
    {"girth", "upper_arm_L", "upper-arm girth", "5.3.16", ""},
    {"girth", "thigh_R", "thigh girth", "5.3.20", "leg_thigh_upper_circ"},
    {"girth", "thigh_L", "thigh girth", "5.3.20", ""},
    {"height", "stature", "stature", "", "height"},
    {"height", "neck", "", "", "height_neck_back"},  // MeasureEntry::back
    {"height", "bust", "", "", "height_bustpoint"},
    {"height", "waist", "waist height", "", "height_waist_side"},
    {"height", "hip", "hip height", "", "height_hip"},
    {"height", "crotch", "", "", "leg_crotch_to_floor"},
};

const char* kind_of(const MeasureEntry& entry) {
  return entry.is_girth ? "girth" : "height";
}

const Standard* standard_of(const MeasureEntry& entry) {
  for (const Standard& standard : kStandards)
    if (entry.before.name == standard.name && std::string(kind_of(entry)) == standard.kind) return &standard;
  return nullptr;
}

/// Twice the area of a loop times its normal.
Vector3d area_of(const Points& loop) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < loop.size(); ++i) sum += loop[i].cross(loop[(i + 1) % loop.size()]);
  return sum;
}

// The section in the tape's plane, where it is inside the tape; what is outside (an arm that touches) is cut
// off.
double skin_length(const geometry::TriangleMesh& mesh, const Points& tape) {
  if (tape.size() < 3 || !(area_of(tape).norm() > 0)) return 0;
  const Vector3d normal = area_of(tape).normalized();
  constexpr double kOnTape = 5e-4;  // m
  const auto inside = [&](const Vector3d& p) {
    for (std::size_t i = 0; i < tape.size(); ++i) {
      const Vector3d side = tape[(i + 1) % tape.size()] - tape[i];
      if (normal.cross(side).normalized().dot(p - tape[i]) < -kOnTape) return false;
    }
    return true;
  };
  double longest = 0;
  for (const geometry::SectionLoop& loop : geometry::plane_section(mesh, tape.front(), normal)) {
    Points kept;
    for (const Vector3d& p : loop.points)
      if (inside(p)) kept.push_back(p);
    longest = std::max(longest, geometry::length_of(kept, true));
  }
  return longest;
}

std::optional<Loop> loop_of(const geometry::TriangleMesh& mesh, const Points& tape,
                            const Eigen::Isometry3d& place) {
  if (tape.empty()) return std::nullopt;
  Loop loop{tape, geometry::length_of(tape, true), skin_length(mesh, tape)};
  for (Vector3d& p : loop.points) p = place * p;
  return loop;
}

Json json_of(const std::optional<double>& value, const std::optional<Loop>& loop) {
  if (!value) return nullptr;
  Json entry{{"value", *value}};
  if (!loop) return entry;
  entry["tape"] = loop->tape;
  entry["skin"] = loop->skin > 0 ? Json(loop->skin) : Json();
  entry["polyline"] = Json::array();
  for (const Vector3d& p : loop->points) {
    const Vector3d q = mesh_files::y_up(p);
    entry["polyline"].push_back({q.x(), q.y(), q.z()});
  }
  return entry;
}

/// As .vit has it, before or under the garment.
std::optional<geometry::Measure> vit_measure(const MeasureEntry& entry, bool worn) {
  const bool is_back = !entry.is_girth && entry.before.name == "neck";
  std::optional<geometry::Measure> measure = entry.before;
  if (is_back) measure = entry.back;
  if (!measure || !worn) return measure;
  const std::optional<double>& after = is_back ? entry.back_worn : entry.worn;
  if (!after) return std::nullopt;
  measure->metres = *after;
  return measure;
}

/// Why not to rely on a figure; "" where it is sure.
std::string doubt_of(const geometry::Measure& measure) {
  if (!measure.is_unsure()) return "";
  std::string text =
      measure.half_width > 0 ? fmt::format("+- {} mm", std::lround(1000 * measure.half_width)) : "";
  if (!measure.reason.empty()) text += (text.empty() ? "" : ", ") + measure.reason;
  return text.empty() ? "unsure" : "unsure: " + text;
}

/// Text that may come from any publisher as XML: by way of JSON, which replaces what is no UTF-8.
std::string in_xml(const std::string& text) {
  const std::string utf8 =
      Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
  std::string xml;
  for (const char c : utf8) {
    if (c == '&')
      xml += "&amp;";
    else if (c == '<')
      xml += "&lt;";
    else if (c == '>')
      xml += "&gt;";
    else if (c == '"')
      xml += "&quot;";
    else
      xml += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return xml;
}

Json text_or_null(const char* text) {
  return *text == '\0' ? Json() : Json(text);
}

}  // namespace

std::vector<MeasureEntry> measure_entries(const geometry::TriangleMesh& body,
                                          const geometry::BodyMeasures& measures, const WornBody* worn) {
  std::vector<MeasureEntry> entries;
  if (worn == nullptr) {
    for (const geometry::Measure& height : measures.heights) entries.push_back({height, false, {}, {}, {}});
    for (const geometry::Measure& girth : measures.girths) entries.push_back({girth, true, {}, {}, {}});
  } else {
    for (const geometry::ChangedMeasure& height : worn->heights)
      entries.push_back({height.before, false, height.after, {}, {}});
    for (const geometry::ChangedMeasure& girth : worn->girths)
      entries.push_back({girth.before, true, girth.after, {}, {}});
  }
  const Eigen::Isometry3d& place = measures.body_from_scan;
  const geometry::Landmark* back = measures.find_landmark("neck_back");
  for (MeasureEntry& entry : entries) {
    if (!entry.is_girth && entry.before.name == "neck" && back != nullptr) {
      entry.back = geometry::Measure{back->name, (place * back->position).z(), back->confidence, back->reason,
                                     back->half_width};
      if (worn != nullptr)
        entry.back_worn = (place * geometry::carried({back->position}, {body, worn->skin}).front()).z();
    }
    if (!entry.is_girth) continue;
    for (const geometry::GirthLoop& loop : measures.loops) {
      if (loop.name != entry.before.name) continue;
      entry.loop = loop_of(body, loop.points, place);
      if (worn == nullptr) continue;
      entry.loop_worn =
          loop_of({worn->skin, body.triangles}, geometry::tape_after({body, worn->skin}, loop.points), place);
      // A neck's tape is smoothed, and one of the body model lies off the skin: what the garment changes is
      // the difference of two sections.
      const std::optional<Loop> rest =
          loop_of(body, geometry::tape_after({body, body.vertices}, loop.points), place);
      if (!entry.loop || !entry.loop_worn || !rest) continue;
      entry.loop_worn->tape += entry.loop->tape - rest->tape;
      if (entry.loop->skin > 0 && entry.loop_worn->skin > 0 && rest->skin > 0)
        entry.loop_worn->skin += entry.loop->skin - rest->skin;
    }
  }
  return entries;
}

std::string measures_text(const std::vector<MeasureEntry>& measures) {
  Json list = Json::array();
  for (const MeasureEntry& entry : measures) {
    const Standard* standard = standard_of(entry);
    Json iso{{"name", text_or_null(standard == nullptr ? "" : standard->iso_name)},
             {"number", text_or_null(standard == nullptr ? "" : standard->iso_number)}};
    list.push_back({{"name", entry.before.name},
                    {"kind", kind_of(entry)},
                    {"iso_8559_1", std::move(iso)},
                    {"half_width", entry.before.half_width > 0 ? Json(entry.before.half_width) : Json()},
                    {"confidence", entry.before.confidence},
                    {"before", json_of(entry.before.metres, entry.loop)},
                    {"under_garment", json_of(entry.worn, entry.loop_worn)}});
  }
  const Json file{
      {"format", "tensegric_fit/measures"},
      {"version", 1},
      {"unit", "m"},
      {"axes", "y up, z forward, x to her left, origin on the floor between the feet: those of fit.glb"},
      {"measures", std::move(list)}};
  return file.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string measures_vit(const std::vector<MeasureEntry>& measures, bool worn) {
  std::string notes = worn ? "under the garment" : "before the garment", lines;
  for (const MeasureEntry& entry : measures) {
    const Standard* standard = standard_of(entry);
    const std::optional<geometry::Measure> measure = vit_measure(entry, worn);
    if (standard == nullptr || *standard->vit == '\0' || !measure) continue;
    const std::string doubt = in_xml(doubt_of(*measure));
    if (!doubt.empty()) notes += fmt::format("\n{}: {}", standard->vit, doubt);
    lines += fmt::format("    <m name=\"{}\" value=\"{:.1f}\" description=\"{}\" full_name=\"\"/>\n",
                         standard->vit, 100 * measure->metres, doubt);
  }
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<vit>\n  <!--tensegric_fit-->\n  "
         "<version>0.3.3</version>\n"
         "  <read-only>false</read-only>\n  <notes>" +
         notes +
         "</notes>\n  <unit>cm</unit>\n  <pm_system>998</pm_system>\n  <personal>\n    <family-name/>\n    "
         "<given-name/>\n"
         "    <birth-date>1900-01-01</birth-date>\n    <gender>female</gender>\n    <email/>\n  </personal>\n"
         "  <body-measurements>\n" +
         lines + "  </body-measurements>\n</vit>\n";
}

}  // namespace tensegric_fit::mesh_files
