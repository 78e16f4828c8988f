#include "inspect/fit_pictures.hpp"

#include <algorithm>

#include "inspect/composition.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr int kPanel = 600;  // pixels
constexpr Colour kGarmentColour{176, 44, 84}, kBorderInk{52, 50, 48};

View framed(MakeView make, const FitScene& scene) {
  if (scene.parts.empty()) return framed(make, scene.measures.body_from_scan, scene.before.vertices, 1.1);
  std::vector<Eigen::Vector3d> all;
  for (const Part& part : scene.parts) all.insert(all.end(), part.nodes.begin(), part.nodes.end());
  return framed(make, scene.measures.body_from_scan, all, 1.45);
}

std::vector<Polyline> garment_lines(const std::vector<std::vector<Eigen::Vector3d>>& lines,
                                    const Colour& colour) {
  std::vector<Polyline> drawn;
  for (const auto& points : lines) drawn.push_back({points, false, colour});
  return drawn;
}

Part part_of(const std::vector<Eigen::Vector3d>& nodes, const std::vector<Eigen::Vector3i>& triangles,
             const Eigen::Isometry3d& body_from_scan) {
  Part part;
  Eigen::Vector3d faced = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3i& t : triangles) {
    faced += geometry::area_vector(nodes[t[0]], nodes[t[1]], nodes[t[2]]);
    for (int k = 0; k < 3; ++k) part.nodes.push_back(nodes[t[k]]);
  }
  part.behind = (body_from_scan.linear() * faced).x() < 0;
  return part;
}

std::vector<Colour> warned_colours(const FitScene& scene) {
  if (scene.warned.empty()) return {};
  std::vector<Colour> colours(scene.after.size(), kNeutral);
  for (const int v : scene.warned) colours[v] = kWarnedColour;
  return colours;
}

// The border of the skin that there is a warning of: one line per side of a triangle.
std::vector<Polyline> warned_borders(const FitScene& scene) {
  std::vector<char> warned(scene.after.size(), 0);
  for (const int v : scene.warned) warned[v] = 1;
  geometry::TriangleMesh skin;
  skin.vertices = scene.after;
  for (const Eigen::Vector3i& t : scene.before.triangles)
    if (warned[t[0]] && warned[t[1]] && warned[t[2]]) skin.triangles.push_back(t);
  std::vector<Polyline> borders;
  const std::vector<geometry::TriangleSide> sides = geometry::sorted_sides(skin);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto same = [&](std::size_t other) {
      return other < sides.size() && sides[other].low == sides[i].low && sides[other].high == sides[i].high;
    };
    if (!same(i + 1) && (i == 0 || !same(i - 1)))
      borders.push_back({{scene.after[sides[i].low], scene.after[sides[i].high]}, false, kBorderInk, 0});
  }
  return borders;
}

cv::Mat before_and_after(const FitScene& scene, MakeView make) {
  const View view = framed(make, scene);
  const cv::Mat left = draw(scene.before, {}, garment_lines(scene.lines_before, kGarmentColour), view, kPanel,
                            kPanel, scene.normals_before);
  const cv::Mat right =
      draw({scene.after, scene.before.triangles}, warned_colours(scene),
           garment_lines(scene.lines_after, kGarmentColour), view, kPanel, kPanel, scene.normals_after);
  const char* after = scene.warned.empty() ? "after" : "after; orange: the skin folds";
  return side_by_side(with_caption(left, "before"), with_caption(right, after));
}

}  // namespace

std::vector<Part> parts_of(const geometry::ControlMesh& control, const Eigen::Isometry3d& body_from_scan) {
  std::vector<Part> parts;
  for (const geometry::ControlRegion& region : control.regions)
    parts.push_back(part_of(control.outer, geometry::region_triangles(control, region), body_from_scan));
  return parts;
}

std::vector<Part> parts_of(const geometry::TriangleMesh& control, const Eigen::Isometry3d& body_from_scan) {
  std::vector<std::vector<Eigen::Vector3i>> pieces;
  const std::vector<int> piece = geometry::components_of(control);
  for (std::size_t t = 0; t < piece.size(); ++t) {
    pieces.resize(std::max<std::size_t>(pieces.size(), piece[t] + 1));
    pieces[piece[t]].push_back(control.triangles[t]);
  }
  std::vector<Part> parts;
  for (const auto& triangles : pieces) parts.push_back(part_of(control.vertices, triangles, body_from_scan));
  return parts;
}

cv::Mat front_picture(const FitScene& scene) {
  return before_and_after(scene, front_view);
}
cv::Mat side_picture(const FitScene& scene) {
  return before_and_after(scene, side_view);
}
cv::Mat back_picture(const FitScene& scene) {
  return before_and_after(scene, back_view);
}

cv::Mat distortion_picture(const FitScene& scene) {
  const geometry::TriangleMesh after{scene.after, scene.before.triangles};
  const std::vector<Colour> colours = distortion_colours(scene.distortion);
  std::vector<Polyline> lines = garment_lines(scene.lines_after, kBorderInk);
  for (Polyline& border : warned_borders(scene)) lines.push_back(std::move(border));
  std::vector<Part> rows = scene.parts;
  if (rows.empty() || rows.size() > kMostRows) rows = {{scene.before.vertices, false}};
  std::vector<cv::Mat> pictures;
  for (const Part& row : rows) {
    const auto from = [&](MakeView make) {
      return draw(after, colours, lines, framed(make, scene.measures.body_from_scan, row.nodes, 1.45), kPanel,
                  kPanel, scene.normals_after);
    };
    pictures.push_back(row.behind ? side_by_side(from(back_view), from(oblique_back_view))
                                  : side_by_side(from(front_view), from(oblique_view)));
  }
  cv::Mat picture;
  cv::vconcat(pictures, picture);
  return with_distortion_scale(with_caption(
      picture, scene.warned.empty() ? "area of the skin after / before"
                                    : "area of the skin after / before; outlined: the skin folds"));
}

}  // namespace tensegric_fit::inspect
