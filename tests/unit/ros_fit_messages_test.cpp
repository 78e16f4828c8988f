/// Messages of garments and fits <-> core types.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "ros/line_force.hpp"
#include "ros_messages.hpp"
#include "tensegric/fit_messages.hpp"

namespace tensegric_fit::node {
namespace {

const std::string kGarments = std::string(TENSEGRIC_FIT_SOURCE_DIR) + "/launch/garments";

TEST(FitMessages, GarmentComesBackAsItWas) {
  GarmentRequest request;
  request.garment.name = "mine";
  request.garment.regions = {"bust"};
  tensegric::GarmentLine rigid, elastic, table, laid, cup;
  rigid.name = "chest";
  rigid.ratio = 0.9;
  rigid.through = {"side_L", "sternum", "side_R"};
  elastic.name = "strap";
  elastic.law.kind = tensegric::TensionLaw::Kind::stiffness;
  elastic.law.stiffness = 2.5;
  elastic.tension_limit = 7;
  elastic.taut = true;
  elastic.through = {"bust_point_L", "bust_side_L"};
  table.name = "cradle";
  table.law.kind = tensegric::TensionLaw::Kind::table;
  table.law.table = {{1, 0}, {1.2, 3}};
  laid.name = "band";
  laid.points = {{0.1, 0, 1.2}, {0, -0.1, 1.2}, {-0.1, 0, 1.2}};
  laid.width = 0.03;
  laid.smooth = 0.02;
  laid.held = {true, false};
  cup.name = "cup";
  cup.through = {"bust_point_L"};
  cup.fan = {"underbust_inner_L", "underbust_L"};
  cup.width = 0.03;
  request.garment.lines = {rigid, elastic, table, laid, cup};
  request.solver = "relaxation";

  const GarmentRequest back = request_in(to_message(std_msgs::Header(), request));
  EXPECT_EQ(to_message(std_msgs::Header(), request).lines.at(1).law, "stiffness");
  EXPECT_EQ(back.solver, "relaxation");
  EXPECT_EQ(back.garment.name, "mine");
  EXPECT_EQ(back.garment.regions, request.garment.regions);
  ASSERT_EQ(back.garment.lines.size(), request.garment.lines.size());
  for (std::size_t i = 0; i < back.garment.lines.size(); ++i) {
    const auto &was = request.garment.lines[i], &is = back.garment.lines[i];
    EXPECT_EQ(is.name, was.name);
    EXPECT_EQ(is.ratio, was.ratio);
    EXPECT_EQ(is.law.kind, was.law.kind);
    EXPECT_EQ(is.law.stiffness, was.law.stiffness);
    EXPECT_EQ(is.law.table, was.law.table);
    EXPECT_EQ(is.tension_limit, was.tension_limit);
    EXPECT_EQ(is.through, was.through);
    EXPECT_EQ(is.fan, was.fan);
    EXPECT_EQ(is.taut, was.taut);
    EXPECT_EQ(is.points, was.points);
    EXPECT_EQ(is.width, was.width);
    EXPECT_EQ(is.smooth, was.smooth);
    EXPECT_EQ(is.held, was.held);
  }
}

TEST(FitMessages, ImpossibleGarmentsAreRefusedByName) {
  Garment good;
  good.name = "mine";
  good.lines.resize(1);
  good.lines[0].name = "chest";
  good.lines[0].ratio = 0.9;
  EXPECT_EQ(code_of([&] { request_in(good); }), "accepted");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double ratio : {0.0, -1.0, nan, 1e300}) {
    Garment bad = good;
    bad.lines[0].ratio = ratio;
    EXPECT_EQ(code_of([&] { request_in(bad); }), "bad_garment") << ratio;
  }
  Garment bad = good;
  bad.lines[0].law = "sticky";
  EXPECT_EQ(code_of([&] { request_in(bad); }), "bad_garment");
  bad = good;
  bad.lines[0].law = GarmentLine::STIFFNESS;  // and none given
  EXPECT_EQ(code_of([&] { request_in(bad); }), "bad_garment");
  bad = good;
  bad.lines[0].stiffness = 20;  // and no law
  EXPECT_EQ(code_of([&] { request_in(bad); }), "bad_garment");
  bad = good;
  bad.lines[0].law = GarmentLine::TABLE;
  bad.lines[0].stretch = {1, 1.2};
  bad.lines[0].tension = {0, 0};  // pulls nothing
  EXPECT_EQ(code_of([&] { request_in(bad); }), "bad_garment");
  bad = good;
  bad.lines.push_back(good.lines[0]);  // two of one name
  EXPECT_EQ(code_of([&] { request_in(bad); }), "bad_garment");
  bad = good;
  bad.lines.clear();
  EXPECT_EQ(code_of([&] { request_in(bad); }), "bad_garment");
  bad = good;
  for (const double limit : {nan, -1.0, 2e9}) {  // as in files, up to 1e9
    bad.lines[0].tension_limit = limit;
    EXPECT_EQ(code_of([&] { request_in(bad); }), "bad_garment") << limit;
  }
  bad = good;
  bad.lines[0].through = {"sternum"};
  EXPECT_EQ(code_of([&] { request_in(bad); }), "bad_garment");
  bad = good;
  bad.solver = "magic";
  EXPECT_EQ(code_of([&] { request_in(bad); }), "bad_option");
}

TEST(FitMessages, CupsFollowTheRulesOfGarmentFiles) {
  const auto outcome = [](std::vector<std::string> through, double width) {
    Garment garment;
    garment.lines.resize(1);
    garment.lines[0].name = "cup";
    garment.lines[0].ratio = 0.9;
    garment.lines[0].through = std::move(through);
    garment.lines[0].width = width;
    return code_of([&garment] { request_in(garment); });
  };
  EXPECT_EQ(outcome({"tip", "fan", "a", "b"}, 0.03), "accepted");
  EXPECT_EQ(outcome({"tip", "fan", "a", "b"}, 0), "bad_garment");
  EXPECT_EQ(outcome({"tip", "fan", "a"}, 0.03), "bad_garment");
  EXPECT_EQ(outcome({"neck", "tip", "fan"}, 0.03), "bad_garment");
  EXPECT_EQ(outcome({"fan", "a", "b"}, 0.03), "bad_garment");
}

TEST(FitMessages, LinesByPointsFollowTheRulesOfGarmentFiles) {
  Garment garment;
  garment.lines.resize(1);
  GarmentLine& line = garment.lines[0];
  line.name = "band";
  line.ratio = 0.9;
  line.points = {0, 0, 1, 0.1, 0, 1};
  line.width = 0.03;
  EXPECT_EQ(request_in(garment).garment.lines.at(0).points.size(), 2u);
  const auto refused = [&garment](const std::function<void(GarmentLine&)>& spoil) {
    Garment bad = garment;
    spoil(bad.lines[0]);
    return code_of([&bad] { request_in(bad); });
  };
  EXPECT_EQ(refused([](GarmentLine& bad) { bad.points.pop_back(); }), "bad_garment");
  EXPECT_EQ(refused([](GarmentLine& bad) { bad.points.resize(3); }), "bad_garment");  // one point
  EXPECT_EQ(refused([](GarmentLine& bad) { bad.points[4] = std::nan(""); }), "non_finite");
  EXPECT_EQ(refused([](GarmentLine& bad) { bad.through = {"side_L", "side_R"}; }), "bad_garment");
  EXPECT_EQ(refused([](GarmentLine& bad) { bad.through = {"bone"}; }), "bad_garment");
  EXPECT_EQ(request_in(garment).garment.lines.at(0).held, (std::array<bool, 2>{true, true}));  // unless said
  EXPECT_EQ(refused([](GarmentLine& bad) { bad.width = 5; }), "bad_garment");
  EXPECT_EQ(refused([](GarmentLine& bad) { bad.smooth = -0.01; }), "bad_garment");
  const auto smooth_string = [](GarmentLine& bad) {
    bad.points.clear();
    bad.width = 0;
    bad.smooth = 0.02;
  };
  EXPECT_EQ(refused(smooth_string), "bad_garment");
}

TEST(FitMessages, TablesFollowTheRulesOfGarmentFiles) {
  Garment garment;
  garment.lines.resize(1);
  GarmentLine& line = garment.lines[0];
  line.name = "chest";
  line.ratio = 0.9;
  line.law = GarmentLine::TABLE;
  using Values = std::vector<double>;
  const std::vector<std::pair<Values, Values>> bad = {{{}, {}},
                                                      {{1, 1.2}, {0}},
                                                      {{1}, {0}},
                                                      {{1, 1.2}, {3, 4}},    // tension at rest
                                                      {{1.1, 1.1}, {0, 1}},  // two tensions for one stretch
                                                      {{1.1, 1.2}, {3, 1}},  // descends
                                                      {{0.5, 1.2}, {0, 1}},  // pushes
                                                      {{1, 1.2}, {0, std::nan("")}}};
  for (const auto& [stretch, tension] : bad) {
    line.stretch = stretch;
    line.tension = tension;
    EXPECT_EQ(code_of([&] { request_in(garment); }), "bad_garment") << testing::PrintToString(stretch);
  }
  line.stretch = {1.1, 1.2};
  line.tension = {2, 3};
  EXPECT_EQ(request_in(garment).garment.lines.at(0).law.table,
            (std::vector<std::pair<double, double>>{{1, 0}, {1.1, 2}, {1.2, 3}}));
}

TEST(FitMessages, ResultsKeepTheirValues) {
  tensegric::Solution solution;
  solution.outer = {{0.1, 0.2, 1.0 / 3}};
  solution.inner = {{0.1, 0.2, 0.3}};
  tensegric::LineResult line;
  line.name = "chest";
  line.nodes = {3, 1, 4};
  line.course_at_rest = {{0, 0, 1}, {0, 0.5, 1}};
  line.course = {{0, 0, 1}, {0, 0.45, 1}};
  line.initial = 0.5;
  line.neutral = line.final = 0.45;
  line.request = 0.9;
  line.tension = 1.5;
  line.law.kind = tensegric::TensionLaw::Kind::stiffness;
  line.law.stiffness = 4;
  solution.lines = {line};
  solution.regions = {{"bust", 0.004, 0.0041, 0.025, 1e-10}};  // the volume under the skin was kept
  solution.status = tensegric::Status::infeasible;
  solution.iterations = 7;
  solution.residual = 1e-9;
  const FitName name{some_tag(), "B1", tensegric::SolverName::equilibrium};

  const FitState state = to_message(name, solution, 12.5);
  EXPECT_EQ(state.scan_id, some_tag().scan_id);
  EXPECT_EQ(state.status, FitState::INFEASIBLE);
  EXPECT_EQ(state.solver, "equilibrium");
  EXPECT_EQ(state.outer, (std::vector<double>{0.1, 0.2, 1.0 / 3}));
  EXPECT_EQ(state.lines.at(0).nodes, (std::vector<std::uint32_t>{3, 1, 4}));
  EXPECT_EQ(state.lines.at(0).course_at_rest, (std::vector<double>{0, 0, 1, 0, 0.5, 1}));
  EXPECT_EQ(state.lines.at(0).course, (std::vector<double>{0, 0, 1, 0, 0.45, 1}));
  EXPECT_DOUBLE_EQ(state.lines.at(0).ratio, 0.9);
  EXPECT_EQ(state.lines.at(0).law, GarmentLine::STIFFNESS);
  EXPECT_EQ(state.lines.at(0).stiffness, 4);
  EXPECT_EQ(state.lines.at(0).tension_limit, 0);  // none
  EXPECT_EQ(state.volume_errors.at(0), 1e-10);
  EXPECT_EQ(state.milliseconds, 12.5);
  EXPECT_EQ(to_message(name, tensegric::Iterate(), solution.outer, solution.inner, 1).status,
            FitState::SOLVING);
}

TEST(Messages, ForcesOfLinesAreThoseOfTheirFitAndOfCalibratedTissue) {
  tensegric::Solution solution;
  tensegric::LineResult line;
  line.name = "chest";
  line.tension = 1.5;
  line.newtons = 20;
  line.pressure = 1700;
  line.initial = line.final = 0.5;
  solution.lines = {line};
  const FitName name{some_tag(), "B1", tensegric::SolverName::equilibrium};
  solution.calibrated = true;
  const LineForces forces = forces_message(name, solution);
  const FitState fit = to_message(name, solution, 1);
  const auto force = force_of(forces, fit, 0);
  ASSERT_TRUE(force);
  EXPECT_EQ(force->newtons, 20);
  EXPECT_DOUBLE_EQ(force->kilopascals, 1.7);

  solution.lines[0].tension = 1.6;
  EXPECT_FALSE(force_of(forces, to_message(name, solution, 1), 0)) << "the next fit of that garment";
  FitState other = fit;
  other.scan_id = "2.000000000-00000002";
  EXPECT_FALSE(force_of(forces, other, 0));
  LineForces broken = forces;
  broken.newtons.clear();
  EXPECT_FALSE(force_of(broken, fit, 0));
  broken.newtons = {std::nan("")};
  EXPECT_FALSE(force_of(broken, fit, 0));

  solution.calibrated = false;
  EXPECT_TRUE(forces_message(name, solution).lines.empty());
}

TEST(Messages, FibresOfABandHaveAsManyPoints) {
  tensegric::Solution solution;
  tensegric::LineResult line;
  line.name = "chest";
  line.tension = 1.5;
  line.width = 0.03;
  line.fibres_at_rest = {{{0, 0, 1}, {0, 1, 1}}, {{0, 0, 2}, {0, 0.5, 2}, {0, 1, 2}}};
  line.fibres = {{{0, 0, 1}, {0, 0.5, 1}}, {{0, 0, 2}, {1, 0.5, 2}, {0, 1, 2}}};
  tensegric::LineResult string = line;
  string.fibres.resize(1);
  solution.lines = {line, string};
  const BandShapes shapes = bands_message({some_tag(), "B1", tensegric::SolverName::equilibrium}, solution);
  ASSERT_EQ(shapes.bands.size(), 1u) << "a string has no width";
  const BandShape& band = shapes.bands[0];
  EXPECT_EQ(band.fibres, 2u);
  EXPECT_EQ(band.at_rest, (std::vector<float>{0, 0, 1, 0, 0.5, 1, 0, 1, 1, 0, 0, 2, 0, 0.5, 2, 0, 1, 2}));
  EXPECT_EQ(band.worn, (std::vector<float>{0, 0, 1, 0, 0.25, 1, 0, 0.5, 1, 0, 0, 2, 1, 0.5, 2, 0, 1, 2}));
}

TEST(GarmentRequests, PutsRatiosIntoShippedGarments) {
  SetGarment::Request request;
  request.name = "B1";
  request.lines = {"chest"};
  request.ratios = {0.87};
  const GarmentRequest asked = request_in(request, kGarments);
  EXPECT_EQ(asked.garment.name, "B1");
  EXPECT_EQ(asked.garment.lines.at(0).ratio, 0.87);
  request.lines = {""};  // every line
  request.ratios = {0.91};
  for (const tensegric::GarmentLine& line : request_in(request, kGarments).garment.lines)
    EXPECT_EQ(line.ratio, 0.91);
}

TEST(GarmentRequests, RefusesByName) {
  SetGarment::Request request;
  EXPECT_EQ(code_of([&] { request_in(request, kGarments); }), "bad_garment");  // nothing asked for
  for (const std::string& name : {std::string("no_such_garment"), std::string("/"), std::string(5000, 'x')}) {
    request.name = name;
    EXPECT_EQ(code_of([&] { request_in(request, kGarments); }), "bad_garment");
  }
  request.name = "B1";
  request.lines = {"no_such_line"};
  request.ratios = {0.9};
  EXPECT_EQ(code_of([&] { request_in(request, kGarments); }), "unknown_line");
  request.lines = {"chest"};
  request.ratios = {-0.9};
  EXPECT_EQ(code_of([&] { request_in(request, kGarments); }), "bad_garment");
  request.ratios = {};
  EXPECT_EQ(code_of([&] { request_in(request, kGarments); }), "bad_garment");
}

}  // namespace
}  // namespace tensegric_fit::node
