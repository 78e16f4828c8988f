/// Two runs beside each other, and a case made from a bag.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <unistd.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>

#include "compare.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"
#include "message_fields.hpp"
#include "record.hpp"
#include "ros/scan_tag.hpp"
#include "scan_files/scan_bag.hpp"
#include "tensegric/fit_messages.hpp"
#include "xyz_cloud.hpp"

namespace tensegric_fit::regression {
namespace {

namespace fs = std::filesystem;
const ros::Time kTime(5, 250000000);

template <typename Message>
std::vector<Field> fields_of(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  const MessageReader reader(ros::message_traits::datatype<Message>(),
                             ros::message_traits::definition<Message>());
  EXPECT_THROW(reader.fields_of({bytes.begin(), bytes.end() - 1}), std::runtime_error);
  return reader.fields_of(bytes);
}

const Field& field(const std::vector<Field>& fields, const std::string& path) {
  for (const Field& candidate : fields)
    if (candidate.path == path) return candidate;
  throw std::out_of_range(path);
}

class CompareTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  // A cube that lies so far to her right, as body/mesh, with a girth.
  std::string write(const std::string& name, float right, double bust,
                    const std::string& scan_id = "s") const {
    TriangleMesh body;
    body.scan_id = scan_id;
    for (int corner = 0; corner < 8; ++corner)
      for (int axis = 0; axis < 3; ++axis)
        body.vertices.push_back(static_cast<float>((corner >> axis) & 1) - (axis == 1 ? right : 0));
    body.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                      2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    BodyModel model;
    model.scan_id = scan_id;
    model.parts = {"trunk", "head"};
    model.mesh_parts = {0, 0, 0, 0, 1, 1, 1, 1};  // the head is z = 1
    Landmarks landmarks;
    landmarks.scan_id = scan_id;
    landmarks.body_from_scan = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    landmarks.girths.resize(2);
    landmarks.girths[0].name = "hip";
    landmarks.girths[1].name = "bust";
    landmarks.girths[1].value = bust;
    FitState on_the_way;
    on_the_way.scan_id = scan_id;
    on_the_way.status = FitState::SOLVING;
    on_the_way.residual = right;
    rosbag::Bag bag(folder_ / name, rosbag::bagmode::Write);
    bag.write("/booth_2/body/mesh", kTime, body);
    bag.write("/booth_2/body/model", kTime, model);
    bag.write("/booth_2/body/landmarks", kTime, landmarks);
    bag.write("/booth_2/control/deformed", kTime, on_the_way);
    return folder_ / name;
  }

  const fs::path folder_ = fs::temp_directory_path() / ("compare_test." + std::to_string(getpid()));
};

TEST_F(CompareTest, FieldsAreReadByTheDefinitionThatTravelsWithThem) {
  FitState fit;
  fit.header.stamp = kTime;
  fit.header.frame_id = "booth";
  fit.status = FitState::CAPPED;
  fit.iteration = 7;
  fit.outer = {1, 2, 3.5};
  fit.lines.resize(2);
  fit.lines[1].name = "chest";
  fit.lines[1].ratio = 0.95;
  const std::vector<Field> fields = fields_of(fit);
  EXPECT_EQ(field(fields, "header.stamp").numbers, std::vector<double>{5.25});
  EXPECT_EQ(field(fields, "header.frame_id").words, std::vector<std::string>{"booth"});
  EXPECT_EQ(field(fields, "status").words, std::vector<std::string>{"capped"});
  EXPECT_EQ(field(fields, "iteration").numbers, std::vector<double>{7});
  EXPECT_EQ(field(fields, "outer").numbers, (std::vector<double>{1, 2, 3.5}));
  EXPECT_EQ(field(fields, "lines[chest].ratio").numbers, std::vector<double>{0.95});
  EXPECT_EQ(field(fields, "lines[0].ratio").numbers, std::vector<double>{0}) << "without a name: counted";
  EXPECT_THROW(field(fields, "SOLVING"), std::out_of_range) << "a constant is no field";
  EXPECT_THROW(MessageReader("a/B", "C c\n"), std::runtime_error);
}

TEST_F(CompareTest, TheSameRunIsTheSame) {
  const std::string one = write("one.bag", 0, 0.9);
  const RunComparison comparison = compare_bags(one, write("other.bag", 0, 0.9));
  EXPECT_TRUE(comparison.same()) << to_text(comparison);
  ASSERT_EQ(comparison.skins.size(), 1u);
  EXPECT_TRUE(comparison.skins[0].parts.empty());
  EXPECT_EQ(differences_json({comparison}), "");
}

TEST_F(CompareTest, TopicFieldAmountAndPlaceAreNamed) {
  const RunComparison comparison = compare_bags(write("one.bag", 0, 0.9), write("other.bag", 0.0625, 0.91));
  EXPECT_FALSE(comparison.same());
  std::map<std::string, FieldDifference> found;
  for (const TopicDifference& topic : comparison.topics)
    for (const FieldDifference& difference : topic.fields)
      found[topic.topic + " " + difference.field] = difference;
  ASSERT_EQ(found.size(), 2u) << to_text(comparison);
  EXPECT_EQ(found.at("body/mesh vertices").differing, 8u);
  EXPECT_EQ(found.at("body/mesh vertices").of, 24u);
  EXPECT_EQ(found.at("body/mesh vertices").most, 0.0625);
  EXPECT_NEAR(found.at("body/landmarks girths[bust].value").most, 0.01, 1e-12);  // rounding
  EXPECT_EQ(found.at("body/landmarks girths[bust].value").other, "0.91");
  ASSERT_EQ(comparison.skins.size(), 1u);
  ASSERT_EQ(comparison.skins[0].parts.size(), 2u);
  for (const PartDifference& part : comparison.skins[0].parts) {
    EXPECT_NEAR(part.most, -0.0625, 1e-9) << part.part << ": the second lies inside";
    EXPECT_EQ(part.left, 1) << "on her left side";
    EXPECT_EQ(part.height, part.part == "head" ? 1 : 0);
  }
  EXPECT_EQ(comparison.skins[0].pictures.size(), 2u);
  const std::string page = differences_page({comparison});
  EXPECT_NE(page.find("girths[bust].value"), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos) << "needs a network";
}

TEST_F(CompareTest, WhatIsMissingOrOfAnotherScanIsSaid) {
  const std::string one = write("one.bag", 0, 0.9);
  RunComparison comparison = compare_bags(one, write("other.bag", 0, 0.9, "t"));
  ASSERT_EQ(comparison.notes.size(), 1u);
  EXPECT_EQ(comparison.notes[0], "other scans: s and t");
  rosbag::Bag(folder_ / "empty.bag", rosbag::bagmode::Write).write("/x", kTime, std_msgs::Header());
  EXPECT_THROW(compare_bags(one, folder_ / "empty.bag"), geometry::Refusal);
  std::ofstream(folder_ / "junk.bag") << "#ROSBAG V2.0\njunk";
  fs::copy_file(one, folder_ / "cut.bag");
  fs::resize_file(folder_ / "cut.bag", fs::file_size(one) / 2);
  for (const char* name : {"missing.bag", "junk.bag", "cut.bag"})
    EXPECT_THROW(compare_runs(one, folder_ / name), geometry::Refusal) << name;
  EXPECT_THROW(compare_runs(one, folder_), geometry::Refusal) << "a bag and a folder";
  EXPECT_THROW(compare_runs(folder_, folder_), geometry::Refusal) << "no case in common";
}

TEST_F(CompareTest, ACaseThatOneRunLacksIsADifference) {
  for (const char* name : {"before/a", "before/b", "after/a"}) fs::create_directories(folder_ / name);
  for (const char* name : {"before/a/result.bag", "before/b/result.bag", "after/a/result.bag"})
    write(name, 0, 0.9);
  const std::string before = folder_ / "before", after = folder_ / "after";
  for (const auto& [one, other] : {std::pair(before, after), {after, before}}) {
    const std::vector<RunComparison> cases = compare_runs(one, other);
    ASSERT_EQ(cases.size(), 2u);
    EXPECT_TRUE(cases[0].same()) << to_text(cases[0]);
    EXPECT_EQ(cases[1].name, "b");
    EXPECT_FALSE(cases[1].same());
    EXPECT_EQ(cases[1].notes, std::vector<std::string>{"only " + before + " has this case"});
  }
}

class RecordTest : public CompareTest {
 protected:
  RecordRequest scan_and(const std::vector<Garment>& garments) const {
    geometry::PointCloud cloud;
    cloud.points = {{0, 0, 0}, {0, 0, 1}};
    const std::string bag = folder_ / "scan.bag";
    scan_files::write_bag_scan(bag, cloud, "booth", std::chrono::nanoseconds(kTime.toNSec()));
    rosbag::Bag appended(bag, rosbag::bagmode::Append);
    for (std::size_t i = 0; i < garments.size(); ++i)
      appended.write("/garment", kTime + ros::Duration(1.0 + static_cast<double>(i)), garments[i]);
    RecordRequest request;
    request.bag = bag;
    request.name = "mine";
    request.cases = folder_ / "cases";
    return request;
  }
  static Garment shipped(const std::string& name) {
    return node::to_message({}, {tensegric::take_garment(name, geometry::shipped_folder("garments")), ""});
  }
  Case written() const {
    const std::string file = folder_ / "cases" / "mine.yaml";
    return load_case(file);
  }
};

TEST_F(RecordTest, ShippedGarmentsAreWrittenByName) {
  Garment looser = shipped("B1");
  looser.lines[0].ratio = 0.97;
  write_case_input(scan_and({shipped("B1"), looser}));
  const Case asked = written();
  ASSERT_EQ(asked.garments.size(), 2u);
  EXPECT_FALSE(asked.own_garments);
  EXPECT_EQ(asked.garments[0].name, "B1");
  EXPECT_EQ(asked.garments[1].lines[0].ratio, 0.97);
  EXPECT_EQ(asked.pipeline["control_mesh"]["template"].as<std::string>(), "bust");
  EXPECT_THROW(write_case_input(scan_and({})), geometry::Refusal) << "it is there already";
}

TEST_F(RecordTest, ABagThatLiesWhereTheCasesWouldIsLeftAsItIs) {
  RecordRequest request = scan_and({});
  const fs::path bags = folder_ / "cases" / "bags";
  fs::create_directories(bags);
  fs::rename(request.bag, bags / "mine.bag");
  request.bag = bags / "mine.bag";
  const auto size = fs::file_size(request.bag);
  EXPECT_THROW(write_case_input(request), geometry::Refusal);
  EXPECT_EQ(fs::file_size(request.bag), size);
}

TEST_F(RecordTest, OtherGarmentsStayInTheBag) {
  Garment own = shipped("H1");
  own.lines[0].width = 0.05;
  write_case_input(scan_and({own}));
  const Case asked = written();
  EXPECT_TRUE(asked.own_garments);
  ASSERT_EQ(asked.garments.size(), 1u);
  EXPECT_EQ(asked.garments[0].lines[0].width, 0.05);
  EXPECT_EQ(asked.pipeline["control_mesh"]["template"].as<std::string>(), "hips");
}

TEST_F(RecordTest, WhatWasWornOnThatScanIsWorn) {
  const RecordRequest first = scan_and({});
  sensor_msgs::PointCloud2 cloud = xyz_cloud(1);
  ros::Time time = kTime;
  rosbag::Bag bag(first.bag, rosbag::bagmode::Write);
  const auto next = [&time] { return time += ros::Duration(1); };
  for (const char* name : {"H1", "B1", "", "H2", "H2", "", "B1"})
    if (*name == 0)
      bag.write("/scan/points", next(), cloud);
    else
      bag.write("/garment", next(), shipped(name));
  bag.close();
  for (const auto& [scan, worn] : {std::pair(1, std::vector<std::string>{"B1", "H2"}), {2, {"H2", "B1"}}}) {
    RecordRequest request = first;
    request.scan = scan;
    write_case_input(request);
    std::vector<std::string> names;
    for (const Garment& garment : written().garments) names.push_back(garment.name.substr(0, 2));
    EXPECT_EQ(names, worn) << scan;
    fs::remove_all(folder_ / "cases");
  }
}

TEST_F(RecordTest, ARefusedScanIsACaseToo) {
  const RecordRequest request = scan_and({});
  write_case_input(request);
  HarnessOptions options;
  options.replay = false;
  options.folder = folder_ / "out";
  const Outcome outcome = add_everything_found(request, options);
  EXPECT_EQ(outcome.recording.refusal, "too_few_points");
  const Case asked = written();
  EXPECT_TRUE(asked.measure_only());
  ASSERT_EQ(asked.expectations.size(), 2u);
  const fs::path earlier = folder_ / "out" / "mine" / "replayed.bag";
  std::ofstream(earlier) << "of an earlier run";
  EXPECT_TRUE(run_case(asked, options).holds());
  EXPECT_FALSE(fs::exists(earlier)) << "compare would take it for this one's";
}

TEST_F(RecordTest, CloudsOfSensorsAreAssembled) {
  const RecordRequest request = scan_and({});
  sensor_msgs::PointCloud2 cloud = xyz_cloud(1);
  cloud.header.stamp = kTime;
  cloud.header.frame_id = "camera";
  tf2_msgs::TFMessage places;
  places.transforms.resize(1);
  places.transforms[0].header.frame_id = "booth";
  places.transforms[0].child_frame_id = "camera";
  places.transforms[0].transform.rotation.w = 1;
  HarnessOptions options;
  options.replay = false;
  options.folder = folder_ / "out";
  for (const bool placed : {false, true}) {
    rosbag::Bag bag(request.bag, rosbag::bagmode::Write);
    for (const int i : {10, 9, 0}) bag.write("/camera_" + std::to_string(i) + "/points", kTime, cloud);
    if (placed) bag.write("/tf_static", kTime, places);
    for (const char* garment : {"B1", "H2", "H2"}) bag.write("/garment", kTime, shipped(garment));
    bag.close();
    write_case_input(request);
    if (placed) break;
    EXPECT_THROW(add_everything_found(request, options), geometry::Refusal) << "nobody says where they stand";
    EXPECT_FALSE(fs::exists(folder_ / "cases" / "mine.yaml"));
    EXPECT_TRUE(fs::is_empty(folder_ / "cases" / "bags"));
  }
  EXPECT_EQ(add_everything_found(request, options).recording.refusal, "too_few_points") << "of three points";
  const Case asked = written();
  EXPECT_TRUE(asked.sensors());
  EXPECT_EQ(asked.pipeline["assembler"]["sensors"].as<std::vector<std::string>>(),
            (std::vector<std::string>{"camera_0/points", "camera_9/points", "camera_10/points"}));
}

TEST_F(RecordTest, BadRequestsAreNamed) {
  RecordRequest request = scan_and({});
  request.scan = 2;
  EXPECT_THROW(write_case_input(request), geometry::Refusal);
  request.scan = 1;
  std::swap(request.bag, request.cases);
  EXPECT_THROW(write_case_input(request), geometry::Refusal) << "no bag";
  std::swap(request.bag, request.cases);
  request.name = "../mine";
  EXPECT_THROW(write_case_input(request), geometry::Refusal);
}

TEST(MetricLines, EverythingButTheRunsOwnIsExpected) {
  const std::string lines = metric_lines({{"girth/bust", 0.9},
                                          {"2/line/chest/tension", 100.0},
                                          {"refusal", std::string("none")},
                                          {"time/tffd", 1.0}});
  EXPECT_EQ(
      lines,
      "  2/line/chest/tension: {golden: 100, tolerance: 2, reason: \"2 % stiffer parts pull 2 % more\"}\n"
      "  girth/bust: {golden: 0.9, tolerance: 0.001, reason: \"a millimetre\"}\n"
      "  refusal: {golden: none, reason: as recorded}\n");
}

}  // namespace
}  // namespace tensegric_fit::regression
