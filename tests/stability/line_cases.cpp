#include <algorithm>

#include "../unit/tensegric_bust.hpp"
#include "shapes.hpp"
#include "stability_case.hpp"

namespace tensegric_fit::stability {
namespace {

using geometry::ControlMesh;
using tensegric::Garment;
using tensegric::GarmentLine;
using tensegric::TensionLaw;

GarmentLine line(const std::string& name, const std::vector<std::string>& through, double ratio,
                 bool taut = false) {
  GarmentLine made;
  made.name = name;
  made.through = through;
  made.ratio = ratio;
  made.taut = taut;
  return made;
}

TensionLaw stiffness(double s) {
  TensionLaw law;
  law.kind = TensionLaw::Kind::stiffness;
  law.stiffness = s;
  return law;
}

TensionLaw table(std::vector<std::pair<double, double>> rows) {
  TensionLaw law;
  law.kind = TensionLaw::Kind::table;
  law.table = std::move(rows);
  return law;
}

}  // namespace

std::vector<Case> line_cases() {
  std::vector<Case> cases;
  ControlMesh bust = tensegric::bust_mesh();
  bust.names[bust.lines[0].nodes[0] - 11] = "rim_a";
  bust.names[bust.lines[0].nodes[0] - 22] = "rim_b";
  bust.names[5] = "bottom";
  bust.names[71] = "top";
  const auto add = [&](const std::string& name, std::vector<GarmentLine> lines) -> Case& {
    cases.emplace_back();
    cases.back().name = "lines/" + name;
    cases.back().control = bust;
    cases.back().garment.name = name;
    cases.back().garment.lines = std::move(lines);
    return cases.back();
  };
  const std::vector<std::string> chest_way = {"axilla_L", "bust_point_L", "sternum", "bust_point_R",
                                              "axilla_R"};
  const std::vector<std::string> tips = {"bust_point_L", "bust_point_R"};
  const GarmentLine chest_line = line("chest", chest_way, 0.9);

  for (double ratio : {1.3, 1.1, 1.0, 0.97, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3})
    add("chest at " + std::to_string(ratio).substr(0, 4), {line("chest", chest_way, ratio)});
  add("none", {});
  add("through fixed nodes only", {line("rim", {"axilla_L", "rim_a", "rim_b"}, 0.9)});
  add("through fixed nodes only, beside a good one", {line("rim", {"rim_a", "rim_b"}, 0.9), chest_line});
  add("through fixed nodes only, longer", {line("rim", {"rim_a", "rim_b"}, 1.2)});
  add("elastic through fixed nodes only", {line("rim", {"rim_a", "rim_b"}, 0.9)});
  cases.back().garment.lines[0].law = stiffness(1);
  add("listed twice", {chest_line, chest_line});
  GarmentLine again = chest_line;
  again.name = "chest_2";
  add("over the same nodes", {chest_line, again});
  std::reverse(again.through.begin(), again.through.end());
  add("over the same nodes backwards", {chest_line, again});
  again.ratio = 0.8;
  add("over the same nodes, two requests", {chest_line, again});
  add("three over the same nodes, elastic and rigid", {chest_line, again, line("chest_3", chest_way, 0.7)});
  cases.back().garment.lines[2].law = stiffness(2);
  add("there and back", {line("loop", {"axilla_L", "bust_point_L", "axilla_L", "bust_point_L"}, 0.8)});
  add("closed ring", {line("ring", {"bust_point_L", "sternum", "top", "bust_point_L"}, 0.8, true)});
  add("tips on one point", {line("tips", tips, 1e-3, true)});
  add("tips together and apart",
      {line("tips", tips, 0.5, true), line("left", {"axilla_L", "bust_point_L"}, 0.5, true),
       line("right", {"axilla_R", "bust_point_R"}, 0.5, true)});
  add("one node pulled four ways",
      {line("a", {"axilla_L", "bust_point_L"}, 0.6, true), line("b", {"axilla_R", "bust_point_L"}, 0.6, true),
       line("c", {"top", "bust_point_L"}, 0.6, true), line("d", {"bottom", "bust_point_L"}, 0.6, true)});
  add("crossing, both at a half",
      {line("chest", chest_way, 0.5), line("up", {"bottom", "sternum", "top"}, 0.5)});
  add("tension limit 0", {chest_line});
  cases.back().garment.lines[0].tension_limit = 0;
  add("tension limit 1e-6", {chest_line});
  cases.back().garment.lines[0].tension_limit = 1e-6;
  for (double s : {1e-9, 1e-3, 1e3, 1e9}) {
    add("stiffness " + std::to_string(s), {chest_line});
    cases.back().garment.lines[0].law = stiffness(s);
  }
  add("table that never pulls", {chest_line});
  cases.back().garment.lines[0].law = table({{1, 0}, {2, 0}});
  add("table with a step", {chest_line});
  cases.back().garment.lines[0].law = table({{1, 0}, {1.0001, 1}, {1.5, 1}, {1.6, 100}});
  add("through a name that is not there", {line("lost", {"axilla_L", "elbow"}, 0.9)}).refusal =
      "unknown_line";
  add("at no length", {line("chest", chest_way, 0)}).refusal = "bad_garment";
  return cases;
}

}  // namespace tensegric_fit::stability
