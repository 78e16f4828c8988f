#include "fit/picture_files.hpp"

#include <algorithm>
#include <functional>
#include <future>
#include <utility>

#include "body_model/parts.hpp"
#include "geometry/shading_normals.hpp"
#include "inspect/composition.hpp"
#include "inspect/fit_pictures.hpp"
#include "inspect/warning_words.hpp"

namespace tensegric_fit::fit {
namespace {

constexpr int kPanel = 600;  // pixels; the height of a fit's pictures without captions
constexpr int kWhole = 900;  // of a body that is measured only

/// The picture as a file, with a note of what of the body is missing.
PictureFile file(const std::string& name, const cv::Mat& picture, const Body& body) {
  const std::string note = inspect::words::missing(body.measures);
  return {name, inspect::png_bytes(inspect::with_note(picture, note))};
}

using Normals = std::vector<Eigen::Vector3d>;
using MeasuredPicture = cv::Mat (*)(const geometry::TriangleMesh&, const geometry::BodyMeasures&, int,
                                    const inspect::ModelOverlay*, const Normals&);

cv::Mat measured(MeasuredPicture picture, const Body& body, int height, bool overlaid,
                 const Normals& normals) {
  const geometry::TriangleMesh& mesh = body.mesh.mesh;
  if (!overlaid) return picture(mesh, body.measures, height, nullptr, normals);
  const body_model::RegisteredBody& model = *body.model;
  const inspect::ModelSkin skin{model.skin, model.model->quads, model.model->part, model.model->parts};
  const std::vector<unsigned char> parts = body_model::parts_of(mesh, model);
  const inspect::ModelOverlay overlay{skin, parts};
  return picture(mesh, body.measures, height, &overlay, normals);
}

inspect::FitScene scene_of(const Body& body, const Fitting& fitting, const Fit& fit,
                           const std::vector<geometry::FitWarning>& warnings) {
  inspect::FitScene scene{body.mesh.mesh,
                          fit.deformed,
                          fit.distortion,
                          body.measures,
                          inspect::parts_of(fitting.control, body.measures.body_from_scan),
                          {},
                          {}};
  for (const geometry::FitWarning& warning : warnings)
    if (warning.is_warning())
      scene.warned.insert(scene.warned.end(), warning.vertices.begin(), warning.vertices.end());
  for (const auto& line : fit.solution.lines) {
    for (const auto& [fibres, drawn] :
         {std::pair(&line.fibres_at_rest, &scene.lines_before), {&line.fibres, &scene.lines_after}}) {
      if (line.cup) {
        drawn->insert(drawn->end(), fibres->begin(), fibres->end());
        continue;
      }
      drawn->push_back(fibres->front());  // both edges of a band
      if (fibres->size() > 1) drawn->push_back(fibres->back());
    }
  }
  return scene;
}

std::vector<PictureFile> made_at_once(const std::vector<std::function<PictureFile()>>& pictures) {
  std::vector<std::future<PictureFile>> making;
  for (const auto& picture : pictures) making.push_back(std::async(std::launch::async, picture));
  std::vector<PictureFile> files;
  for (std::future<PictureFile>& made : making) files.push_back(made.get());
  return files;
}

}  // namespace

std::vector<PictureFile> pictures_of(const Body& body, const Fitting& fitting, const Fit& fit,
                                     const std::vector<geometry::FitWarning>& warnings,
                                     const PictureWishes& wishes) {
  inspect::FitScene scene = scene_of(body, fitting, fit, warnings);
  const auto normals_of = [&](const std::vector<Eigen::Vector3d>& skin) {
    return geometry::shading_normals(skin, body.mesh.mesh.triangles);
  };
  auto after = std::async(std::launch::async, normals_of, std::cref(fit.deformed));
  scene.normals_before = normals_of(body.mesh.mesh.vertices);
  scene.normals_after = after.get();
  const auto beside_measured = [&](MeasuredPicture picture, const cv::Mat& pictures) {
    if (!wishes.measured) return pictures;
    return inspect::side_by_side(
        inspect::with_caption(measured(picture, body, kPanel, wishes.overlay, scene.normals_before),
                              "measured"),
        pictures);
  };
  std::vector<std::function<PictureFile()>> pictures{
      [&] {
        return file("front.png", beside_measured(inspect::front_picture, inspect::front_picture(scene)),
                    body);
      },
      [&] {
        return file("side.png", beside_measured(inspect::side_picture, inspect::side_picture(scene)), body);
      },
      [&] { return file("distortion.png", inspect::distortion_picture(scene), body); }};
  if (std::any_of(scene.parts.begin(), scene.parts.end(), [](const auto& part) { return part.behind; }))
    pictures.emplace_back([&] { return file("back.png", inspect::back_picture(scene), body); });
  return made_at_once(pictures);
}

std::vector<PictureFile> pictures_of(const Body& body, const PictureWishes& wishes) {
  const Normals normals = geometry::shading_normals(body.mesh.mesh.vertices, body.mesh.mesh.triangles);
  return made_at_once(
      {[&] {
         return file("front.png", measured(inspect::front_picture, body, kWhole, wishes.overlay, normals),
                     body);
       },
       [&] {
         return file("side.png", measured(inspect::side_picture, body, kWhole, wishes.overlay, normals),
                     body);
       }});
}

}  // namespace tensegric_fit::fit
