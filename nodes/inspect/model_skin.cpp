#include "inspect/model_skin.hpp"

#include <algorithm>
#include <map>

#include "geometry/status.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr double kTint = 0.42;       // share of the part's colour
constexpr double kRightLight = 0.3;  // share of white in the colours of her right side

// Neighbours on a body are far from each other in colour.
constexpr Colour kParts[] = {{214, 96, 77},  {140, 86, 160}, {65, 120, 185}, {222, 140, 30}, {60, 150, 90},
                             {190, 70, 130}, {150, 110, 70}, {90, 85, 180},  {30, 150, 160}, {170, 150, 20}};

}  // namespace

void check_model_skin(const ModelSkin& skin) {
  const auto check = [](bool holds, const char* code, const char* what) {
    if (!holds) throw geometry::Refusal(code, what);
  };
  const int count = static_cast<int>(skin.vertices.size());
  for (const Eigen::Vector3d& vertex : skin.vertices)
    check(vertex.allFinite(), geometry::refusal::kNonFinite, "the body model's skin is not finite");
  for (const std::array<int, 4>& quad : skin.quads)
    for (const int vertex : quad)
      check(vertex >= 0 && vertex < count, geometry::refusal::kBadModel,
            "a quadrilateral of the body model has a corner that is not there");
  check(skin.part.size() == skin.vertices.size(), geometry::refusal::kBadModel,
        "the body model has not one part per vertex");
  for (const unsigned char part : skin.part)
    check(part < skin.parts.size(), geometry::refusal::kBadModel, "a part of the body model has no name");
}

std::vector<Colour> part_colours(const std::vector<std::string>& parts) {
  std::vector<Colour> colours;
  std::map<std::string, std::size_t> seen;  // name without its side, number
  for (const std::string& name : parts) {
    const std::string side = name.size() > 2 ? name.substr(name.size() - 2) : "";
    const bool right = side == "_R";
    const std::string pair = right || side == "_L" ? name.substr(0, name.size() - 2) : name;
    const std::size_t number = seen.emplace(pair, seen.size()).first->second;
    const Colour& colour = kParts[number % std::size(kParts)];
    colours.push_back(right ? mixed(colour, {255, 255, 255}, kRightLight) : colour);
  }
  return colours;
}

std::vector<Colour> tinted_skin(const std::vector<unsigned char>& parts_of_skin,
                                const std::vector<std::string>& parts) {
  std::vector<Colour> tints = part_colours(parts);
  for (Colour& tint : tints) tint = mixed(kNeutral, tint, kTint);
  std::vector<Colour> colours;
  for (const unsigned char part : parts_of_skin)
    colours.push_back(part < tints.size() ? tints[part] : kNeutral);
  return colours;
}

std::vector<Eigen::Vector3i> triangles_of(const ModelSkin& skin) {
  std::vector<Eigen::Vector3i> triangles;
  for (const std::array<int, 4>& q : skin.quads) {
    triangles.emplace_back(q[0], q[1], q[2]);
    triangles.emplace_back(q[0], q[2], q[3]);
  }
  return triangles;
}

std::vector<Stroke> model_strokes(const ModelSkin& skin, const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<std::pair<int, int>> edges;
  for (const std::array<int, 4>& quad : skin.quads)
    for (int corner = 0; corner < 4; ++corner)
      edges.push_back(std::minmax(quad[corner], quad[(corner + 1) % 4]));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const std::vector<Colour> colours = part_colours(skin.parts);
  std::vector<Stroke> strokes;
  strokes.reserve(edges.size());
  for (const auto& [a, b] : edges) strokes.push_back({{vertices[a], vertices[b]}, colours[skin.part[a]]});
  return strokes;
}

}  // namespace tensegric_fit::inspect
