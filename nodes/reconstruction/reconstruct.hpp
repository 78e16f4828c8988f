/// Points of a scan -> closed body mesh (README.md).
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "body_model/registered_body.hpp"
#include "body_model/samples.hpp"
#include "body_model/standing.hpp"
#include "geometry/fracture.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/range.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::reconstruction {

/// Field defaults are the parameters' defaults.
/// Of Options' fields, in their units.
inline constexpr geometry::Range kBodyTriangles{1000, 1e6}, kPoissonDepth{5, 10}, kMinPoints{500, 1e6},
    kMaxPoints{1e4, 1e8}, kSupportDistance{0.002, 0.05};

struct Options {
  int body_triangles = 62000;  ///< triangles of the body mesh, the size in the papers
  int poisson_depth = 9;  ///< octree depth of the screened Poisson reconstruction: the smallest cells have
                          ///< 1.1 stature / 2^depth; smooth skin gets larger ones
  int min_points = 5000;  ///< fewer points on the body are refused
  int max_points = 10000000;        ///< more points in the scan are refused
  double support_distance = 0.010;  ///< m; a vertex farther than this from every point counts as filled
  /// What a bust garment needs and no more: legs, hands and head come from coarse cells. Figures of the lower
  /// body are up to 5 mm off (crotch), and say nothing of it.
  bool bust_only = false;
};

/// A hole of the scan that was closed.
struct Hole {
  Eigen::Vector3d centre;  ///< scan frame, metres
  double area;             ///< of the filling, m^2
  double confidence;  ///< share of a filling of that area that lies within 4 mm of the skin, on known bodies
};

struct BodyMesh {
  geometry::TriangleMesh mesh;                ///< closed, manifold, outward, scan frame
  std::vector<char> filled;                   ///< per vertex: 1 where no point of the scan supports it
  std::vector<Hole> holes;                    ///< largest first
  std::vector<geometry::Fracture> fractures;  ///< largest first
  std::size_t points_used = 0;                ///< points of the body, after floor, frame and outliers
};

/// What the reconstruction asks of the body model.
struct Anatomy {
  /// Registers the model to a person's oriented points, metres, z up by the booth, in their frame.
  std::function<body_model::RegisteredBody(const body_model::Samples&)> registered;
  body_model::Standing standing;
};

struct Reconstruction {
  BodyMesh body;
  body_model::RegisteredBody model;  ///< in the scan's frame
};

/// \throw Refusal empty_cloud, non_finite, too_few_points, wrong_unit, not_a_body, bad_option ...
Reconstruction reconstruct(const geometry::PointCloud& scan, const Options& options, const Anatomy& anatomy);

}  // namespace tensegric_fit::reconstruction
