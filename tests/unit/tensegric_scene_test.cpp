// Pieces that nothing touches, the body's volume, posture.
#include <gtest/gtest.h>

#include <cstring>

#include "geometry/status.hpp"
#include "tensegric/solver.hpp"
#include "tensegric_bust.hpp"

namespace tensegric_fit::tensegric {
namespace {

// Two busts, one `down` below the other, as bust and hips are: pieces of one control mesh.
geometry::ControlMesh two_pieces() {
  geometry::ControlMesh upper = bust_mesh(), lower = upper;
  for (auto* layer : {&lower.outer, &lower.inner})
    for (Eigen::Vector3d& p : *layer) p.z() -= 0.5;
  for (std::string& name : lower.names)
    if (!name.empty()) name = "lower_" + name;
  lower.lines[0].name = "belt";
  lower.regions[0].name = "hips";
  return geometry::joined({upper, lower});
}

Garment on_both(double chest_ratio, double belt_ratio) {
  Garment both = chest(chest_ratio);
  both.lines.push_back(chest(belt_ratio, "belt").lines[0]);
  return both;
}

bool same_bits(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b, std::size_t from,
               std::size_t to) {
  return std::memcmp(a.data() + from, b.data() + from, (to - from) * sizeof(Eigen::Vector3d)) == 0;
}

TEST(Pieces, AreLeftAloneWhereNoLineTouchesThem) {
  const geometry::ControlMesh control = two_pieces();
  const Model model = build_model(control, {}), single = build_model(bust_mesh(), {});
  const std::size_t half = control.outer.size() / 2, all = control.outer.size();
  for (SolverName solver : {SolverName::equilibrium, SolverName::relaxation}) {
    SolverOptions options;
    options.solver = solver;
    options.max_iterations = 200;
    const Solution upper = solve(model, chest(0.90), options);
    EXPECT_TRUE(same_bits(upper.outer, control.outer, half, all));
    EXPECT_TRUE(same_bits(upper.inner, control.inner, half, all));
    EXPECT_GT(
        (upper.outer[control.node("bust_point_L")] - control.outer[control.node("bust_point_L")]).norm(),
        1e-3);
    // From there to a garment of the other piece: the first one goes back to rest.
    const Solution lower = solve(model, chest(0.90, "belt"), options, &upper);
    EXPECT_TRUE(same_bits(lower.outer, control.outer, 0, half));
    EXPECT_TRUE(same_bits(lower.inner, control.inner, 0, half));
    ASSERT_EQ(lower.regions.size(), 2U);
    EXPECT_EQ(lower.regions[0].volume_after, lower.regions[0].volume_before);
  }
  const Solution upper = solve(model, chest(0.90), {}), alone = solve(single, chest(0.90), {});
  EXPECT_EQ(upper.status, Status::converged);
  EXPECT_EQ(upper.iterations, alone.iterations);
  // The prestress of two pieces is levelled together: equal to rounding.
  for (std::size_t i = 0; i < half; ++i) EXPECT_LE((upper.outer[i] - alone.outer[i]).norm(), 1e-9);

  const Solution bare = solve(model, {}, {});
  EXPECT_EQ(bare.status, Status::converged);
  EXPECT_TRUE(same_bits(bare.outer, control.outer, 0, all));
}

TEST(Pieces, WornTogetherEachKeepsItsVolume) {
  const Model model = build_model(two_pieces(), {});
  Garment both = on_both(0.92, 0.88);
  const Solution s = solve(model, both, {});
  EXPECT_EQ(s.status, Status::converged) << s.note;
  for (const RegionResult& r : s.regions) EXPECT_NEAR(r.volume_after / r.volume_before, 1, 1e-9);
  for (const LineResult& line : s.lines) EXPECT_NEAR(line.final / line.neutral, 1, 1e-6);
  // To the bit as each alone.
  const std::size_t all = s.outer.size(), half = all / 2;
  const Solution upper = solve(model, chest(0.92), {}), lower = solve(model, chest(0.88, "belt"), {});
  EXPECT_TRUE(same_bits(s.outer, upper.outer, 0, half));
  EXPECT_TRUE(same_bits(s.outer, lower.outer, half, all));
  EXPECT_EQ(s.lines[0].tension, upper.lines[0].tension);
  EXPECT_EQ(s.lines[1].tension, lower.lines[0].tension);
  EXPECT_EQ(s.iterations, upper.iterations + lower.iterations);
  // Of both in each row, in the order of the iterations.
  ASSERT_EQ(s.history.size(), static_cast<std::size_t>(s.iterations) + 1);
  for (std::size_t i = 0; i < s.history.size(); ++i) {
    EXPECT_EQ(s.history[i].iteration, static_cast<int>(i));
    EXPECT_EQ(s.history[i].line_ratios.size(), 2U);
  }
  for (std::size_t b = 0; b < 2; ++b)
    EXPECT_EQ(s.history.back().line_ratios[b], s.lines[b].final / s.lines[b].initial);
  // Warm, too.
  Garment tighter = both;
  tighter.lines[1].ratio = 0.86;
  const Solution warm = solve(model, tighter, {}, &s);
  EXPECT_EQ(warm.status, Status::converged) << warm.note;
  EXPECT_LT(warm.iterations, solve(model, tighter, {}).iterations);
  EXPECT_NEAR(warm.lines[0].final / s.lines[0].final, 1, 1e-9);
  // And a cap is on both together.
  SolverOptions few;
  few.max_iterations = upper.iterations + 1;
  const Solution cut = solve(model, both, few);
  EXPECT_EQ(cut.status, Status::capped);
  EXPECT_EQ(cut.iterations, few.max_iterations);
}

// How far a bust point has come inwards; as far as that the skin is taken to turn over.
double depth_of(const geometry::ControlMesh& control, const std::string& name,
                const std::vector<Eigen::Vector3d>& outer) {
  const int node = control.node(name);
  return (outer[node] - control.outer[node]).norm();
}

TEST(Pieces, OneThatIsTooTightLeavesTheOtherAsAsked) {
  const geometry::ControlMesh control = two_pieces();
  const Model model = build_model(control, {});
  Garment both = on_both(0.92, 0.85);
  const Solution smooth = solve(model, both, {});
  const double most = 0.6 * depth_of(control, "lower_bust_point_L", smooth.outer);
  const SkinFolds folds = [&](const auto& outer, const auto&) {
    return depth_of(control, "lower_bust_point_L", outer) > most;
  };
  const Solution s = solve(model, both, {}, nullptr, {}, {}, {}, folds);
  EXPECT_EQ(s.status, Status::infeasible);
  EXPECT_EQ(s.note.rfind("In hips: ", 0), 0U) << s.note;
  EXPECT_EQ(s.lines[0].final, smooth.lines[0].final);
  EXPECT_GT(s.lines[1].final, 1.02 * s.lines[1].neutral);
  EXPECT_LE(depth_of(control, "lower_bust_point_L", s.outer), most);
}

// As one between two points of the rim.
TEST(Pieces, ALineThatNothingCanMoveJoinsNothing) {
  const geometry::ControlMesh control = two_pieces();
  const Model model = build_model(control, {});
  Garment both = on_both(0.92, 0.88);
  const Solution without = solve(model, both, {});
  GarmentLine held;
  held.name = "held";
  held.ratio = 0.95;
  held.points = {{0, 0, 1}, {0.1, 0, 1}};
  both.lines.push_back(held);
  geometry::LaidLine laid;
  geometry::Fibre fibre{1, {{held.points[0], {}}, {held.points[1], {}}}};
  laid.fibres = {fibre};
  laid.name = held.name;
  const Solution s = solve(model, both, {}, nullptr, {}, {}, {laid});
  EXPECT_EQ(s.status, Status::infeasible) << s.note;
  EXPECT_EQ(s.outer, without.outer);
  EXPECT_EQ(s.note.find("In :"), std::string::npos) << s.note;
  ASSERT_EQ(s.lines.size(), 3U);
  EXPECT_NEAR(s.lines[2].straight, 0.1, 1e-12);
}

TEST(Pieces, SkinThatFollowsBothGoesBackWithBoth) {
  const geometry::ControlMesh control = two_pieces();
  const Model model = build_model(control, {});
  Garment both = on_both(0.92, 0.92);
  const Solution smooth = solve(model, both, {});
  const auto sum = [&](const std::vector<Eigen::Vector3d>& outer) {
    return depth_of(control, "bust_point_L", outer) + depth_of(control, "lower_bust_point_L", outer);
  };
  const double most = 0.7 * sum(smooth.outer);  // more than one of them comes to
  const SkinFolds folds = [&](const auto& outer, const auto&) { return sum(outer) > most; };
  const Solution s = solve(model, both, {}, nullptr, {}, {}, {}, folds);
  EXPECT_EQ(s.status, Status::infeasible) << s.note;
  EXPECT_LE(sum(s.outer), most);
  for (const LineResult& line : s.lines) EXPECT_GT(line.final, 1.01 * line.neutral);
}

// As t-FFD moves a body: a closed skin, each vertex of which follows some nodes in constant shares. Here it
// is the patch at `depth` below the skin, closed to an apex that only a posture moves.
PosedVolume layer_volume(const geometry::ControlMesh& control, double depth,
                         const geometry::BoneFrames& bones = {}) {
  const std::size_t count = control.outer.size();
  const Eigen::Vector3d at_rest = geometry::region_apex(control, control.regions[0]);
  const auto triangles = control.triangles;
  return [=](double share) {
    return [=, apex = bones.moved(at_rest, share)](const Positions& nodes, Positions* gradient) {
      Positions layer(count);
      for (std::size_t i = 0; i < count; ++i) layer[i] = (1 - depth) * nodes[i] + depth * nodes[count + i];
      if (gradient != nullptr) {
        gradient->assign(2 * count, Eigen::Vector3d::Zero());
        for (const Eigen::Vector3i& t : triangles)
          for (int k = 0; k < 3; ++k) {
            const Eigen::Vector3d g = (layer[t[(k + 1) % 3]] - apex).cross(layer[t[(k + 2) % 3]] - apex) / 6;
            (*gradient)[t[k]] += (1 - depth) * g;
            (*gradient)[static_cast<int>(count) + t[k]] += depth * g;
          }
      }
      return geometry::cone_volume(layer, triangles, apex);
    };
  };
}

TEST(BodyVolume, IsKeptInPlaceOfTheControlVolume) {
  const geometry::ControlMesh control = bust_mesh();
  const Model model = build_model(control, {});
  const PosedVolume body_at = layer_volume(control, 0.3);
  const VolumeFunction body = body_at(0);
  const double rest = body(model.rest_positions(), nullptr);
  SolverOptions options;
  options.volume = KeptVolume::body;
  for (double ratio : {0.97, 0.90}) {
    const Solution s = solve(model, chest(ratio), options, nullptr, {}, {body_at});
    EXPECT_EQ(s.status, Status::converged) << s.note;
    EXPECT_LE(s.residual, 1e-8);
    EXPECT_NEAR(s.lines[0].final / s.lines[0].neutral, 1, 1e-6);
    Positions x = s.outer;
    x.insert(x.end(), s.inner.begin(), s.inner.end());
    EXPECT_NEAR(body(x, nullptr) / rest, 1, 1e-9);
    // The report goes on about the control mesh, whose volume is another.
    EXPECT_DOUBLE_EQ(s.regions[0].volume_before,
                     geometry::cone_volume(control.outer, control.triangles,
                                           geometry::region_apex(control, control.regions[0])));
    EXPECT_GT(std::abs(s.regions[0].volume_after / s.regions[0].volume_before - 1), 1e-5);
    EXPECT_NEAR(s.history.back().volume_errors[0], 0, 1e-9);
  }
  // The papers' solvers hold it as well as they can: better than where they hold the control volume.
  options.solver = SolverName::adaptive;
  const Solution kept = solve(model, chest(0.95), options, nullptr, {}, {body_at});
  EXPECT_LE(std::abs(kept.history.back().volume_errors[0]), 0.01);
}

TEST(BodyVolume, IsRefusedWhereItIsNotGiven) {
  const geometry::ControlMesh control = bust_mesh();
  const Model model = build_model(control, {});
  SolverOptions options;
  options.volume = KeptVolume::body;
  const auto code = [&](const std::vector<PosedVolume>& bodies) {
    try {
      solve(model, chest(0.95), options, nullptr, {}, bodies);
    } catch (const geometry::Refusal& r) {
      return r.code();
    }
    return std::string("solved");
  };
  EXPECT_EQ(code({}), "bad_option");
  EXPECT_EQ(code({PosedVolume()}), "bad_option");
  EXPECT_EQ(code({layer_volume(control, 0), layer_volume(control, 0)}), "bad_option");
  const VolumeFunction rigid = [](const Positions& x, Positions* gradient) {  // does not follow the nodes
    if (gradient != nullptr) gradient->assign(x.size(), Eigen::Vector3d::Zero());
    return 1.0;
  };
  EXPECT_EQ(code({[rigid](double) { return rigid; }}), "bad_option");
  EXPECT_EQ(code({layer_volume(control, 0.1)}), "solved");
}

constexpr double kPoseRounding = 1e-14;  // m: the solver turns bones in a frame near the nodes

geometry::BoneFrames bones(double twist, double lean) {
  geometry::Spine spine;
  spine.y = 0.05;
  spine.pelvis = 1.0;
  spine.chest = 1.3;
  return {spine, {twist, lean}};
}

TEST(PostureOfBones, BoundNodesGoWithThemAndTheSkinSettles) {
  const geometry::ControlMesh control = bust_mesh();
  const Model model = build_model(control, {});
  for (const auto& [twist, lean] : {std::pair{0.3, 0.0}, {0.0, 0.3}, {-0.8, 0.2}}) {
    SolverOptions options;
    options.bones = bones(twist, lean);
    for (double ratio : {1.2, 0.95}) {
      const Solution s = solve(model, chest(ratio), options);
      EXPECT_EQ(s.status, Status::converged) << s.note;
      EXPECT_LE(s.residual, 1e-8);
      EXPECT_LE(s.lines[0].final / s.lines[0].neutral, 1 + 1e-6);
      double largest = 0;
      for (std::size_t i = 0; i < control.outer.size(); ++i) {
        EXPECT_LE((s.inner[i] - options.bones.moved(control.inner[i])).norm(), kPoseRounding);
        const Eigen::Vector3d carried = options.bones.moved(control.outer[i]);
        if (control.outer_fixed[i]) {
          EXPECT_LE((s.outer[i] - carried).norm(), kPoseRounding);
        }
        largest = std::max(largest, (s.outer[i] - control.outer[i]).norm());
        EXPECT_LE((s.outer[i] - carried).norm(), 0.03);  // the skin stays over its bones
      }
      EXPECT_GT(largest, 0.02);
      const Eigen::Vector3d apex = geometry::region_apex(control, control.regions[0]);
      EXPECT_NEAR(geometry::cone_volume(s.outer, control.triangles, options.bones.moved(apex)) /
                      geometry::cone_volume(control.outer, control.triangles, apex),
                  1, 1e-9);
      EXPECT_NEAR(s.regions[0].volume_after / s.regions[0].volume_before, 1, 1e-9);
    }
  }
}

TEST(PostureOfBones, TheBodysVolumeIsThatOfTheScansPosture) {
  const geometry::ControlMesh control = bust_mesh();
  const Model model = build_model(control, {});
  for (const auto& [twist, lean] : {std::pair{0.3, 0.0}, {0.0, 0.3}, {-0.8, 0.2}}) {
    SolverOptions options;
    options.bones = bones(twist, lean);
    options.volume = KeptVolume::body;
    const PosedVolume body = layer_volume(control, 0.3, options.bones);
    const Solution s = solve(model, chest(0.95), options, nullptr, {}, {body});
    EXPECT_EQ(s.status, Status::converged) << s.note;
    Positions x = s.outer;
    x.insert(x.end(), s.inner.begin(), s.inner.end());
    EXPECT_NEAR(body(1)(x, nullptr) / body(0)(model.rest_positions(), nullptr), 1, 1e-9);
  }
}

TEST(PostureOfBones, WarmStartsStayInOnePostureAndAnotherOneStartsFromRest) {
  const Model model = build_model(bust_mesh(), {});
  SolverOptions turned;
  turned.bones = bones(0.3, 0);
  const Solution first = solve(model, chest(0.95), turned);
  const Solution warm = solve(model, chest(0.94), turned, &first), cold = solve(model, chest(0.94), turned);
  EXPECT_EQ(warm.status, Status::converged);
  EXPECT_LT(warm.iterations, cold.iterations);
  for (std::size_t i = 0; i < warm.outer.size(); ++i)
    EXPECT_LE((warm.outer[i] - cold.outer[i]).norm(),
              1e-8);  // both are balanced to 1e-10 of the mean tension
  const Solution back = solve(model, chest(0.94), {}, &first), straight = solve(model, chest(0.94), {});
  EXPECT_EQ(back.outer, straight.outer);
}

TEST(PostureOfBones, PapersSolversTakeItToo) {
  const geometry::ControlMesh control = bust_mesh();
  const Model model = build_model(control, {});
  SolverOptions options;
  options.bones = bones(0.3, 0.1);
  options.solver = SolverName::adaptive;
  const Solution s = solve(model, chest(0.97), options);
  EXPECT_EQ(s.status, Status::converged);
  for (std::size_t i = 0; i < control.outer.size(); ++i)
    EXPECT_LE((s.inner[i] - options.bones.moved(control.inner[i])).norm(), kPoseRounding);
  EXPECT_NEAR(s.regions[0].volume_after / s.regions[0].volume_before, 1, 0.05);  // pseudo forces (P1 §4)
}

}  // namespace
}  // namespace tensegric_fit::tensegric
