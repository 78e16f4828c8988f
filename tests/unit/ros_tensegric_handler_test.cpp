/// What the tensegric stage does with messages, without a master.
#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <thread>

#include "fit/bind_body.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"
#include "ros/body_messages.hpp"
#include "ros_messages.hpp"
#include "tensegric/kept_garment_message.hpp"
#include "tensegric/tensegric_handler.hpp"
#include "tensegric_bust.hpp"
#include "tffd/tffd_handler.hpp"

namespace tensegric_fit::node {
namespace {

const auto kGoOn = [] { return true; };
const auto kSilent = [](const FitState&) {};

/// Messages of scans that all have the same bust.
class TensegricHandlerTest : public testing::Test {
 protected:
  using Input = TensegricHandler::Input;

  static TriangleMesh::ConstPtr body_of(const std::string& scan_id, const tensegric::BustShape& shape = {}) {
    const geometry::ControlMesh bust = tensegric::bust_mesh(shape);
    const auto body =
        boost::make_shared<TriangleMesh>(to_message(ScanTag(), {bust.outer, bust.triangles}, {}));
    body->scan_id = scan_id;
    return body;
  }
  static ControlMesh::ConstPtr control_of(const std::string& scan_id,
                                          const tensegric::BustShape& shape = {}) {
    const auto control = boost::make_shared<ControlMesh>(to_message(ScanTag(), tensegric::bust_mesh(shape)));
    control->scan_id = scan_id;
    return control;
  }
  static Garment chest_at(double ratio) {
    Garment garment;
    garment.name = "band";
    garment.regions = {"bust"};
    garment.lines.resize(1);
    garment.lines[0].name = "chest";
    garment.lines[0].ratio = ratio;
    return garment;
  }
  /// One whose garment needs no more than the test's bust has.
  TensegricHandler handler(const std::string& more = "") const {
    return TensegricHandler(
        Parameters(YAML::Load("{garment_directory: " + geometry::shipped_folder("garments") +
                              (more.empty() ? "" : ", " + more) + "}"),
                   "tensegric"),
        fit::bind_body);
  }
  static Landmarks::ConstPtr landmarks_of(const std::string& scan_id) {
    geometry::BodyMeasures measures;
    measures.heights = {{"hip", 0.9, 1, ""}, {"underbust", 1.12, 1, ""}};
    measures.landmarks = {{"crotch", {0, 0, 0.8}, 1, ""}};
    const auto landmarks = boost::make_shared<Landmarks>(to_message(ScanTag(), measures));
    landmarks->scan_id = scan_id;
    return landmarks;
  }
  template <typename PutOn>
  static std::string said_of(const PutOn& put_on) {
    try {
      put_on();
    } catch (const geometry::Refusal& refusal) {
      return refusal.what();
    }
    return "accepted";
  }
  FitState::ConstPtr fit_of(TensegricHandler& stage, const std::optional<Input>& input) const {
    return input ? stage.handle(*input, kGoOn, kSilent)->fit : nullptr;
  }
};

TEST_F(TensegricHandlerTest, FitsOnceEverythingOfOneScanIsThere) {
  TensegricHandler stage = handler();
  EXPECT_FALSE(stage.put_on(chest_at(0.95)));
  EXPECT_EQ(stage.outlook(), "kept until a scan comes");
  EXPECT_FALSE(stage.add(control_of("A")));  // messages of two topics come in any order
  EXPECT_TRUE(stage.add(body_of("A")));
  EXPECT_EQ(stage.outlook(), "fitting to scan A");
  EXPECT_FALSE(stage.add(body_of("A")));  // the same scan again: its control mesh is still to come
  EXPECT_TRUE(stage.add(control_of("A")));
}

TEST_F(TensegricHandlerTest, AnUnknownLineIsRefusedWhileTheBodyIsMadeReady) {
  TensegricHandler stage = handler();
  stage.put_on(chest_at(0.95));
  stage.add(body_of("A"));
  const auto input = stage.add(control_of("A"));  // which nobody has worked on so far
  ASSERT_TRUE(input);
  Garment unknown = chest_at(0.9);
  unknown.lines[0].name = "nowhere";
  EXPECT_NE(said_of([&] { stage.put_on(unknown); }), "accepted");
  EXPECT_EQ(stage.worn().garment.lines[0].ratio, 0.95);
  EXPECT_EQ(fit_of(stage, input)->status, FitState::CONVERGED);
}

TEST_F(TensegricHandlerTest, AGarmentForARefusedScanIsKeptAndNotPromised) {
  TensegricHandler stage = handler();
  stage.put_on(chest_at(0.95));
  stage.add(body_of("A"));
  ASSERT_TRUE(stage.add(control_of("A")));
  EXPECT_FALSE(stage.add(body_of("B")));  // refused later on: no control mesh comes
  EXPECT_FALSE(stage.put_on(chest_at(0.9)));
  EXPECT_EQ(stage.outlook(), "kept: scan B has no control mesh so far");
  EXPECT_FALSE(stage.reset());
  stage.put_on(chest_at(0.92));
  stage.add(body_of("C"));
  const auto input = stage.add(control_of("C"));
  ASSERT_TRUE(input);
  EXPECT_EQ(input->request.garment.lines[0].ratio, 0.92);
}

TEST_F(TensegricHandlerTest, AStartFromRestIsNotLostWhereTheNextGarmentTakesItsPlace) {
  const auto way_of = [this](bool reset) {
    TensegricHandler stage = handler();
    stage.put_on(chest_at(0.9));
    stage.add(body_of("A"));
    EXPECT_EQ(fit_of(stage, stage.add(control_of("A")))->status, FitState::CONVERGED);
    if (reset) {
      EXPECT_TRUE(stage.reset());  // asked for, and left out: a newer garment waits
    }
    return fit_of(stage, stage.put_on(chest_at(0.899)));
  };
  TensegricHandler fresh = handler();
  fresh.put_on(chest_at(0.899));
  fresh.add(body_of("A"));
  const FitState::ConstPtr from_rest = fit_of(fresh, fresh.add(control_of("A")));
  EXPECT_EQ(way_of(true)->iteration, from_rest->iteration);
  EXPECT_EQ(way_of(true)->outer, from_rest->outer);           // to the bit
  EXPECT_LT(way_of(false)->iteration, from_rest->iteration);  // from the last balance: that is quicker
}

TEST_F(TensegricHandlerTest, TheSkinFollowsStatesOnTheWay) {
  TensegricHandler stage = handler("progress_period: 0.001, twist: 0.1");
  TffdHandler skin(Parameters(YAML::Load("{}"), "tffd"));
  const TriangleMesh::ConstPtr body = body_of("A");
  const Landmarks::ConstPtr landmarks = landmarks_of("A");
  const ControlMesh::ConstPtr control = control_of("A");
  stage.put_on(chest_at(0.9));
  stage.add(body);
  stage.add(landmarks);
  const auto input = stage.add(control);
  ASSERT_TRUE(input);
  std::vector<FitState::ConstPtr> fits;
  const auto slowly = [] {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));  // a step then takes longer than the period
    return true;
  };
  const auto keep = [&](const FitState& state) { fits.push_back(boost::make_shared<FitState>(state)); };
  fits.push_back(stage.handle(*input, slowly, keep)->fit);
  ASSERT_GT(fits.size(), 2u);

  skin.add(TriangleMesh::ConstPtr(body));
  skin.add(landmarks);
  skin.add(control);
  std::shared_ptr<const BoundBody> bound;
  std::vector<float> first, last;
  for (const FitState::ConstPtr& fit : fits) {
    const auto joined = skin.add(fit);
    ASSERT_TRUE(joined);
    const TffdHandler::Output output = skin.handle(*joined);
    EXPECT_EQ(output.scan.deformed->status, fit->status);
    if (bound) {
      EXPECT_EQ(output.bound, bound);  // the posture of all is that of the last
    }
    bound = output.bound;
    last = output.scan.deformed->vertices;
    if (first.empty()) first = last;
    if (fit != fits.back()) {
      EXPECT_EQ(fit->status, FitState::SOLVING);
      EXPECT_FALSE(output.warnings);
    } else {
      ASSERT_TRUE(output.warnings);
      EXPECT_EQ(output.warnings->scan_id, "A");
      EXPECT_EQ(output.warnings->garment, fit->garment);
      EXPECT_EQ(output.warnings->warnings.size() + output.warnings->notices.size(),
                output.scan.warnings.size());
    }
  }
  EXPECT_NE(first, last);
}

/// The same bust with four times as many triangles, and the usual one as its coarse mesh.
class CoarseAnswerTest : public TensegricHandlerTest {
 protected:
  static tensegric::BustShape times(int finer) {
    tensegric::BustShape shape;
    shape.columns *= finer;
    shape.rows *= finer;
    return shape;
  }
  /// On the skin: a string cuts in as far as control triangles are small.
  static Garment band_at(double ratio) {
    Garment garment = chest_at(ratio);
    GarmentLine& line = garment.lines[0];
    line.through = {"axilla_L", "bust_point_L", "sternum", "bust_point_R", "axilla_R"};
    line.width = 0.03;
    line.smooth = 0.02;
    return garment;
  }

  struct Heard {
    std::vector<FitState> on_the_way;
    FitState::ConstPtr end;  // null where it was stopped
  };
  static Heard handle(TensegricHandler& stage, const Input& input, const std::function<bool()>& go_on) {
    Heard heard;
    const auto output =
        stage.handle(input, go_on, [&heard](const FitState& state) { heard.on_the_way.push_back(state); });
    if (output) heard.end = output->fit;
    return heard;
  }

  /// A band at 0.95 on that scan.
  std::optional<Input> input_of(TensegricHandler& stage, const std::string& scan_id,
                                const ControlMesh::ConstPtr& coarse) {
    stage.put_on(band_at(0.95));
    if (coarse) stage.add_coarse(coarse);
    stage.add(body_of(scan_id, times(8)));
    return stage.add(control_of(scan_id, times(2)));
  }

  static double distance(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum);
  }
};

TEST_F(CoarseAnswerTest, ComesFirstAndOnceOnTheNodesOfTheFineMeshNearWhereThatEnds) {
  TensegricHandler stage = handler("progress_period: 0.001"), without = handler();
  const auto input = input_of(stage, "A", control_of("A"));
  ASSERT_TRUE(input);
  const Heard heard = handle(stage, *input, kGoOn);
  ASSERT_EQ(heard.on_the_way.size(), 1u);  // what the fine mesh comes through is farther from its end
  const FitState& first = heard.on_the_way.front();
  EXPECT_EQ(first.status, FitState::SOLVING);
  EXPECT_EQ(first.scan_id, "A");
  EXPECT_EQ(first.garment, heard.end->garment);
  EXPECT_NE(first.note.find("control/coarse (120 triangles)"), std::string::npos) << first.note;
  const ControlMesh& rest = *input->control;
  ASSERT_EQ(first.outer.size(), rest.outer.size());
  EXPECT_EQ(first.inner, rest.inner);
  for (std::size_t i = 0; i < rest.outer_fixed.size(); ++i) {
    if (!rest.outer_fixed[i]) continue;
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) EXPECT_EQ(first.outer[k], rest.outer[k]);
  }
  EXPECT_NEAR(first.line_ratios.at(0), 0.95, 1e-4);  // of the coarse mesh
  EXPECT_LT(distance(first.outer, heard.end->outer), 0.5 * distance(rest.outer, heard.end->outer));

  const auto alone = input_of(without, "A", nullptr);
  ASSERT_TRUE(alone);
  EXPECT_EQ(handle(without, *alone, kGoOn).end->outer, heard.end->outer);  // to the bit
}

// A pseudo force is another number of newtons on each mesh.
TEST_F(CoarseAnswerTest, AnElasticBandPullsAsHardOnBothMeshes) {
  TensegricHandler stage = handler();
  stage.add_coarse(control_of("A"));
  stage.add(body_of("A", times(8)));
  stage.add(control_of("A", times(2)));
  Garment elastic = band_at(0.9);
  elastic.lines[0].law = GarmentLine::STIFFNESS;
  elastic.lines[0].stiffness = 10;
  const auto input = stage.put_on(elastic);
  ASSERT_TRUE(input);
  const Heard heard = handle(stage, *input, kGoOn);
  ASSERT_EQ(heard.on_the_way.size(), 1u);
  ASSERT_EQ(heard.end->status, FitState::CONVERGED);
  const double fine = heard.end->line_ratios.at(0);
  ASSERT_GT(fine, 0.905);  // it gives way
  ASSERT_LT(fine, 0.995);
  EXPECT_NEAR(heard.on_the_way[0].line_ratios.at(0), fine,
              0.3 * (1 - fine));  // meshes are unlike in stiffness
}

TEST_F(CoarseAnswerTest, ThereIsNoneByTheMeshOfAnotherScan) {
  TensegricHandler stage = handler();
  const auto input = input_of(stage, "B", control_of("A"));
  ASSERT_TRUE(input);
  for (const FitState& state : handle(stage, *input, kGoOn).on_the_way) EXPECT_EQ(state.note, "");
  stage.add_coarse(control_of("B"));
  const auto next = stage.put_on(band_at(0.97));
  ASSERT_TRUE(next);
  const Heard heard = handle(stage, *next, kGoOn);
  ASSERT_EQ(heard.on_the_way.size(), 1u);
  EXPECT_NE(heard.on_the_way[0].note.find("control/coarse"), std::string::npos);
}

// The order of two topics is not kept: of most new customers there was no first answer.
TEST_F(CoarseAnswerTest, OneThatComesAfterTheControlMeshIsInTime) {
  TensegricHandler stage = handler();
  const auto input = input_of(stage, "A", nullptr);
  ASSERT_TRUE(input);
  stage.add_coarse(control_of("A"));
  const Heard heard = handle(stage, *input, kGoOn);
  ASSERT_EQ(heard.on_the_way.size(), 1u);
  EXPECT_NE(heard.on_the_way[0].note.find("control/coarse"), std::string::npos);
}

TEST_F(CoarseAnswerTest, NothingIsKeptOfTheBodyBefore) {
  TensegricHandler stage = handler();
  const ControlMesh::ConstPtr before = control_of("A");
  handle(stage, *input_of(stage, "A", before), kGoOn);
  EXPECT_GT(before.use_count(), 1);
  handle(stage, *input_of(stage, "B", nullptr), kGoOn);
  EXPECT_EQ(before.use_count(), 1) << "the next body had no coarse mesh";
}

TEST_F(CoarseAnswerTest, StoppedOnItsWayItIsNoneAndNeitherIsTheFineOne) {
  TensegricHandler stage = handler();
  const auto input = input_of(stage, "A", control_of("A"));
  ASSERT_TRUE(input);
  const Heard heard = handle(stage, *input, [] { return false; });
  EXPECT_TRUE(heard.on_the_way.empty());
  EXPECT_FALSE(heard.end);
}

TEST_F(CoarseAnswerTest, AMeshThatCannotWearTheGarmentLeavesItToTheFineOne) {
  const auto nameless = boost::make_shared<ControlMesh>(*control_of("A"));
  nameless->names.assign(nameless->names.size(), "");
  TensegricHandler stage = handler();
  const auto input = input_of(stage, "A", nameless);
  ASSERT_TRUE(input);
  const Heard heard = handle(stage, *input, kGoOn);
  for (const FitState& state : heard.on_the_way) EXPECT_EQ(state.note, "");
  ASSERT_TRUE(heard.end);
  EXPECT_EQ(heard.end->status, FitState::CONVERGED);
}

TEST_F(TensegricHandlerTest, StartedAgainItWearsWhatItWore) {
  TensegricHandler before = handler("garment: B2");
  before.put_on(chest_at(0.9123456789012345));
  TensegricHandler after = handler("garment: B2, worn: '" + before.kept() + "'");
  EXPECT_EQ(after.worn().garment.name, "band");
  EXPECT_EQ(after.worn().garment.lines.at(0).ratio, 0.9123456789012345);
  after.reset();
  EXPECT_EQ(after.worn().garment.name, "B2");
  // another first garment was asked for meanwhile; words that are none of the node's
  EXPECT_EQ(handler("garment: B1, worn: '" + before.kept() + "'").worn().garment.name, "B1");
  for (const char* words : {"B2|", "B2|0", "B2|xyz", "B2|ffffffff", "nonsense"})
    EXPECT_FALSE(kept_garment(words, "B2")) << words;
}

TEST_F(TensegricHandlerTest, AGarmentOnOneBodysSkinIsNotPutOnTheNextBody) {
  const auto on_skin = [] {
    Garment garment = chest_at(0.95);
    garment.lines[0].points = {0, -0.1F, 1.1F, 0.1F, -0.1F, 1.1F};
    return garment;
  };
  TensegricHandler stage = handler("garment: B2");
  stage.put_on(on_skin());  // of the next body
  stage.add(body_of("A"));
  std::optional<Input> input = stage.add(control_of("A"));
  ASSERT_TRUE(input);
  EXPECT_EQ(input->request.garment.name, "band");
  EXPECT_EQ(input->taken_off, "");
  EXPECT_EQ(stage.add(control_of("A"))->request.garment.name, "band");  // the same scan again

  TensegricHandler again = handler("garment: B2, worn: '" + stage.kept() + "'");
  for (TensegricHandler* node : {&stage, &again}) {
    node->add(body_of("B"));
    input = node->add(control_of("B"));
    ASSERT_TRUE(input);
    EXPECT_EQ(input->request.garment.name, "B2");
    EXPECT_NE(input->taken_off.find("'band'"), std::string::npos);
    EXPECT_EQ(node->worn().garment.name, "B2");
    node->add(body_of("C"));
    EXPECT_EQ(node->add(control_of("C"))->taken_off, "");
  }
  stage.put_on(chest_at(0.95));  // not by points: worn by whoever comes
  stage.add(body_of("D"));
  EXPECT_EQ(stage.add(control_of("D"))->request.garment.name, "band");
}

TEST_F(TensegricHandlerTest, ALatchedGarmentThatIsDeliveredAgainDoesNotComeBack) {
  const auto at = [](double ratio, int seconds) {
    Garment garment = chest_at(ratio);
    garment.header.stamp = ros::Time(seconds, 0);
    return garment;
  };
  TensegricHandler stage = handler("garment: B2");
  stage.put_on(at(0.9, 10), "/shop");
  SetGarment::Request request;
  request.garment = chest_at(0.8);
  stage.put_on(request);
  TensegricHandler again =
      handler("garment: B2, worn: '" + stage.kept() + "', heard: '" + stage.heard() + "'");
  for (TensegricHandler* node : {&stage, &again}) {
    Garment delivered = at(0.9, 10);  // after a respawn, say
    delivered.header.seq = 2;         // as rospy numbers it
    node->put_on(delivered, "/shop");
    EXPECT_EQ(node->worn().garment.lines.at(0).ratio, 0.8);
    node->put_on(at(0.7, 5), "/shop");  // its clock was set back
    EXPECT_EQ(node->worn().garment.lines.at(0).ratio, 0.7);
    node->put_on(at(0.9, 10), "/play");  // a bag
    EXPECT_EQ(node->worn().garment.lines.at(0).ratio, 0.9);
    node->put_on(chest_at(0.6), "/play");  // nobody said when
    EXPECT_EQ(node->worn().garment.lines.at(0).ratio, 0.6);
  }
}

TEST_F(TensegricHandlerTest, ALatchedGarmentWithoutAStampDoesNotComeBackEither) {
  TensegricHandler stage = handler("garment: B2");
  SetGarment::Request request;
  request.garment = chest_at(0.8);
  const auto ratio = [](const TensegricHandler& of) { return of.worn().garment.lines.at(0).ratio; };
  stage.put_on(chest_at(0.9), "/shop", true);
  stage.put_on(request);
  stage.put_on(chest_at(0.9), "/shop", true);  // once more, and meant
  EXPECT_EQ(ratio(stage), 0.9);
  stage.put_on(request);
  for (const bool latched : {true, false}) {
    TensegricHandler again =
        handler("garment: B2, worn: '" + stage.kept() + "', heard: '" + stage.heard() + "'");
    again.put_on(chest_at(0.9), "/shop", latched);
    EXPECT_EQ(ratio(again), latched ? 0.8 : 0.9) << "what is latched is delivered again";
    again.put_on(request);
    again.put_on(chest_at(0.9), "/shop", latched);  // somebody wants it
    EXPECT_EQ(ratio(again), 0.9);
  }
  TensegricHandler other =
      handler("garment: B2, worn: '" + stage.kept() + "', heard: '" + stage.heard() + "'");
  other.put_on(chest_at(0.7), "/shop", true);
  EXPECT_EQ(ratio(other), 0.7);
}

TEST(HeardGarments, WhoWasHeardLastIsRemembered) {
  HeardGarments heard;
  for (int i = 0; i < 100; ++i)
    heard.is_new("/anonymous_" + std::to_string(i), {static_cast<std::uint64_t>(100 - i), 7});
  heard.is_new("/shop", {0, 5, true});
  HeardGarments later(heard.text());
  EXPECT_FALSE(later.is_new("/shop", {0, 5, true}));
  EXPECT_FALSE(later.is_new("/anonymous_99", {1, 7}));
  EXPECT_TRUE(later.is_new("/anonymous_0", {100, 7})) << "of 64 the last";
}

TEST_F(TensegricHandlerTest, AGarmentThatIsChangedUnderItsStampIsWorn) {
  TensegricHandler stage = handler("garment: B2");
  for (const double ratio : {0.97, 0.93, 0.9}) {  // what was latched, its ratio changed and nothing else
    Garment garment = chest_at(ratio);
    garment.header.stamp = ros::Time(10, 0);
    stage.put_on(garment, "/shop");
    EXPECT_EQ(stage.worn().garment.lines.at(0).ratio, ratio);
  }
}

TEST_F(TensegricHandlerTest, LatchedGarmentsOfSeveralPublishersStayOffAfterForget) {
  const auto of = [](double ratio, int seconds) {
    Garment garment = chest_at(ratio);
    garment.lines[0].points = {0, -0.1F, 1.1F, 0.1F, -0.1F, 1.1F};  // on one customer's skin
    garment.header.stamp = ros::Time(seconds, 0);
    return garment;
  };
  TensegricHandler stage = handler("garment: B2");
  stage.put_on(of(0.9, 10), "/shop");
  stage.put_on(of(0.8, 20), "/tablet");
  TensegricHandler forgot = handler("garment: B2, heard: '" + stage.heard() + "'");
  forgot.put_on(of(0.9, 10), "/shop");
  forgot.put_on(of(0.8, 20), "/tablet");
  EXPECT_EQ(forgot.worn().garment.name, "B2");
  forgot.put_on(of(0.7, 30), "/tablet");
  EXPECT_EQ(forgot.worn().garment.lines.at(0).ratio, 0.7);
}

TEST_F(TensegricHandlerTest, WhatWasAcceptedUnseenAndNamesNothingOfTheMeshIsTakenOff) {
  TensegricHandler stage = handler("garment: B1");
  Garment typo = chest_at(0.95);
  typo.lines[0].through = {"axilla_L", "sternun", "axilla_R"};
  stage.put_on(typo);  // nothing is known so far that it could not be worn on
  stage.add(body_of("A"));
  const auto input = stage.add(control_of("A"));
  ASSERT_TRUE(input);
  EXPECT_EQ(input->request.garment.name, "B1");
  EXPECT_NE(input->taken_off.find("sternun"), std::string::npos) << input->taken_off;
}

TEST_F(TensegricHandlerTest, AScanThatLacksARegionDoesNotTakeTheShopsGarmentOff) {
  TensegricHandler stage = handler("garment: B2");
  stage.add(body_of("A"));
  stage.add(control_of("A"));
  stage.put_on(chest_at(0.95));
  const auto lacking = boost::make_shared<ControlMesh>(*control_of("B"));
  for (auto& region : lacking->regions) region.name = "other";
  stage.add(body_of("B"));
  const auto refused = stage.add(ControlMesh::ConstPtr(lacking));
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->taken_off, "");
  EXPECT_EQ(code_of([&] { stage.handle(*refused, kGoOn, kSilent); }), geometry::refusal::kBadGarment);
  stage.add(body_of("C"));
  EXPECT_EQ(stage.add(control_of("C"))->request.garment.name, "band");
}

TEST_F(TensegricHandlerTest, RefusedGarmentsLeaveTheOldOneOn) {
  TensegricHandler stage = handler();
  EXPECT_EQ(said_of([&] { stage.put_on(chest_at(1e300)); }),
            "line 'chest': 'ratio' is 1e+300, outside [0.05, 10]");
  SetGarment::Request request;
  request.name = "B1";
  request.lines = {"chest"};
  request.ratios = {1e300};
  EXPECT_EQ(said_of([&] { stage.put_on(request); }),
            "garment B1, line 'chest': 'ratio' is 1e+300, outside [0.05, 10]");
  request.lines = {"chest", "chest"};
  request.ratios = {0.9, 0.8};
  EXPECT_EQ(said_of([&] { stage.put_on(request); }), "`lines` has 'chest' more than once");
  EXPECT_EQ(stage.worn().garment.lines.at(0).ratio, 0.95);
}

}  // namespace
}  // namespace tensegric_fit::node
