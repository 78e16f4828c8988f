#include "tffd/binding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "geometry/status.hpp"
#include "point_lists.hpp"
#include "refusal_of.hpp"
#include "tffd_shapes.hpp"

namespace tensegric_fit::tffd {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points affine_image(const Points& points) {
  Eigen::Matrix3d a;
  a << 1.10, 0.12, -0.05, 0.02, 0.93, 0.07, -0.03, 0.04, 1.21;
  Points image;
  for (const Eigen::Vector3d& p : points) image.push_back(a * p + Eigen::Vector3d(0.1, -0.2, 0.05));
  return image;
}

std::string code_of(const geometry::TriangleMesh& body, const geometry::ControlMesh& control,
                    const Options& options) {
  try {
    Binding(body, control, options);
  } catch (const geometry::Refusal& refusal) {
    return refusal.code();
  }
  return "";
}

// Largest difference of displacement along an edge from a vertex that cannot move to one that can.
double step_at_border(int count, double amplitude) {
  const geometry::TriangleMesh body = slab(count);
  const geometry::ControlMesh control = patch();
  const Binding binding(body, control, {});
  const Moved moved = squeezed(control, amplitude);
  const Points after = binding.deform(moved.outer, moved.inner);
  double step = 0;
  for (const geometry::Edge& edge : geometry::edges_of(body)) {
    if (binding.reaches(edge.first) == binding.reaches(edge.second)) continue;
    for (const int v : {edge.first, edge.second}) step = std::max(step, (after[v] - body.vertices[v]).norm());
  }
  return step;
}

TEST(Binding, NodesAtRestMoveNothing) {
  const geometry::TriangleMesh body = slab(61);
  const geometry::ControlMesh control = patch();
  EXPECT_TRUE(same_bits(Binding(body, control, {}).deform(control.outer, control.inner), body.vertices));

  Options paper;
  paper.setting = Setting::paper;
  const Points after = Binding(body, control, paper).deform(control.outer, control.inner);
  EXPECT_LT(farthest(after, body.vertices), 1e-12);  // rounding of coordinates below 1 m
}

TEST(Binding, ReproducesAffineMaps) {
  // Inside, on and far outside a closed control mesh: from the local kernels to the global one.
  const geometry::ControlMesh control = ball();
  for (const double radius : {0.02, 0.1, 0.15, 0.2, 0.5}) {
    const geometry::TriangleMesh body = sphere(radius, 20);
    const Points after =
        Binding(body, control, {}).deform(affine_image(control.outer), affine_image(control.inner));
    EXPECT_LT(farthest(after, affine_image(body.vertices)), 1e-12) << radius;
  }
}

TEST(Binding, ReproducesAffineMapsOverThePatch) {
  const geometry::TriangleMesh body = slab(61);
  const geometry::ControlMesh control = patch();
  const Binding binding(body, control, {});
  const Points after = binding.deform(affine_image(control.outer), affine_image(control.inner));
  const Points image = affine_image(body.vertices);
  std::size_t full = 0;
  for (const Anchor& anchor : binding.anchors()) {
    const Eigen::Vector3d& q = body.vertices[anchor.vertex];
    const Eigen::Vector3d expected = q + anchor.share * (image[anchor.vertex] - q);
    EXPECT_LT((after[anchor.vertex] - expected).norm(), 1e-12);
    full += anchor.share == 1;
  }
  // All over triangles without a node on the fixed rim: 6 x 4 of the patch's 8 x 6 cells, by their outline.
  EXPECT_GT(full, 0.48 * binding.anchors().size());
}

// Units a quarter of a millimetre thick: skin a few millimetres over them lies many thicknesses away.
TEST(Binding, FlatUnitsDoNotCarrySkinFarBeyondTheirNodes) {
  const geometry::TriangleMesh body = slab(61);
  geometry::ControlMesh control = patch();
  for (int r = 3; r < 5; ++r)
    for (int c = 4; c < 6; ++c) {
      const int node = 9 * r + c;
      control.inner[node] = control.outer[node] + 0.01 * (control.inner[node] - control.outer[node]);
    }
  const Binding binding(body, control, {});
  double largest = 0;
  const SparseRows& rows = binding.weights().nodes;
  for (const Anchor& anchor : binding.anchors()) {
    double sum = 0;
    for (SparseRows::InnerIterator entry(rows, anchor.vertex); entry; ++entry) sum += std::abs(entry.value());
    largest = std::max(largest, sum / anchor.share);
  }
  // No more is taken from such units than need be: 30 halvings of a power that is 64 at most.
  EXPECT_NEAR(largest, 3, 1e-7);
  const Points after = binding.deform(affine_image(control.outer), affine_image(control.inner));
  const Points image = affine_image(body.vertices);
  for (const Anchor& anchor : binding.anchors()) {
    const Eigen::Vector3d& q = body.vertices[anchor.vertex];
    const Eigen::Vector3d expected = q + anchor.share * (image[anchor.vertex] - q);
    EXPECT_LT((after[anchor.vertex] - expected).norm(), 1e-12);
  }
}

TEST(Binding, LeavesWhatThePatchDoesNotCover) {
  const int count = 61;
  const geometry::TriangleMesh body = slab(count);
  const geometry::ControlMesh control = patch();
  const Binding binding(body, control, {});
  const Moved moved = squeezed(control, 0.03);
  const Points after = binding.deform(moved.outer, moved.inner);
  std::size_t covered = 0;
  for (int v = 0; v < static_cast<int>(body.vertices.size()); ++v) {
    const Eigen::Vector3d& q = body.vertices[v];
    // 3 mm of slack: the closest point of the sloping patch is not straight below or above.
    const bool inside = v < count * count && std::abs(q.x()) < 0.097 && std::abs(q.y()) < 0.077;
    const bool outside = v >= count * count || std::abs(q.x()) > 0.103 || std::abs(q.y()) > 0.083;
    // The triangles in two of the corners have fixed nodes only.
    const bool corner = std::abs(q.x()) > 0.075 && std::abs(q.y()) > 0.053;
    if (inside && !corner) {
      EXPECT_TRUE(binding.reaches(v)) << q.transpose();
    }
    if (outside) {
      EXPECT_TRUE(!binding.reaches(v) && same_bits(after[v], q)) << q.transpose();
    }
    covered += inside;
  }
  EXPECT_GT(covered, 1000U);
}

// As a nipple's crumple in a scanned mesh: left where it was it held the breast, and a strap pulled
// sixtyfold.
TEST(Binding, ACrumpleAmidCarriedSkinIsCarried) {
  const geometry::TriangleMesh body = slab(121);  // 2.5 mm apart
  geometry::TriangleMesh crumpled = body;
  for (Eigen::Vector3d& p : crumpled.vertices)
    if (p.z() > 0.03 && p.z() < 0.08 && p.head<2>().norm() < 0.004) p.head<2>() *= -0.5;  // inside out
  const auto normals = geometry::vertex_normals(crumpled.vertices, crumpled.triangles);
  const geometry::ControlMesh control = patch();
  const Binding smooth(body, control, {}), binding(crumpled, control, {});
  const auto share = [](const Binding& of, int vertex) {
    for (const Anchor& anchor : of.anchors())
      if (anchor.vertex == vertex) return anchor.share;
    return 0.0;
  };
  int turned = 0;
  for (int v = 0; v < 121 * 121; ++v) {
    if (crumpled.vertices[v].head<2>().norm() > 0.05) continue;
    turned += normals[v].z() < 0;
    EXPECT_NEAR(share(binding, v), share(smooth, v), 1e-12) << crumpled.vertices[v].transpose();
  }
  EXPECT_GT(turned, 0);
  EXPECT_EQ(share(binding, 60 * 121 + 60), 1) << "the tip";
}

TEST(Binding, SkinDoesNotTearAtTheBorder) {
  // A tear is a step that stays when the body gets finer; here it must shrink with the length of the edges.
  const double coarse = step_at_border(61, 0.03), fine = step_at_border(121, 0.03);
  EXPECT_GT(coarse, 0);
  EXPECT_LT(fine, 0.6 * coarse);
  EXPECT_LT(fine, 0.001);  // of edges of 2.5 mm
}

TEST(Binding, SkinFollowsWithoutFolding) {
  const geometry::TriangleMesh body = slab(121);
  const geometry::ControlMesh control = patch();
  const Moved moved = squeezed(control, 0.03);
  const Points after = Binding(body, control, {}).deform(moved.outer, moved.inner);
  // The control mesh's own triangles turn by up to 50 degrees here; the skin may not turn over.
  for (const Eigen::Vector3i& t : body.triangles) {
    const Eigen::Vector3d n =
        geometry::area_vector(body.vertices[t[0]], body.vertices[t[1]], body.vertices[t[2]]);
    EXPECT_GT(n.dot(geometry::area_vector(after[t[0]], after[t[1]], after[t[2]])), 0);
  }
  // The node on top of the bump lies on a body vertex: skin and node move together but for the kernel's
  // smoothing.
  const int top = 3 * 9 + 4, vertex = 60 * 121 + 60;
  ASSERT_LT((body.vertices[vertex] - control.outer[top]).norm(), 1e-12);
  EXPECT_LT((after[vertex] - moved.outer[top]).norm(), 0.1 * (moved.outer[top] - control.outer[top]).norm());
}

TEST(Binding, KeepsMirrorSymmetry) {
  const int count = 61;
  const geometry::TriangleMesh body = slab(count);
  const geometry::ControlMesh control = patch();
  const Moved moved = squeezed(control, 0.02);
  const Points after = Binding(body, control, {}).deform(moved.outer, moved.inner);
  for (int r = 0; r < count; ++r)
    for (int c = 0; c < count; ++c) {
      Eigen::Vector3d mirrored = after[r * count + count - 1 - c];
      mirrored.x() = -mirrored.x();
      EXPECT_LT((after[r * count + c] - mirrored).norm(), 1e-14);  // other order of sums
    }
}

TEST(Binding, IsConstantMatrixOfNodeMotion) {
  const geometry::TriangleMesh body = slab(41);
  const geometry::ControlMesh control = patch();
  const Binding binding(body, control, {});
  const Moved moved = squeezed(control, 0.02);
  const Points after = binding.deform(moved.outer, moved.inner);
  const std::size_t nodes = control.outer.size();
  ASSERT_EQ(binding.weights().nodes.cols(), 2 * nodes);
  ASSERT_EQ(binding.weights().values.cols(), nodes);
  Eigen::MatrixXd motion(2 * nodes, 3);
  for (std::size_t i = 0; i < nodes; ++i) {
    motion.row(i) = (moved.outer[i] - control.outer[i]).transpose();
    motion.row(nodes + i) = (moved.inner[i] - control.inner[i]).transpose();
  }
  const Eigen::MatrixXd moves = binding.weights().nodes * motion;
  const Eigen::VectorXd sums = binding.weights().nodes * Eigen::VectorXd::Ones(2 * nodes);
  const Eigen::VectorXd value_sums = binding.weights().values * Eigen::VectorXd::Ones(nodes);
  for (std::size_t v = 0; v < after.size(); ++v)
    EXPECT_LT((body.vertices[v] + moves.row(v).transpose() - after[v]).norm(), 1e-15);
  for (const Anchor& anchor : binding.anchors()) {
    EXPECT_NEAR(sums[anchor.vertex], anchor.share, 1e-13);
    EXPECT_NEAR(value_sums[anchor.vertex], anchor.share, 1e-13);
  }
}

TEST(Binding, IsDeterministic) {
  const geometry::TriangleMesh body = slab(41);
  const geometry::ControlMesh control = patch();
  const Moved moved = squeezed(control, 0.02);
  EXPECT_TRUE(same_bits(Binding(body, control, {}).deform(moved.outer, moved.inner),
                        Binding(body, control, {}).deform(moved.outer, moved.inner)));
}

TEST(Binding, AFreeRimFadesOutBeyondIt) {
  geometry::ControlMesh control = patch();
  std::fill(control.outer_fixed.begin(), control.outer_fixed.end(), 0);
  std::fill(control.inner_fixed.begin(), control.inner_fixed.end(), 0);
  const geometry::TriangleMesh body = slab(121);
  const Binding binding(body, control, {});
  Points outer = control.outer, inner = control.inner;
  const Eigen::Vector3d shift(0, 0, 0.01);
  for (Points* nodes : {&outer, &inner})
    for (Eigen::Vector3d& p : *nodes) p += shift;
  const Points after = binding.deform(outer, inner);
  const auto lift = [&](int column) {
    return after[60 * 121 + column].z() - body.vertices[60 * 121 + column].z();
  };
  EXPECT_NEAR(lift(60), 0.01, 1e-14);
  EXPECT_EQ(lift(0), 0);  // 50 mm beyond the rim; a triangle reaches 21 mm
  // Steps of 2.5 mm: even fading would be by 1.2 mm each, smooth fading is twice as steep half way.
  for (int c = 0; c < 60; ++c) EXPECT_LT(std::abs(lift(c + 1) - lift(c)), 0.0024) << c;
}

TEST(Binding, FixedNodesOfAClosedControlMeshHoldTheirSkin) {
  geometry::ControlMesh control = ball();
  Points outer = control.outer, inner = control.inner;
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const bool below = control.outer[i].z() < 0.01;
    control.outer_fixed[i] = control.inner_fixed[i] = below;
    if (!below) outer[i].z() += 0.02, inner[i].z() += 0.02;
  }
  const geometry::TriangleMesh body = sphere(0.1, 60);
  const Points after = Binding(body, control, {}).deform(outer, inner);
  for (std::size_t v = 0; v < after.size(); ++v)
    if (body.vertices[v].z() < -0.001) {
      EXPECT_TRUE(same_bits(after[v], body.vertices[v]));
    }
  EXPECT_NEAR(after[0].z(), 0.12, 1e-3);  // the pole; the fixed half is near the end of its triangles' reach
  // The nodes' motion rises by 20 mm over the 50 mm between two bands of them: 2.1 mm an edge, and the share
  // makes it steeper.
  for (const geometry::Edge& edge : geometry::edges_of(body)) {
    const double step =
        (after[edge.first] - body.vertices[edge.first] - after[edge.second] + body.vertices[edge.second])
            .norm();
    EXPECT_LT(step, 2 * 0.02 / 0.05 * (body.vertices[edge.first] - body.vertices[edge.second]).norm());
  }
}

TEST(PaperSetting, OneTriangleByHand) {
  geometry::ControlMesh control;
  control.outer = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  control.inner = {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}};
  control.triangles = {{0, 1, 2}};
  control.outer_fixed = control.inner_fixed = {0, 0, 0};
  control.names.resize(3);
  Options paper;
  paper.setting = Setting::paper;
  // r = (sqrt(2) + 2 sqrt(5)) / 9 = 0.654, so the triangle reaches 2.5 r = 1.635 from (1/3, 1/3, 0).
  const geometry::TriangleMesh body{{{0.2, 0.3, 0.1}, {1 / 3., 1 / 3., 1.63}, {1 / 3., 1 / 3., 1.64}}, {}};
  const Binding binding(body, control, paper);
  // Twice as long along x: u and v scale, the unit normal does not.
  Points after = binding.deform({{0, 0, 0}, {2, 0, 0}, {0, 1, 0}}, control.inner);
  EXPECT_LT((after[0] - Eigen::Vector3d(0.4, 0.3, 0.1)).norm(), 1e-15);
  EXPECT_LT((after[1] - Eigen::Vector3d(2 / 3., 1 / 3., 1.63)).norm(), 1e-15);
  EXPECT_TRUE(same_bits(after[2], body.vertices[2]));
  // A quarter turn about x: z becomes -y for the normal, y becomes z.
  after = binding.deform({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, control.inner);
  EXPECT_LT((after[0] - Eigen::Vector3d(0.2, -0.1, 0.3)).norm(), 1e-15);
  // Values come from the place below a vertex; what the triangle does not reach has none.
  Eigen::Matrix3d values;
  values << 0.5, 0.2, 0.3, 1 / 3., 1 / 3., 1 / 3., 0, 0, 0;
  EXPECT_LT((Eigen::Matrix3d(binding.weights().values) - values).norm(), 1e-15);
}

TEST(PaperSetting, TwoTrianglesByHand) {
  geometry::ControlMesh control;
  control.outer = {{0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  control.inner.assign(4, Eigen::Vector3d::Zero());
  control.triangles = {{0, 1, 2}, {0, 2, 3}};
  control.outer_fixed = control.inner_fixed = {0, 0, 0, 0};
  control.names.resize(4);
  Options paper;
  paper.setting = Setting::paper;
  const double x = 0.25;
  const Binding binding({{{x, 0, 0}}, {}}, control, paper);
  // Lifting node 1 by 0.5 turns the first triangle about x = 0: its image of (x, 0, 0) is (x, 0, x/2). The
  // second one says stay.
  Points outer = control.outer;
  outer[1].z() = 0.5;
  const double r = (2 / 3. + 2 * std::sqrt(1 / 9. + 1)) / 3;
  const double k1 = 1 - (1 / 3. - x) / (2.5 * r), k2 = 1 - (1 / 3. + x) / (2.5 * r);
  EXPECT_LT((binding.deform(outer, control.inner)[0] - Eigen::Vector3d(x, 0, x / 2 * k1 / (k1 + k2))).norm(),
            1e-15);
}

TEST(Binding, RefusesAControlMeshThatCarriesNoSkin) {
  const geometry::ControlMesh control = patch();
  geometry::TriangleMesh elsewhere = slab(21), millimetres = elsewhere, inwards = elsewhere;
  for (Eigen::Vector3d& p : elsewhere.vertices) p.x() += 5;
  for (Eigen::Vector3d& p : millimetres.vertices) p *= 1000;
  for (Eigen::Vector3i& t : inwards.triangles) std::swap(t[1], t[2]);
  for (const geometry::TriangleMesh& body : {elsewhere, millimetres, inwards})
    EXPECT_EQ(code_of(body, control, {}), "bad_mesh");
  Options paper;
  paper.setting = Setting::paper;
  EXPECT_EQ(code_of(elsewhere, control, paper), "bad_mesh");
  geometry::ControlMesh held = control;  // it is to move nothing
  std::fill(held.outer_fixed.begin(), held.outer_fixed.end(), 1);
  std::fill(held.inner_fixed.begin(), held.inner_fixed.end(), 1);
  EXPECT_EQ(code_of(elsewhere, held, {}), "");
}

TEST(Binding, RefusesAShapeThatTakesTooManyWeights) {
  const geometry::ControlMesh control = ball();
  const geometry::TriangleMesh body = sphere(1, 10);  // past the reach of every triangle: all nodes carry it
  const std::vector<Frame> frames = frames_of(control, Axis::inner_to_outer);
  const TriangleGrid grid(frames, 1.3);
  std::vector<Anchor> all;
  for (int v = 0; v < static_cast<int>(body.vertices.size()); ++v) all.push_back({v, 1});
  const auto weigh = [&](std::size_t most) {
    return refusal_of([&] { standard_weights(body, control, frames, {1.3, grid, 0, most}, all, {}); });
  };
  const std::size_t entries = body.vertices.size() * 2 * control.outer.size();
  EXPECT_EQ(weigh(entries), "accepted");
  EXPECT_EQ(weigh(entries - 1), "bad_mesh");
}

TEST(Binding, RefusesByName) {
  const geometry::TriangleMesh body = slab(21);
  geometry::ControlMesh control = patch();
  Options options;
  for (const double beta : {-1.0, 0.5, 21.0, std::nan("")}) {
    options.beta = beta;
    EXPECT_EQ(code_of(body, control, options), "bad_option") << beta;
  }
  EXPECT_EQ(code_of({body.vertices, {}}, control, {}), "bad_mesh");  // no triangles to follow the skin along
  control.inner = control.outer;
  EXPECT_EQ(code_of(body, control, {}), "bad_mesh");  // no thickness
  control = patch();
  control.outer[10] = control.outer[11];
  EXPECT_EQ(code_of(body, control, {}), "bad_mesh");  // a triangle without area
  control = patch();
  control.triangles.clear();
  EXPECT_EQ(code_of(body, control, {}), "bad_mesh");
  control = patch();
  control.inner_fixed.pop_back();
  EXPECT_EQ(code_of(body, control, {}), "bad_mesh");
  control = patch();
  control.inner[3].x() = std::nan("");
  EXPECT_EQ(code_of(body, control, {}), "non_finite");

  control = patch();
  const Binding binding(body, control, {});
  EXPECT_THROW(binding.deform({}, control.inner), geometry::Refusal);
  Points outer = control.outer;
  outer[0].y() = std::nan("");
  EXPECT_THROW(binding.deform(outer, control.inner), geometry::Refusal);
}

}  // namespace
}  // namespace tensegric_fit::tffd
