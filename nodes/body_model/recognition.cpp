#include "body_model/recognition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "body_model/matching.hpp"
#include "geometry/oriented_tree.hpp"
#include "geometry/parallel_for.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/status.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Vector3d;

// Limits between women and things, by tests/body_model/recognise.py: training women's surfaces and scans,
// women of another make; 31 things.
constexpr double kMisfit =
    0.006;                      // m; women 0.004 at most, things that are refused by it alone 0.007 at least
constexpr double kShape = 3.3;  // women 2.9 at most, a pole that misfits by 0.004 m 3.6
constexpr double kUnexplained = 0.25;  // of the surface; women 0.02 at most, things that are refused by it
                                       // alone 0.33 at least, two persons 0.5
constexpr double kShortest = 1.2, kTallest = 2.2;  // m, of grown-up people
// Deviations (tests/body_model/recognise.py): women of the model's own kind have 1.24 at most; what is
// clearly above gets a word and is measured all the same, so the limit need not be sharp.
constexpr double kOfItsKind = 1.25, kUnusual = 1.6;

constexpr int kJudgedSamples = 6000;  // that are asked: 17 mm apart on a woman
constexpr double kTogether = 0.06;    // m; nearer ones are one thing

std::size_t asked(const Samples& samples) {
  return std::min<std::size_t>(kJudgedSamples, samples.points.size());
}

/// Of each sample that is asked: m from her skin, and the vertex of the skin there.
struct Off {
  std::vector<double> distances;
  std::vector<int> nearest;
};

Off off_skin(const RegisteredBody& body, const Samples& samples) {
  const geometry::PointTree tree(body.skin);
  Off off{std::vector<double>(asked(samples)), std::vector<int>(asked(samples))};
  geometry::parallel_for(off.nearest.size(), [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t s = begin; s < end; ++s) {
      off.nearest[s] = tree.nearest(samples.points[s]);
      off.distances[s] = (body.skin[off.nearest[s]] - samples.points[s]).norm();
    }
  });
  return off;
}

double share_off(const Off& off) {
  const auto far =
      std::count_if(off.distances.begin(), off.distances.end(), [](double d) { return d > kOff; });
  return static_cast<double>(far) / static_cast<double>(off.distances.size());
}

/// m, of the samples that are hers from the posed skin, along its normal.
double misfit_of(const RegisteredBody& body, const Samples& samples, const Off& off) {
  const std::vector<Vector3d> normals = geometry::vertex_normals(body.posed, body.model->triangles);
  const geometry::OrientedTree tree(body.posed, normals);
  std::vector<double> distances(off.distances.size(), -1);
  geometry::parallel_for(distances.size(), [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t s = begin; s < end; ++s) {
      if (off.distances[s] > kOff) continue;
      const int v = tree.nearest(samples.points[s], samples.normals[s]);
      const bool matched = normals[v].dot(samples.normals[s]) > Matching::kSameSide;
      distances[s] =
          matched ? std::min(std::abs((samples.points[s] - body.posed[v]).dot(normals[v])), kOff) : kOff;
    }
  });
  double sum = 0;
  int count = 0;
  for (const double d : distances) {
    if (d < 0) continue;
    sum += d;
    ++count;
  }
  return count > 0 ? sum / count : kOff;
}

/// \throw Refusal not_a_body
void check(const Evidence& e, double stature) {
  std::string why;
  if (e.unexplained > kUnexplained) {
    why = fmt::format("{:.0f} % of the surface is not hers: a thing, or more than one person",
                      100 * e.unexplained);
  } else if (!(stature > kShortest && stature < kTallest)) {
    why = "nobody has that size";
  } else if (e.misfit > kMisfit) {
    why = "no person's shape comes near";
  } else if (e.shape > kShape) {
    why = "no person has that shape";
  } else {
    return;
  }
  throw geometry::Refusal(geometry::refusal::kNotABody,
                          fmt::format("{} (the most similar woman is {:.2f} m tall ({} to {}), {:.1f} mm off "
                                      "({:.0f} at most), {:.1f} deviations from the mean ({} at most); "
                                      "{:.0f} % of the surface is not hers ({:.0f} at most))",
                                      why, stature, kShortest, kTallest, 1e3 * e.misfit, 1e3 * kMisfit,
                                      e.shape, kShape, 100 * e.unexplained, 100 * kUnexplained));
}

/// Groups of samples off the skin, each as indices, in order of their first.
std::vector<std::vector<int>> things_off(const Samples& samples, const Off& off) {
  std::vector<int> left;
  for (std::size_t s = 0; s < off.distances.size(); ++s)
    if (off.distances[s] > kOff) left.push_back(static_cast<int>(s));
  std::vector<std::vector<int>> things;
  while (!left.empty()) {
    std::vector<int> thing{left.front()};
    left.erase(left.begin());
    for (std::size_t i = 0; i < thing.size(); ++i) {
      const Vector3d at = samples.points[thing[i]];
      const auto near = std::stable_partition(
          left.begin(), left.end(), [&](int s) { return (samples.points[s] - at).norm() > kTogether; });
      thing.insert(thing.end(), near, left.end());
      left.erase(near, left.end());
    }
    things.push_back(std::move(thing));
  }
  return things;
}

std::string guess(const std::string& part, double farthest) {
  if (part == "head" || part == "neck") return "hair or something worn";
  if (farthest > 0.3)
    return "a thing or another person";  // m: beyond arm's breadth of a limb that is posed wrongly
  if (part == "trunk" || part == "breast_L" || part == "breast_R")
    return "hair, something worn or held, or an arm";
  return "something worn or held, or a limb that is bent otherwise";
}

Unexplained described(const std::vector<int>& thing, const RegisteredBody& body, const Samples& samples,
                      const Off& off) {
  Unexplained result{
      Vector3d::Zero(), 0, static_cast<double>(thing.size()) / static_cast<double>(off.distances.size()), {}};
  double farthest = 0;
  std::vector<int> of_part(body.model->parts.size(), 0);
  for (const int s : thing) {
    result.centre += samples.points[s] / static_cast<double>(thing.size());
    farthest = std::max(farthest, off.distances[s]);
    ++of_part[body.model->part[off.nearest[s]]];
  }
  for (const int a : thing)
    for (const int b : thing)
      result.extent = std::max(result.extent, (samples.points[a] - samples.points[b]).norm());
  const std::string& part =
      body.model->parts[std::max_element(of_part.begin(), of_part.end()) - of_part.begin()];
  result.reason = fmt::format(
      "{:.1f} % of the surface, {:.0f} mm across, up to {:.0f} mm off her skin, nearest to {}: {}",
      100 * result.share, 1e3 * result.extent, 1e3 * farthest, part, guess(part, farthest));
  return result;
}

}  // namespace

std::vector<char> recognise(RegisteredBody& body, const Samples& samples) {
  const Off off = off_skin(body, samples);
  const Eigen::VectorXd& shape = body.parameters.shape;
  body.evidence = {misfit_of(body, samples, off), share_off(off),
                   std::sqrt(shape.squaredNorm() / static_cast<double>(shape.size()))};
  check(body.evidence, body.stature());
  body.unexplained.clear();
  std::vector<char> is_of_thing(off.distances.size(), 0);
  for (const std::vector<int>& thing : things_off(samples, off)) {
    if (static_cast<double>(thing.size()) < kLeastThing * static_cast<double>(off.distances.size())) continue;
    body.unexplained.push_back(described(thing, body, samples, off));
    for (const int s : thing) is_of_thing[s] = 1;
  }
  std::stable_sort(body.unexplained.begin(), body.unexplained.end(),
                   [](const Unexplained& a, const Unexplained& b) { return a.share > b.share; });
  body.note.clear();
  if (body.evidence.shape > kUnusual)
    body.note = fmt::format(
        "an unusual shape for the body model: {:.1f} deviations from its mean, where women of its own kind "
        "have "
        "{} at most; clothes, padding, a man or another make of body can be the reason",
        body.evidence.shape, kOfItsKind);
  return is_of_thing;
}

}  // namespace tensegric_fit::body_model
