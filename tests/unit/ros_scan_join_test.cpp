/// Which messages are of one scan.
#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

#include "ros/body_messages.hpp"
#include "ros/scan_join.hpp"
#include "ros/scan_tag.hpp"
#include "tensegric/fit_messages.hpp"

namespace tensegric_fit::node {
namespace {

TEST(ScanTag, SameScanSameIdAndAnyChangeAnother) {
  sensor_msgs::PointCloud2 scan;
  scan.header.stamp = ros::Time(5, 6);
  scan.width = 3;
  scan.height = 1;
  scan.data = {1, 2, 3};
  const ScanTag tag = tag_of(scan);
  EXPECT_EQ(tag.scan_id.substr(0, 12), "5.000000006-");
  EXPECT_EQ(tag.scan_id.size(), 20u);
  EXPECT_EQ(tag.header.frame_id, "scan");
  scan.header.seq = 99;  // set anew by every publisher
  EXPECT_EQ(tag_of(scan).scan_id, tag.scan_id);
  sensor_msgs::PointCloud2 other = scan;
  other.data[2] = 4;
  EXPECT_NE(tag_of(other).scan_id, tag.scan_id);
  other = scan;
  other.header.stamp.nsec = 7;
  EXPECT_NE(tag_of(other).scan_id, tag.scan_id);
}

class ScanJoinTest : public testing::Test {
 protected:
  template <typename Message>
  void arrive(const std::string& scan_id) {
    const auto message = boost::make_shared<Message>();
    message->scan_id = scan_id;
    const auto joined = join_.add(boost::shared_ptr<const Message>(message));
    if (!joined) return;
    const auto& [fit, mesh, control] = *joined;
    EXPECT_EQ(fit->scan_id, mesh->scan_id);
    EXPECT_EQ(fit->scan_id, control->scan_id);
    joined_.push_back(fit->scan_id);
  }
  std::vector<std::string> joined_;
  ScanJoin<FitState, TriangleMesh, ControlMesh> join_;
};

TEST_F(ScanJoinTest, CompletesInAnyOrderOfArrival) {
  arrive<FitState>("A");
  arrive<ControlMesh>("A");
  EXPECT_TRUE(joined_.empty());
  arrive<TriangleMesh>("A");
  EXPECT_EQ(joined_, std::vector<std::string>{"A"});
}

TEST_F(ScanJoinTest, NeverMixesTwoScans) {
  arrive<TriangleMesh>("A");
  arrive<ControlMesh>("A");
  arrive<TriangleMesh>("B");
  arrive<FitState>("A");  // late: its body is gone
  arrive<ControlMesh>("B");
  EXPECT_TRUE(joined_.empty());
  arrive<FitState>("B");
  EXPECT_EQ(joined_, std::vector<std::string>{"B"});
}

TEST_F(ScanJoinTest, EachTriggerCompletesOnce) {
  arrive<TriangleMesh>("A");
  arrive<ControlMesh>("A");
  arrive<FitState>("A");
  arrive<TriangleMesh>("A");  // the same scan played again: its fit is still to come
  arrive<ControlMesh>("A");
  EXPECT_EQ(joined_.size(), 1u);
  arrive<FitState>("A");
  arrive<FitState>("A");  // another garment
  EXPECT_EQ(joined_.size(), 3u);
}

}  // namespace
}  // namespace tensegric_fit::node
