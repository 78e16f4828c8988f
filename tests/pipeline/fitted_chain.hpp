/// The launched chain after a first good scan, with garment B1 on it.
#pragma once

#include <gtest/gtest.h>
#include <tensegric_fit/SetGarment.h>

#include <memory>
#include <string>

#include "chain_client.hpp"

namespace tensegric_fit::tests {

class PipelineTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    client_ = std::make_unique<ChainClient>();
    ASSERT_TRUE(client_->ready()) << "the chain did not come up";
    scan_id_ = client_->fit(booth_scan("a"));
    ASSERT_NE(scan_id_, "") << "no deformed body came out";
  }
  static void TearDownTestSuite() { client_.reset(); }

  static SetGarment::Response set_garment(const SetGarment::Request& request) {
    SetGarment::Response response;
    SetGarment::Request copy = request;
    EXPECT_TRUE(ros::service::call("set_garment", copy, response));
    return response;
  }

  static SetGarment::Request b1_at(double ratio) {
    SetGarment::Request request;
    request.name = "B1";
    request.lines = {"chest"};
    request.ratios = {ratio};
    return request;
  }

  // Two nodes publish them, in either order.
  static bool fit_and_body_came() {
    return wait_for([] { return !client_->deformed.empty() && !client_->fits.empty(); });
  }

  static std::unique_ptr<ChainClient> client_;
  static std::string scan_id_;
};

inline std::unique_ptr<ChainClient> PipelineTest::client_;

inline std::string PipelineTest::scan_id_;

}  // namespace tensegric_fit::tests
