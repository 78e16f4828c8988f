// What is read on a body's mesh and on the model before it is settled how much each counts.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>

#include "geometry/status.hpp"
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

  /// Reasons by name.
  std::map<std::string, std::string> missing() const {
    std::map<std::string, std::string> reasons;
    const landmarks::Reading all = reading();
    for (const geometry::Missing& figure : all.missing) {
      EXPECT_TRUE(reasons.emplace(figure.name, figure.reason).second) << figure.name << " twice";
      for (const landmarks::Figure& found : all.figures) EXPECT_NE(found.name, figure.name);
    }
    return reasons;
  }

  virtual_body::VirtualBody body;
  body_model::RegisteredBody model;
};

const landmarks::Figure* find(const landmarks::Reading& reading, landmarks::Kind kind,
                              const std::string& name) {
  for (const landmarks::Figure& figure : reading.figures)
    if (figure.kind == kind && figure.name == name) return &figure;
  return nullptr;
}
const landmarks::Figure* underbust(const landmarks::Reading& reading, landmarks::Kind kind) {
  return find(reading, kind, "underbust");
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

TEST(LandmarksReading, HandsAboveHerHeadAreNotHerStature) {
  Registered her(1);
  const auto stature = [&] {
    for (const landmarks::Figure& figure : her.reading().figures)
      if (figure.name == "stature") return std::pair(figure.on_mesh->x(), figure.on_model->x());
    return std::pair(0.0, 0.0);
  };
  const auto pose = [&](double raised) {  // rad, both arms
    body_model::RegisteredBody& model = her.model;
    model.parameters.turns[model.model->group_named("arm_L")] = {0, -raised, 0};
    model.parameters.turns[model.model->group_named("arm_R")] = {0, raised, 0};
    const body_model::PosedModel posed(*model.model, model.parameters);
    model.skin = model.posed = her.body.mesh.vertices = posed.vertices();
    her.body.mesh.triangles = model.model->triangles;
    return geometry::bounding_box(model.skin)[1].z();
  };
  const double low = pose(0);
  const auto before = stature();
  ASSERT_GT(pose(2), low + 0.1) << "hands above her head";
  EXPECT_NEAR(stature().first, before.first, 0.005);  // skinning moves the head by less
  EXPECT_NEAR(stature().second, before.second, 0.005);
}

// A belly that is the widest of all between hip and breasts: there is no least girth, and what is read on the
// navel's level instead is as much a guess as that level.
TEST(LandmarksReading, WithoutAWaistNothingOfItIsSure) {
  Registered her(1);
  const auto doubts = [&] {
    const landmarks::Reading reading = her.reading();
    std::vector<double> all;
    for (const auto& [kind, name] : {std::pair(landmarks::Kind::height, "waist"),
                                     {landmarks::Kind::girth, "waist"},
                                     {landmarks::Kind::point, "waist_side_L"},
                                     {landmarks::Kind::point, "waist_side_R"}}) {
      const landmarks::Figure* figure = find(reading, kind, name);
      EXPECT_NE(figure, nullptr) << name;
      if (figure != nullptr)
        all.push_back(kind == landmarks::Kind::height ? figure->support : figure->shared);
    }
    return all;
  };
  for (const double doubt : doubts()) EXPECT_LT(doubt, 0.03);
  const Vector3d navel = her.model.skin_point("navel"), forwards = her.model.left().cross(her.model.up());
  for (auto* skin : {&her.body.mesh.vertices, &her.model.skin})
    for (Vector3d& p : *skin) {
      const double up = her.model.up().dot(p - navel);
      p += 0.15 * std::exp(-std::pow(up / 0.07, 2)) * std::max(forwards.dot(p - navel) + 0.2, 0.0) * 5 *
           forwards;
    }
  for (const double doubt : doubts()) EXPECT_NEAR(doubt, 0.1, 1e-12);
  const geometry::BodyMeasures measures =
      landmarks::find_landmarks(her.body.mesh, {}, her.model, landmarks::shipped_precision());
  for (const geometry::Measure& girth : measures.girths)
    EXPECT_EQ(girth.confidence < 0.1, girth.name == "waist");
}

// The rim of a hole at the crown was read as her height, to half a millimetre.
TEST(LandmarksReading, AnOpenCrownShowsNoStature) {
  Registered her(1);
  const auto stature = [&] { return find(her.reading(), landmarks::Kind::height, "stature")->on_mesh; };
  EXPECT_TRUE(stature());
  const double cut = geometry::bounding_box(her.body.mesh.vertices)[1].z() - 0.006;
  std::vector<char> below;
  for (const Eigen::Vector3i& t : her.body.mesh.triangles)
    below.push_back((her.body.mesh.vertices[t[0]].z() < cut && her.body.mesh.vertices[t[1]].z() < cut &&
                     her.body.mesh.vertices[t[2]].z() < cut)
                        ? 1
                        : 0);
  her.body.mesh = geometry::submesh(her.body.mesh, below);
  EXPECT_FALSE(stature());
}

TEST(LandmarksReading, WhoSitsHasDoubtfulHeights) {
  Registered her(1);
  const body_model::Model& model = *her.model.model;
  const Vector3d forwards = her.model.left().cross(her.model.up());
  for (std::size_t bone = 0; bone < model.bones.size(); ++bone)
    for (const std::string side : {"L", "R"})
      if (model.bones[bone].name == "lowerleg01." + side)
        her.model.joints[bone] = her.model.joint("upperleg01." + side) + 0.4 * forwards;
  const landmarks::Reading reading = her.reading();
  for (const landmarks::Figure& figure : reading.figures) {
    const bool on_her_legs = figure.kind == landmarks::Kind::height || figure.name.rfind("hip", 0) == 0;
    EXPECT_EQ(figure.shared > 0.3, on_her_legs) << figure.name;
    EXPECT_EQ(figure.shared_reason.empty(), !on_her_legs) << figure.name;
  }
}

// Folds are looked for where shape and pose have them: nowhere near the bust points here.
TEST(LandmarksReading, WithoutAFoldTheModelsPlaceCountsAndIsUnsure) {
  Registered her(1);
  const Vector3d forwards = her.model.left().cross(her.model.up());
  for (Vector3d& p : her.model.posed) p -= 0.3 * forwards;
  EXPECT_TRUE(her.missing().empty()) << "the waist, too, was measured from the folds";
  const geometry::BodyMeasures measures =
      landmarks::find_landmarks(her.body.mesh, {}, her.model, landmarks::shipped_precision());
  for (const char* side : {"underbust_L", "underbust_R"})
    EXPECT_LT(measures.find_landmark(side)->confidence, geometry::kUnsure) << side;
  for (const auto* measured : {&measures.heights, &measures.girths})
    for (const geometry::Measure& m : *measured)
      if (m.name == "underbust") {
        EXPECT_LT(m.confidence, geometry::kUnsure);
      }
}

TEST(LandmarksReading, WithoutArmsThereAreNoAxillae) {
  Registered her(1);
  const auto armless = std::make_shared<body_model::Model>(*her.model.model);
  std::vector<Eigen::Vector3i>& triangles = armless->triangles;
  const auto is_arm = [&armless](const Eigen::Vector3i& t) {
    return armless->arm[t[0]] + armless->arm[t[1]] + armless->arm[t[2]] > 3 * 0.5;
  };
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(), is_arm), triangles.end());
  her.model.model = armless;
  her.body.mesh = {her.model.skin, triangles};
  auto missing = her.missing();
  for (const std::string side : {"_L", "_R"}) {
    EXPECT_EQ(missing["axilla" + side], "no gap between arm and trunk was found");
    EXPECT_EQ(missing["upper_arm" + side],
              "its girth is measured from axilla" + side + ", which was not found");
  }
  const geometry::BodyMeasures measures =
      landmarks::find_landmarks(her.body.mesh, {}, her.model, landmarks::shipped_precision());
  try {
    measures.landmark("axilla_R");
    ADD_FAILURE() << "found";
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(refusal.code(), "missing_part:axilla_R");
    EXPECT_NE(std::string(refusal.what()).find(missing.at("axilla_R")), std::string::npos);
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
