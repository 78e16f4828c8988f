/// Customers, booths side by side, silent sensors and killed nodes, over real topics.
#include <actionlib/client/simple_action_client.h>
#include <gtest/gtest.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <signal.h>
#include <tensegric_fit/CaptureAction.h>
#include <tensegric_fit/Forget.h>
#include <tensegric_fit/ScanLabel.h>
#include <xmlrpcpp/XmlRpcClient.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>

#include "chain_client.hpp"
#include "recorded_booth.hpp"
#include "ros/scan_tag.hpp"
#include "virtual_booth/random_body.hpp"

namespace tensegric_fit::tests {
namespace {

namespace fs = std::filesystem;
using actionlib::SimpleClientGoalState;

double height_of(const Landmarks& landmarks, const std::string& name) {
  for (const Measure& height : landmarks.heights)
    if (height.name == name) return height.value;
  return 0;
}

/// Ends a node as a crash would. False: there is no such node.
bool kill_node(const std::string& name) {
  XmlRpc::XmlRpcValue request, response, uri;
  request[0] = ros::this_node::getName();
  request[1] = name;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::master::execute("lookupNode", request, response, uri, false)) return false;
  if (!ros::network::splitURI(uri, host, port)) return false;
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue caller;
  caller[0] = ros::this_node::getName();
  return client.execute("getPid", caller, response) && response.size() == 3 &&
         kill(response[2], SIGKILL) == 0;
}

/// The action `capture` of a booth, and all that its chain publishes.
class Customer {
 public:
  using Client = actionlib::SimpleActionClient<CaptureAction>;

  explicit Customer(const std::string& booth) : node_(booth), client_(node_, "capture", false) {}

  bool ready() {
    return wait_for([this] { return client_.isServerConnected(); });
  }

  void come(const CaptureGoal& goal) {
    feedback.clear();
    client_.sendGoal(goal, {}, {},
                     [this](const CaptureFeedbackConstPtr& state) { feedback.push_back(*state); });
  }

  /// Waits for the answer.
  SimpleClientGoalState state() {
    wait_for([this] { return client_.getState().isDone(); });
    return client_.getState();
  }
  CaptureResult result() {
    state();
    return client_.getResult() ? *client_.getResult() : CaptureResult();
  }
  void leave() { client_.cancelGoal(); }

  std::vector<CaptureFeedback> feedback;

 private:
  ros::NodeHandle node_;
  Client client_;
};

CaptureGoal with_all_sensors(bool with_fit = false) {
  CaptureGoal goal;
  for (int sensor = 0; sensor < kSensors; ++sensor)
    goal.sensors.push_back("sensors/" + std::to_string(sensor) + "/points");
  goal.with_fit = with_fit;
  return goal;
}

/// Body a is 1.70 m tall, body b 1.78 m: nothing under the id of one may have the size of the other.
void expect_body(const CaptureResult& result, const std::string& body) {
  EXPECT_TRUE(result.measured) << result.code << ": " << result.message;
  EXPECT_NE(result.scan_id, "");
  EXPECT_EQ(result.landmarks.scan_id, result.scan_id);
  EXPECT_NEAR(height_of(result.landmarks, "stature"), body == "b" ? 1.78 : 1.70, 0.03);
}

class LeftBoothTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    sensors_ = std::make_unique<RecordedBooth>("left");
    customer_ = std::make_unique<Customer>("left");
    ASSERT_TRUE(customer_->ready() && wait_for([] { return sensors_->heard(); }))
        << "the booth did not come up";
  }
  static void TearDownTestSuite() {
    customer_.reset();
    sensors_.reset();
  }

  /// A customer whom all sensors see but one.
  static CaptureResult capture(const std::string& body, const CaptureGoal& goal, int silent = -1) {
    customer_->come(goal);
    start(body, silent);
    return customer_->result();
  }

  /// Sends once the action has the goal, as its first feedback shows, and hears its sensors beside the
  /// assembler. \pre the goal names all of them
  static void start(const std::string& body, int silent = -1) {
    EXPECT_TRUE(wait_for([] { return !customer_->feedback.empty() && sensors_->heard(2); }));
    sensors_->send_all(body, stamp_ += 10, silent);
  }

  static std::unique_ptr<RecordedBooth> sensors_;
  static std::unique_ptr<Customer> customer_;
  static double stamp_;
};

std::unique_ptr<RecordedBooth> LeftBoothTest::sensors_;
std::unique_ptr<Customer> LeftBoothTest::customer_;
double LeftBoothTest::stamp_ = 1000;

TEST_F(LeftBoothTest, ThreeCustomersInARow) {
  std::set<std::string> scans;
  for (const char* body : {"a", "b", "a"}) {
    const CaptureResult result = capture(body, with_all_sensors(true));
    expect_body(result, body);
    EXPECT_EQ(result.fit_status, FitState::CONVERGED);
    EXPECT_EQ(result.message, "");
    scans.insert(result.scan_id);
    double share = 0;
    for (const CaptureFeedback& state : customer_->feedback) {
      EXPECT_GE(state.progress, share);
      share = state.progress;
    }
    EXPECT_GT(share, 0.2);  // it was seen to go on
  }
  EXPECT_EQ(scans.size(), 3u);
}

TEST_F(LeftBoothTest, AMissingSensorIsNamedAndTheNextCustomerIsServed) {
  CaptureResult result = capture("a", with_all_sensors(), 4);
  EXPECT_FALSE(result.measured);
  EXPECT_EQ(result.code, "missing_sensor");
  EXPECT_NE(result.message.find("sensors/4/points"), std::string::npos) << result.message;
  EXPECT_TRUE(result.landmarks.heights.empty());
  result = capture("b", with_all_sensors());
  expect_body(result, "b");
}

TEST_F(LeftBoothTest, OutOfTimeEverySensorThatIsMissingIsNamed) {
  CaptureGoal goal = with_all_sensors();
  goal.sensors = {"sensors/3/points", "sensors/unplugged/points"};
  goal.timeout = 1;
  customer_->come(goal);
  const CaptureResult result = customer_->result();
  EXPECT_EQ(result.code, "missing_sensor");
  EXPECT_NE(result.message.find("waiting for sensors/3/points, sensors/unplugged/points"), std::string::npos)
      << result.message;
}

TEST_F(LeftBoothTest, ANewGoalTakesTheOldOnesPlaceAndCancelledIsCancelled) {
  Customer other("left");
  ASSERT_TRUE(other.ready());
  other.come(with_all_sensors());
  ASSERT_TRUE(wait_for([&] { return !other.feedback.empty(); }));
  const CaptureResult result = capture("a", with_all_sensors());
  expect_body(result, "a");
  EXPECT_EQ(other.state(), SimpleClientGoalState::PREEMPTED);
  EXPECT_FALSE(other.result().measured);
  customer_->come(with_all_sensors());
  ASSERT_TRUE(wait_for([] { return !customer_->feedback.empty(); }));
  customer_->leave();
  EXPECT_EQ(customer_->state(), SimpleClientGoalState::PREEMPTED);
}

TEST_F(LeftBoothTest, ANodeKilledInMidScanIsBackWithinFiveSeconds) {
  constexpr double kUsual = 3;  // s, a capture on two free cores: a busy machine gets longer
  const auto undisturbed = [&] {
    const ros::WallTime begin = ros::WallTime::now();
    expect_body(capture("b", with_all_sensors(true)), "b");
    return (ros::WallTime::now() - begin).toSec();
  };
  double usual = undisturbed();
  for (const std::string stage : {"reconstruction", "landmarks"}) {
    customer_->come(with_all_sensors(true));
    start("a");
    ASSERT_TRUE(wait_for([&] { return customer_->feedback.back().stage == "reconstruction"; }));
    ASSERT_TRUE(kill_node("/left/" + stage));
    const ros::WallTime killed = ros::WallTime::now();
    expect_body(customer_->result(), "a");
    const double taken = (ros::WallTime::now() - killed).toSec();
    usual = std::max(usual, undisturbed());  // it may have become busy meanwhile
    EXPECT_LT(taken, 5 * std::max(1.0, usual / kUsual)) << stage;
  }
}

TEST_F(LeftBoothTest, BesideAnotherEachMeasuresItsOwnCustomer) {
  Customer right("right");
  ASSERT_TRUE(right.ready());
  std::set<std::string> frames;
  ros::NodeHandle node;
  const boost::function<void(const tf2_msgs::TFMessage::ConstPtr&)> on_tf =
      [&](const tf2_msgs::TFMessage::ConstPtr& tf) {
        for (const auto& transform : tf->transforms)
          frames.insert(transform.header.frame_id + " > " + transform.child_frame_id);
      };
  const ros::Subscriber tf = node.subscribe<tf2_msgs::TFMessage>("/tf_static", 100, on_tf);

  right.come(with_all_sensors());  // its trigger makes the simulated booth scan
  const CaptureResult of_left = capture("b", with_all_sensors()), of_right = right.result();
  expect_body(of_left, "b");
  EXPECT_EQ(of_left.landmarks.header.frame_id, "left/booth");
  EXPECT_TRUE(of_right.measured) << of_right.code << ": " << of_right.message;
  EXPECT_EQ(of_right.landmarks.header.frame_id, "right/booth");
  EXPECT_NEAR(height_of(of_right.landmarks, "stature"),
              virtual_booth::random_customer(virtual_booth::Family::model, 1).truth.height("stature"), 0.03);
  EXPECT_TRUE(wait_for([&] {
    return frames.count("left/booth > left/body") + frames.count("right/booth > right/body") +
               frames.count("right/booth > right/sensor_0") ==
           3;
  }));
}

class WatchedFolderTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    fs::create_directories(inbox_);
    for (const fs::directory_entry& entry : fs::directory_iterator(inbox_)) fs::remove_all(entry.path());
  }

  void SetUp() override {
    ros::NodeHandle node("files");
    scan_ = node.subscribe("scan/points", 8, &WatchedFolderTest::on_scan, this);
    const boost::function<void(const ScanLabel::ConstPtr&)> on_label =
        [this](const ScanLabel::ConstPtr& label) { labels_[label->source] = *label; };
    label_ = node.subscribe<ScanLabel>("scan/label", 8, on_label);
    said_ = node.subscribe("/diagnostics", 100, &WatchedFolderTest::on_diagnostics, this);
    ASSERT_TRUE(wait_for([this] {
      return scan_.getNumPublishers() == 1 && !facts_.empty() && (!is_latched_ || !points_.empty());
    }));
    points_.clear();
  }

  static void write(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::app) << text;
  }

  /// An ASCII scan of that many points, as high as a person: another height would be another unit.
  static std::string ply(int points) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(points) +
                       "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    for (int i = 0; i < points; ++i) text += "0 0 " + std::to_string(1.7 * i / points) + "\n";
    return text;
  }

  void on_scan(const sensor_msgs::PointCloud2::ConstPtr& scan) {
    points_.push_back(scan->width);
    scan_ids_[scan->width] = node::tag_of(*scan).scan_id;
  }

  void on_diagnostics(const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
    for (const diagnostic_msgs::DiagnosticStatus& status : message->status)
      if (status.name == "files/scan_player: scan_player")
        for (const diagnostic_msgs::KeyValue& fact : status.values) facts_[fact.key] = fact.value;
  }

  bool played(const std::vector<std::uint32_t>& points) {
    const bool came = wait_for([&] { return points_ == points; });
    is_latched_ = is_latched_ || came;
    return came;
  }

  inline static const fs::path inbox_ = TENSEGRIC_FIT_INBOX;
  inline static bool is_latched_ = false;          // a scan was played: who joins now hears it again
  std::vector<std::uint32_t> points_;              // of each scan that came
  std::map<std::uint32_t, std::string> scan_ids_;  // by number of points
  std::map<std::string, ScanLabel> labels_;        // by file
  std::map<std::string, std::string> facts_;
  ros::Subscriber scan_, label_, said_;
};

// The folder of exports is one for all booths: what was deleted there looked like all that there was.
TEST_F(LeftBoothTest, ForgetSaysWhichOtherBoothsWereNotAsked) {
  Forget order;
  order.request.scan_id = "1.000000000-00000000";
  ASSERT_TRUE(ros::service::waitForService("/left/forget", ros::Duration(30)));
  ASSERT_TRUE(ros::service::call("/left/forget", order));
  EXPECT_NE(order.response.message.find(" in /left"), std::string::npos) << order.response.message;
  const auto& lines = order.response.not_reached;
  EXPECT_NE(std::find(lines.begin(), lines.end(), "/right: another booth, which was not asked"), lines.end());
}

TEST_F(WatchedFolderTest, NewCompleteFilesArePlayedOnceEachAndABrokenOneIsRefusedByName) {
  const std::string text = ply(40);
  write(inbox_ / "slow.ply", text.substr(0, text.size() / 2));
  listen(0.2);  // less than it takes to count as complete
  write(inbox_ / "slow.ply", text.substr(text.size() / 2));
  ASSERT_TRUE(played({40}));
  write(inbox_ / "broken.ply", ply(41).substr(0, 200));
  EXPECT_TRUE(
      wait_for([this] { return facts_["last_error_message"].find("broken.ply") != std::string::npos; }));
  EXPECT_EQ(facts_["last_error"], "broken_file");
  write(inbox_ / "next.part", ply(42));
  fs::rename(inbox_ / "next.part", inbox_ / "next.ply");
  ASSERT_TRUE(played({40, 42}));
  write(inbox_ / "4711_left.ply", ply(44));
  ASSERT_TRUE(played({40, 42, 44}));
  EXPECT_TRUE(wait_for([this] { return labels_.count("4711_left.ply") != 0; }));
  EXPECT_EQ(labels_["4711_left.ply"].customer, "4711");
  EXPECT_EQ(labels_["next.ply"].customer, "");
  EXPECT_EQ(labels_["next.ply"].scan_id, scan_ids_[42]);
  EXPECT_EQ(labels_["4711_left.ply"].scan_id, scan_ids_[44]);
  listen(1);  // for any that come twice
  EXPECT_EQ(points_.size(), 3u);
}

TEST_F(WatchedFolderTest, APlayerThatWasKilledGoesOnWhereItWas) {
  ASSERT_TRUE(kill_node("/files/scan_player"));
  write(inbox_ / "meanwhile.ply", ply(43));
  EXPECT_TRUE(played({43}));
  listen(1);  // for the old ones, which must not come again
  EXPECT_EQ(points_.size(), 1u);
}

}  // namespace
}  // namespace tensegric_fit::tests
