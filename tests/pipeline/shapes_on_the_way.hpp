/// A launched chain with a first scan in it, whose skins on the way of a fit are heard.
#pragma once

#include <gtest/gtest.h>
#include <tensegric_fit/SetGarment.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "chain_client.hpp"

namespace tensegric_fit::tests {

inline bool on_its_way(const DeformedMesh::ConstPtr& shape) {
  return shape->status == FitState::SOLVING;
}

class ShapesTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    client_ = std::make_unique<ChainClient>();
    ASSERT_TRUE(client_->ready()) << "the chain did not come up";
    ASSERT_NE(client_->fit(booth_scan("a")), "") << "no deformed body came out";
  }
  static void TearDownTestSuite() { client_.reset(); }

  /// Every test begins with a garment that does not pull.
  void SetUp() override {
    listen_to_shapes();
    put_on(1);
    ASSERT_TRUE(wait_for([this] { return ended() && moved(*shapes_.back()) == 0; }));
    shapes_.clear();
  }

  void listen_to_shapes() {
    const boost::function<void(const DeformedMesh::ConstPtr&)> on_shape =
        [this](const DeformedMesh::ConstPtr& shape) { shapes_.push_back(shape); };
    every_ = ros::NodeHandle().subscribe<DeformedMesh>("body/deformed", 1000, on_shape);
  }

  static void put_on(double ratio) {
    SetGarment call;
    call.request.name = "B1";
    call.request.lines = {"chest"};
    call.request.ratios = {ratio};
    ASSERT_TRUE(ros::service::call("set_garment", call));
    ASSERT_TRUE(call.response.accepted) << call.response.message;
  }

  /// As somebody who was not there before; `shapes_` has what comes then.
  void join_late() {
    every_.shutdown();  // a second subscriber in one process would be served by roscpp, not by the node
    client_.reset();
    shapes_.clear();
    listen_to_shapes();
    ASSERT_TRUE(wait_for([this] { return !shapes_.empty(); }));
    listen(0.5);
  }

  bool ended() const { return !shapes_.empty() && !on_its_way(shapes_.back()); }
  bool under_way() const { return !shapes_.empty() && on_its_way(shapes_.back()); }

  /// How far one skin is from the other, metres: where it is farthest.
  static double way(const std::vector<float>& from, const std::vector<float>& to) {
    double farthest = 0;
    for (std::size_t i = 0; i < from.size(); ++i)
      farthest = std::max<double>(farthest, std::abs(to.at(i) - from[i]));
    return farthest;
  }
  /// The same, from rest.
  static double moved(const DeformedMesh& shape) {
    return way(client_->bodies.back()->vertices, shape.vertices);
  }

  static std::unique_ptr<ChainClient> client_;
  ros::Subscriber every_;
  std::vector<DeformedMesh::ConstPtr> shapes_;  // those on the way, too
};

inline std::unique_ptr<ChainClient> ShapesTest::client_;

}  // namespace tensegric_fit::tests
