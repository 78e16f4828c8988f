/// Garment after garment through the launched chain.
#include <gtest/gtest.h>
#include <std_srvs/Trigger.h>
#include <tensegric_fit/Garment.h>
#include <tensegric_fit/SetGarment.h>

#include <algorithm>
#include <cmath>

#include "fitted_chain.hpp"
#include "ros/line_force.hpp"

namespace tensegric_fit::tests {
namespace {

double ratio_of(const FitState& fit, const std::string& line) {
  for (const LineResult& result : fit.lines)
    if (result.name == line) return result.ratio;
  return 0;
}

/// To 1e-5 m: a step of 0.001 of the chest's ratio moves the bust by 0.2 mm.
bool is_same(const DeformedMesh& one, const DeformedMesh& other) {
  return std::equal(one.vertices.begin(), one.vertices.end(), other.vertices.begin(), other.vertices.end(),
                    [](float a, float b) { return std::abs(a - b) <= 1e-5F; });
}

TEST_F(PipelineTest, AnotherGarmentNeedsNoOtherScan) {
  client_->forget();
  EXPECT_TRUE(set_garment(b1_at(0.97)).accepted);
  ASSERT_TRUE(fit_and_body_came());
  EXPECT_TRUE(client_->bodies.empty());
  EXPECT_TRUE(client_->controls.empty());
  EXPECT_EQ(client_->deformed.back()->scan_id, scan_id_);
  EXPECT_EQ(client_->deformed.back()->garment, "B1");
  EXPECT_NEAR(ratio_of(*client_->fits.back(), "chest"), 0.97,
              1e-4);  // the bound on a feasible request
}

TEST_F(PipelineTest, TheLastOfManyGarmentsIsTheOneThatStays) {
  constexpr double kLast = 0.95, kStep = 0.001;
  client_->forget();
  ASSERT_TRUE(set_garment(b1_at(kLast)).accepted);
  ASSERT_TRUE(fit_and_body_came());
  const DeformedMesh::ConstPtr alone = client_->deformed.back();

  client_->forget();
  for (int left = 49; left >= 0; --left) EXPECT_TRUE(set_garment(b1_at(kLast + left * kStep)).accepted);
  const auto last_fit_came = [] {  // to the bound above; a step is ten times that
    return !client_->fits.empty() && std::abs(ratio_of(*client_->fits.back(), "chest") - kLast) < 1e-4;
  };
  // The body may skip fits that are out of date, never the last one.
  const auto last_body_came = [&] {
    return !client_->deformed.empty() && is_same(*client_->deformed.back(), *alone);
  };
  EXPECT_TRUE(wait_for([&] { return last_fit_came() && last_body_came(); }));
  listen(1);  // for any that come late
  EXPECT_TRUE(last_fit_came());
  EXPECT_TRUE(last_body_came());
  for (const FitState::ConstPtr& fit : client_->fits) EXPECT_EQ(fit->status, FitState::CONVERGED);
}

TEST_F(PipelineTest, AGarmentFromTheTopicIsWornToo) {
  client_->forget();
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<Garment>("garment", 1);
  ASSERT_TRUE(wait_for([&] { return publisher.getNumSubscribers() != 0; }));
  Garment garment;
  garment.name = "from the panel";
  garment.regions = {"bust"};
  garment.lines.resize(1);
  garment.lines[0].name = "chest";
  garment.lines[0].ratio = 0.98;
  publisher.publish(garment);
  ASSERT_TRUE(fit_and_body_came());
  EXPECT_EQ(client_->deformed.back()->garment, "from the panel");
  EXPECT_NEAR(ratio_of(*client_->fits.back(), "chest"), 0.98, 1e-4);
}

TEST_F(PipelineTest, ABandGivenByPointsLiesOnTheBody) {
  client_->forget();
  ASSERT_TRUE(set_garment(b1_at(0.97)).accepted);
  ASSERT_TRUE(fit_and_body_came());
  SetGarment::Request own;
  own.garment.name = "on this body";
  own.garment.regions = {"bust"};
  own.garment.lines.resize(1);
  GarmentLine& band = own.garment.lines[0];
  band.name = "band";
  band.ratio = 0.96;
  const std::vector<double> course = client_->fits.back()->lines.at(0).course_at_rest;
  for (std::size_t i = 0; i + 2 < course.size(); i += 12)  // every fourth of its points
    band.points.insert(band.points.end(), course.begin() + i, course.begin() + i + 3);
  band.width = 0.03;
  band.smooth = 0.02;
  client_->forget();
  const SetGarment::Response response = set_garment(own);
  ASSERT_TRUE(response.accepted) << response.message;
  ASSERT_TRUE(fit_and_body_came());
  const FitState& fit = *client_->fits.back();
  EXPECT_EQ(fit.status, FitState::CONVERGED);
  EXPECT_NEAR(ratio_of(fit, "band"), 0.96, 1e-6);
  EXPECT_TRUE(fit.lines.at(0).nodes.empty());
  EXPECT_GT(fit.lines.at(0).course.size(), band.points.size());  // it follows the skin between its points

  for (double& value : band.points) value += 0.5;
  const SetGarment::Response astray = set_garment(own);
  EXPECT_FALSE(astray.accepted);
  EXPECT_EQ(astray.code, "bad_garment");
}

TEST_F(PipelineTest, ARefusedGarmentLeavesTheOldOneOn) {
  client_->forget();
  SetGarment::Request request = b1_at(0.9);
  request.lines = {"no_such_line"};
  SetGarment::Response response = set_garment(request);
  EXPECT_FALSE(response.accepted);
  EXPECT_EQ(response.code, "unknown_line");

  SetGarment::Request own;
  own.garment.name = "mine";
  own.garment.regions = {"bust"};
  own.garment.lines.resize(1);
  own.garment.lines[0].name = "astray";
  own.garment.lines[0].ratio = 0.9;
  own.garment.lines[0].through = {"no_such_node", "sternum"};
  response = set_garment(own);
  EXPECT_FALSE(response.accepted);
  EXPECT_EQ(response.code, "unknown_line");

  own.garment.regions = {"hat"};
  own.garment.lines[0].name = "chest";
  own.garment.lines[0].through.clear();
  response = set_garment(own);
  EXPECT_FALSE(response.accepted);
  EXPECT_EQ(response.code, "bad_garment");
  listen(1);
  EXPECT_TRUE(client_->fits.empty());
}

TEST_F(PipelineTest, ResetGoesBackToTheFirstGarment) {
  client_->forget();
  std_srvs::Trigger trigger;
  ASSERT_TRUE(ros::service::call("reset", trigger));
  EXPECT_TRUE(trigger.response.success);
  ASSERT_TRUE(wait_for([] { return !client_->deformed.empty(); }));
  EXPECT_EQ(client_->deformed.back()->garment, "B1");
}

}  // namespace
}  // namespace tensegric_fit::tests
