/// Second scans, in the garment, beside the launched chain.
#include <gtest/gtest.h>
#include <sensor_msgs/Image.h>
#include <tensegric_fit/Correlation.h>
#include <tensegric_fit/Forget.h>
#include <tensegric_fit/SetGarment.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <memory>

#include "chain_client.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::tests {
namespace {

const std::string kStage = "correlation: correlation";  // node and stage, on /diagnostics

class CorrelationTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    client_ = std::make_unique<ChainClient>();
    ros::NodeHandle node;
    worn_ = node.advertise<sensor_msgs::PointCloud2>("worn/points", 4);
    const boost::function<void(const Correlation::ConstPtr&)> take =
        [](const Correlation::ConstPtr& message) { found_.push_back(message); };
    correlation_ = node.subscribe<Correlation>("worn/correlation", 10, take);
    ASSERT_TRUE(client_->ready()) << "the chain did not come up";
    ASSERT_TRUE(wait_for([] {
      return worn_.getNumSubscribers() != 0 && correlation_.getNumPublishers() != 0 &&
             client_->diagnostics.count(kStage) != 0;
    }));
  }
  static void TearDownTestSuite() { client_.reset(); }

  static std::string send_worn(const std::string& body, double age = 0) {
    sensor_msgs::PointCloud2 scan = booth_scan(body);
    scan.header.stamp -= ros::Duration(age);
    worn_.publish(scan);
    return node::tag_of(scan).scan_id;
  }
  static std::string last_error() { return client_->diagnostics.at(kStage).at("last_error"); }
  /// What the nodes of this chain say that they removed of a scan.
  static std::string removed_of(const std::string& scan_id) {
    Forget order;
    order.request.scan_id = scan_id;
    if (!ros::service::call("forget", order)) return "";
    std::string removed;
    for (const std::string& line : order.response.removed) removed += line + "\n";
    return removed;
  }

  static std::unique_ptr<ChainClient> client_;
  static ros::Publisher worn_;
  static ros::Subscriber correlation_;
  static std::vector<Correlation::ConstPtr> found_;
};

std::unique_ptr<ChainClient> CorrelationTest::client_;
ros::Publisher CorrelationTest::worn_;
ros::Subscriber CorrelationTest::correlation_;
std::vector<Correlation::ConstPtr> CorrelationTest::found_;

TEST_F(CorrelationTest, BeforeAnyBodyThereIsNothingToCompareWith) {
  send_worn("a");
  EXPECT_TRUE(wait_for([] { return last_error() == "nothing_yet"; })) << last_error();
}

TEST_F(CorrelationTest, AnEarlyWornScanThatIsForgottenIsComparedWithNoBody) {
  const std::string worn_scan_id = send_worn("a", -500);  // later than the body's, for which it waits
  listen(2);                                              // until it has come
  const std::string removed = removed_of(worn_scan_id);
  EXPECT_NE(removed.find("/correlation: "), std::string::npos) << removed;
  ASSERT_NE(client_->fit(booth_scan("a")), "");
  listen(2);
  EXPECT_TRUE(found_.empty());
}

TEST_F(CorrelationTest, ASecondScanIsComparedWithTheFitOfTheFirst) {
  const std::string scan_id = client_->fit(booth_scan("a"));
  ASSERT_NE(scan_id, "");
  const std::string worn_scan_id = send_worn("a");
  ASSERT_TRUE(wait_for([] { return !found_.empty(); })) << last_error();
  const Correlation& correlation = *found_.back();
  EXPECT_EQ(correlation.scan_id, scan_id);
  EXPECT_EQ(correlation.worn_scan_id, worn_scan_id);
  EXPECT_EQ(correlation.garment, "B1");
  EXPECT_EQ(correlation.thickness, 0.002);
  EXPECT_EQ(correlation.distance.size() * 3, client_->bodies.back()->vertices.size());
  EXPECT_EQ(correlation.compared.size(), correlation.distance.size());
  EXPECT_LT(correlation.still_mean_size, 1e-4);  // m; it is the same scan
  // She wears nothing: under the garment her skin is the garment's thickness farther in than it should be,
  // and what B1 moved it.
  EXPECT_GT(correlation.covered_mean_size, 0.002);
  EXPECT_NEAR(correlation.covered_mean, -0.002, 0.001);
}

TEST_F(CorrelationTest, MarkersAndPictureForWhoeverListens) {
  ros::NodeHandle node;
  visualization_msgs::MarkerArray::ConstPtr markers;
  sensor_msgs::Image::ConstPtr image;
  const boost::function<void(const visualization_msgs::MarkerArray::ConstPtr&)> on_markers =
      [&](const visualization_msgs::MarkerArray::ConstPtr& message) { markers = message; };
  const boost::function<void(const sensor_msgs::Image::ConstPtr&)> on_image =
      [&](const sensor_msgs::Image::ConstPtr& message) { image = message; };
  const ros::Subscriber one = node.subscribe<visualization_msgs::MarkerArray>("correlation/markers", 1,
                                                                              on_markers),
                        two = node.subscribe<sensor_msgs::Image>("correlation/image", 1, on_image);
  ASSERT_TRUE(wait_for([&] { return markers && image; }));
  const visualization_msgs::Marker& body = markers->markers.back();
  EXPECT_EQ(body.points.size(), client_->bodies.back()->triangles.size());
  const auto blueness = [](const std_msgs::ColorRGBA& colour) { return colour.b - colour.r; };
  const auto [red, blue] =
      std::minmax_element(body.colors.begin(), body.colors.end(),
                          [&](const auto& a, const auto& b) { return blueness(a) < blueness(b); });
  EXPECT_LT(blueness(*red), -0.1F);  // B1 moved the breasts by more than the scale's tenth
  EXPECT_GT(blueness(*blue), 0.1F);
  EXPECT_GT(image->width, 1000u);
}

TEST_F(CorrelationTest, AnotherGarmentNeedsNoOtherScan) {
  found_.clear();
  SetGarment request;
  request.request.name = "B1";
  request.request.lines = {"chest"};
  request.request.ratios = {0.98};
  ASSERT_TRUE(ros::service::call("set_garment", request));
  ASSERT_TRUE(wait_for([] { return !found_.empty(); })) << last_error();
  EXPECT_LT(found_.back()->still_mean_size, 1e-4);
}

TEST_F(CorrelationTest, SomebodyElseIsRefused) {
  found_.clear();
  send_worn("b");
  EXPECT_TRUE(wait_for([] { return last_error() == "other_person"; })) << last_error();
  EXPECT_TRUE(found_.empty());
}

TEST_F(CorrelationTest, AWornScanThatIsOlderThanTheBodyIsOfTheCustomerBefore) {
  found_.clear();
  send_worn("a", 500);
  EXPECT_TRUE(wait_for([] { return last_error() == "nothing_yet"; })) << last_error();
  EXPECT_TRUE(found_.empty());
}

TEST_F(CorrelationTest, AWornScanIsOfOneBodyOnly) {
  send_worn("a");
  ASSERT_TRUE(wait_for([] { return !found_.empty(); }));
  found_.clear();
  ASSERT_NE(client_->fit(booth_scan("a")), "");
  listen(2);
  EXPECT_TRUE(found_.empty());
}

TEST_F(CorrelationTest, AWornScanThatIsForgottenIsNowhere) {
  const std::string worn_scan_id = send_worn("a");
  ASSERT_TRUE(wait_for([] { return !found_.empty(); })) << last_error();
  const std::string removed = removed_of(worn_scan_id);
  EXPECT_NE(removed.find("/correlation: "), std::string::npos) << removed;

  correlation_
      .shutdown();  // roscpp would serve a second subscriber of this process from its own latched copies
  found_.clear();
  const boost::function<void(const Correlation::ConstPtr&)> take = [](const Correlation::ConstPtr& message) {
    found_.push_back(message);
  };
  correlation_ = ros::NodeHandle().subscribe<Correlation>("worn/correlation", 10, take);
  ASSERT_TRUE(wait_for([] { return correlation_.getNumPublishers() != 0; }));
  listen(2);
  EXPECT_TRUE(found_.empty());
}

}  // namespace
}  // namespace tensegric_fit::tests
