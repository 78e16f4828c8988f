// What is read on a body's mesh and on the model before it is settled how much each counts.
#include <gtest/gtest.h>

#include <algorithm>

#include "measured_body.hpp"
#include "virtual_booth/random_body.hpp"

namespace tensegric_fit {
namespace {

using Eigen::Vector3d;
using geometry::TriangleMesh;

/// A body of the virtual booth, with the model registered to it.
struct Registered {
  explicit Registered(std::uint64_t seed)
      : body(virtual_booth::random_customer(virtual_booth::Family::model, seed)),
        model(body_model::register_mesh(body_model::shipped_registrar(), body.mesh)) {}

  landmarks::Reading reading(const std::vector<char>& filled = {}) const {
    return landmarks::read_figures(body.mesh, filled, model, landmarks::shipped_precision());
  }

  virtual_body::VirtualBody body;
  body_model::RegisteredBody model;
};

const landmarks::Figure* underbust(const landmarks::Reading& reading, landmarks::Kind kind) {
  for (const landmarks::Figure& figure : reading.figures)
    if (figure.kind == kind && figure.name == "underbust") return &figure;
  return nullptr;
}

TEST(LandmarksReading, TheLevelOfTheFoldsIsSeenWhereBothFoldsAre) {
  const Registered her(3);
  const Vector3d left = her.body.truth.landmark("underbust_L"),
                 right = her.body.truth.landmark("underbust_R");
  for (const auto& [left_seen, right_seen] :
       {std::pair(true, true), {true, false}, {false, true}, {false, false}}) {
    std::vector<char> filled;
    for (const Vector3d& v : her.body.mesh.vertices)
      filled.push_back((!left_seen && (v - left).norm() < 0.08) ||
                       (!right_seen && (v - right).norm() < 0.08));
    const landmarks::Reading reading = her.reading(filled);
    const landmarks::Figure* level = underbust(reading, landmarks::Kind::height);
    ASSERT_NE(level, nullptr);
    EXPECT_EQ(level->seen, left_seen && right_seen) << left_seen << ' ' << right_seen;
  }
}

// By definition the tape is level and 3 mm under the lower of her level of folds and of what the mesh itself
// shows.
TEST(LandmarksReading, TheUnderbustTapeIsJustUnderTheFolds) {
  for (const std::uint64_t seed : {1, 2}) {
    const Registered her(seed);
    const landmarks::Reading reading = her.reading();
    const landmarks::Figure *level = underbust(reading, landmarks::Kind::height),
                            *girth = underbust(reading, landmarks::Kind::girth);
    ASSERT_TRUE(level && girth && level->on_mesh);
    const double settled =
        landmarks::settle(*level, landmarks::shipped_precision(), her.model.scanned).value.x();
    ASSERT_GT(girth->loop.size(), 10u);
    for (const Vector3d& p : girth->loop)
      EXPECT_NEAR(p.z(), std::min(settled, level->on_mesh->x()) - 0.003, 1e-9) << "seed " << seed;
  }
}

// Skin that nothing was seen near is no farther off than a body model is wrong: 100 mm.
TEST(LandmarksReading, SupportIsNoWorseThanAModelCanBeWrong) {
  Registered her(1);
  std::fill(her.model.support.begin(), her.model.support.end(), 2.0);
  for (const landmarks::Figure& figure : her.reading().figures)
    EXPECT_NEAR(figure.support, 0.1, 1e-12) << figure.name;
}

}  // namespace
}  // namespace tensegric_fit
