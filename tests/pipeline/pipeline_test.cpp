/// Good scans through the launched chain.
#include <gtest/gtest.h>
#include <pcl_msgs/PolygonMesh.h>
#include <sensor_msgs/Image.h>
#include <tensegric_fit/DeleteExport.h>
#include <tensegric_fit/ExportFit.h>
#include <tensegric_fit/Forget.h>
#include <tensegric_fit/ScanLabel.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <memory>

#include "fitted_chain.hpp"
#include "geometry/status.hpp"
#include "ros/line_force.hpp"
#include "ros/stage.hpp"

namespace tensegric_fit::tests {
namespace {

namespace fs = std::filesystem;

double height_of(const Landmarks& landmarks, const std::string& name) {
  for (const Measure& height : landmarks.heights)
    if (height.name == name) return height.value;
  return 0;
}

double extent_of(const std::vector<float>& vertices) {
  float low = vertices.at(2), high = low;
  for (std::size_t i = 2; i < vertices.size(); i += 3) {
    low = std::min(low, vertices[i]);
    high = std::max(high, vertices[i]);
  }
  return high - low;
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(PipelineTest, EveryTopicOnceWithOneScanId) {
  listen(1);  // for any that come twice
  EXPECT_EQ(client_->models.size(), 1u);
  EXPECT_EQ(client_->bodies.size(), 1u);
  EXPECT_EQ(client_->landmarks.size(), 1u);
  EXPECT_EQ(client_->controls.size(), 1u);
  EXPECT_EQ(client_->fits.size(), 1u);
  EXPECT_EQ(client_->deformed.size(), 1u);
  EXPECT_EQ(count_of(client_->models, scan_id_), 1);
  EXPECT_EQ(count_of(client_->bodies, scan_id_), 1);
  EXPECT_EQ(count_of(client_->landmarks, scan_id_), 1);
  EXPECT_EQ(client_->models.front()->header.stamp, client_->bodies.front()->header.stamp);
  EXPECT_EQ(client_->models.front()->mesh_parts.size() * 3, client_->bodies.front()->vertices.size());
  EXPECT_EQ(count_of(client_->controls, scan_id_), 1);
  EXPECT_EQ(count_of(client_->fits, scan_id_), 1);
  EXPECT_EQ(client_->deformed.front()->header.stamp, client_->bodies.front()->header.stamp);
  EXPECT_EQ(client_->deformed.front()->header.frame_id, "booth");
  EXPECT_EQ(client_->deformed.front()->vertices.size(), client_->bodies.front()->vertices.size());
  EXPECT_EQ(client_->deformed.front()->distortion.size() * 3, client_->bodies.front()->vertices.size());
  EXPECT_EQ(client_->fits.front()->outer.size(), client_->controls.front()->outer.size());
  EXPECT_EQ(client_->fits.front()->status, FitState::CONVERGED);
  ASSERT_TRUE(wait_for([] { return !client_->forces.empty(); }));
  const auto chest = node::force_of(*client_->forces.front(), *client_->fits.front(), 0);
  ASSERT_TRUE(chest);
  EXPECT_GT(chest->newtons, 1);
  EXPECT_GT(chest->kilopascals, 0.1);
}

TEST_F(PipelineTest, StagesSayWhatTheyDid) {
  ASSERT_TRUE(wait_for([] {
    return std::all_of(client_->diagnostics.begin(), client_->diagnostics.end(),
                       [](const auto& stage) { return stage.second.at("state") == "done"; });
  }));
  for (const auto& [stage, facts] : client_->diagnostics) {
    EXPECT_EQ(facts.at("scan_id"), scan_id_) << stage;
    EXPECT_EQ(facts.at("last_error"), "") << stage;
    EXPECT_GT(std::stod(facts.at("milliseconds")), 0) << stage;
  }
}

TEST_F(PipelineTest, WhoJoinsLateGetsEverything) {
  client_.reset();  // a second subscriber in one process would be served by roscpp, not by the nodes
  client_ = std::make_unique<ChainClient>();
  EXPECT_TRUE(fit_and_body_came());
  ASSERT_TRUE(client_->ready());
  EXPECT_EQ(count_of(client_->models, scan_id_), 1);
  EXPECT_EQ(count_of(client_->bodies, scan_id_), 1);
  EXPECT_EQ(count_of(client_->landmarks, scan_id_), 1);
  EXPECT_EQ(count_of(client_->controls, scan_id_), 1);
  EXPECT_EQ(count_of(client_->fits, scan_id_), 1);
  EXPECT_EQ(count_of(client_->deformed, scan_id_), 1);
}

TEST_F(PipelineTest, MarkersMeshesAndPicturesForWhoeverListens) {
  ros::NodeHandle node;
  std::map<std::string, visualization_msgs::MarkerArray::ConstPtr> markers;
  std::map<std::string, sensor_msgs::Image::ConstPtr> images;
  std::map<std::string, pcl_msgs::PolygonMesh::ConstPtr> meshes;
  std::vector<ros::Subscriber> subscribers;
  const std::vector<std::string> stages = {"reconstruction", "landmarks", "control_mesh", "tensegric",
                                           "tffd"};
  for (const std::string& stage : stages) {
    const boost::function<void(const visualization_msgs::MarkerArray::ConstPtr&)> on_markers =
        [&markers, stage](const visualization_msgs::MarkerArray::ConstPtr& message) {
          markers[stage] = message;
        };
    const boost::function<void(const sensor_msgs::Image::ConstPtr&)> on_image =
        [&images, stage](const sensor_msgs::Image::ConstPtr& message) { images[stage] = message; };
    const boost::function<void(const pcl_msgs::PolygonMesh::ConstPtr&)> on_mesh =
        [&meshes, stage](const pcl_msgs::PolygonMesh::ConstPtr& message) { meshes[stage] = message; };
    subscribers.push_back(node.subscribe<visualization_msgs::MarkerArray>(stage + "/markers", 1, on_markers));
    subscribers.push_back(node.subscribe<sensor_msgs::Image>(stage + "/image", 1, on_image));
    subscribers.push_back(node.subscribe<pcl_msgs::PolygonMesh>(stage + "/polygon_mesh", 1, on_mesh));
  }
  ASSERT_TRUE(wait_for([&] { return markers.size() == 5 && images.size() == 5 && meshes.size() == 5; }));

  const std::size_t corners = client_->bodies.back()->triangles.size();
  const visualization_msgs::Marker& body = markers["tffd"]->markers.back();
  EXPECT_EQ(body.points.size(), corners);
  ASSERT_EQ(body.colors.size(), corners);
  const auto [darkest, brightest] = std::minmax_element(
      body.colors.begin(), body.colors.end(), [](const auto& a, const auto& b) { return a.g < b.g; });
  EXPECT_LT(darkest->g, 0.7 * brightest->g) << "no light is baked in: rviz would show a flat shape";
  EXPECT_EQ(meshes["tffd"]->polygons.size() * 3, corners);
  for (const std::string& stage : stages) {
    const auto& pixels = images[stage]->data;
    EXPECT_LT(*std::min_element(pixels.begin(), pixels.end()), 128) << stage << ": an empty picture";
  }
}

TEST_F(PipelineTest, AnExportIsWholeNeverOverwrittenAndDeletedByScan) {
  const fs::path folder = fs::path(TENSEGRIC_FIT_SCANS) / "exported";
  fs::remove_all(folder);
  ExportFit request;
  request.request.directory = folder.string();
  request.request.scan_id = "of another customer";
  ASSERT_TRUE(ros::service::call("export_fit", request));
  EXPECT_EQ(request.response.code, "nothing_yet");
  request.request.scan_id = scan_id_;
  ScanLabel label;  // a shop's program says whose scan it was
  label.scan_id = scan_id_;
  label.customer = "4711";
  ros::Publisher labels = ros::NodeHandle().advertise<ScanLabel>("scan/label", 1, true);
  labels.publish(label);
  // The label and the call go ways of their own: again until the label has come first.
  EXPECT_TRUE(wait_for([&] {
    fs::remove_all(folder);
    EXPECT_TRUE(ros::service::call("export_fit", request));
    EXPECT_TRUE(request.response.exported) << request.response.message;
    return HasFailure() || text_of(folder / "fit.json").find("\"customer\": \"4711\"") != std::string::npos;
  }));
  ASSERT_FALSE(HasFailure());
  EXPECT_EQ(request.response.files.size(), 18u);
  for (const std::string& file : request.response.files) EXPECT_GT(fs::file_size(file), 0u) << file;
  const std::string validate = "/usr/bin/python3 -m jsonschema -i '" + (folder / "fit.json").string() +
                               "' '" TENSEGRIC_FIT_SOURCE_DIR "/launch/schemas/fit.schema.json'";
  EXPECT_EQ(std::system(validate.c_str()), 0);

  ASSERT_TRUE(ros::service::call("export_fit", request));
  EXPECT_FALSE(request.response.exported);
  EXPECT_EQ(request.response.code, "bad_option");
  request.request.directory = "somewhere/relative";
  ASSERT_TRUE(ros::service::call("export_fit", request));
  EXPECT_EQ(request.response.code, "bad_option");

  DeleteExport erase;
  erase.request.directory = folder.parent_path().string();
  erase.request.scan_id = scan_id_;
  ASSERT_TRUE(ros::service::call("delete_export", erase));
  EXPECT_TRUE(erase.response.deleted) << erase.response.message;
  EXPECT_EQ(erase.response.folders, std::vector<std::string>{folder.string()});
  EXPECT_FALSE(fs::exists(folder));
  ASSERT_TRUE(ros::service::call("delete_export", erase));
  EXPECT_EQ(erase.response.code, "nothing_yet");
}

TEST_F(PipelineTest, TwoScansInARowNeverMix) {
  client_->forget();
  const std::string a = client_->send(booth_scan("a"));
  const std::string b = client_->fit(booth_scan("b"));
  ASSERT_NE(b, "");
  listen(1);
  EXPECT_EQ(client_->deformed.back()->scan_id, b);  // the newest has the last word
  EXPECT_EQ(count_of(client_->deformed, b), 1);

  // Body b is 0.08 m taller than body a: nothing under one id may have the size of the other.
  for (const Landmarks::ConstPtr& landmarks : client_->landmarks) {
    const double wanted = landmarks->scan_id == b ? 1.78 : 1.70;
    EXPECT_NEAR(height_of(*landmarks, "stature"), wanted, 0.03) << landmarks->scan_id;
  }
  for (const TriangleMesh::ConstPtr& body : client_->bodies) {
    for (const DeformedMesh::ConstPtr& deformed : client_->deformed) {
      if (deformed->scan_id != body->scan_id) continue;
      EXPECT_EQ(deformed->vertices.size(), body->vertices.size());
      EXPECT_NEAR(extent_of(deformed->vertices), extent_of(body->vertices),
                  0.001);  // a bust garment moves no sole
    }
  }
  EXPECT_LE(count_of(client_->deformed, a), 1);
}

TEST_F(PipelineTest, AMeshThatComesAloneIsMeasuredToo) {
  ASSERT_NE(client_->fit(booth_scan("a")), "");
  ASSERT_TRUE(wait_for([] { return !client_->landmarks.empty() && !client_->bodies.empty(); }));
  const Landmarks with_model = *client_->landmarks.back();
  TriangleMesh mesh = *client_->bodies.back();
  mesh.scan_id = "from elsewhere";
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<TriangleMesh>("body/mesh", 1);
  ASSERT_TRUE(wait_for([&] { return publisher.getNumSubscribers() >= 5; }));
  client_->forget();
  publisher.publish(mesh);
  ASSERT_TRUE(wait_for([&] { return count_of(client_->deformed, mesh.scan_id) == 1; }));
  EXPECT_EQ(count_of(client_->landmarks, mesh.scan_id), 1);
  EXPECT_TRUE(client_->models.empty());
  EXPECT_NEAR(height_of(*client_->landmarks.back(), "bust"), height_of(with_model, "bust"), 0.01);
  EXPECT_EQ(client_->diagnostics.at("landmarks: landmarks").at("body_model"), "registered to the mesh");
}

TEST_F(PipelineTest, TheSameScanTwiceIsFittedTwice) {
  const sensor_msgs::PointCloud2 scan = booth_scan("a");
  ASSERT_NE(client_->fit(scan), "");
  client_->forget();
  const std::string again = client_->fit(scan);
  ASSERT_NE(again, "");
  listen(1);
  EXPECT_EQ(count_of(client_->bodies, again), 1);
  EXPECT_EQ(count_of(client_->fits, again), 1);
  EXPECT_EQ(count_of(client_->deformed, again), 1);
}

// In this process: how a stage reports, whatever it works on.
TEST_F(PipelineTest, AStageReportsTheScanThatItWorkedOnAndNoFactsOfAnother) {
  node::Stage stage("probe", ros::NodeHandle());
  const std::string name = ros::this_node::getName().substr(1) + ": probe";
  const auto says = [&](const std::string& state) {
    return wait_for([&] { return client_->diagnostics[name]["state"] == state; });
  };
  std::promise<void> may_end;
  stage.begin("one");
  stage.post("one", [ending = may_end.get_future().share()]() -> node::Stage::Result {
    ending.wait();
    return {[] {}, {{"garment", "B1"}}};
  });
  ASSERT_TRUE(says("working"));
  stage.refuse("", geometry::Refusal("bad_garment", "it has no lines"));
  ASSERT_TRUE(says("refused"));
  may_end.set_value();
  ASSERT_TRUE(says("done"));
  EXPECT_EQ(client_->diagnostics[name]["scan_id"], "one");
  EXPECT_EQ(client_->diagnostics[name]["garment"], "B1");
  EXPECT_EQ(client_->diagnostics[name]["level"], "0");
  client_->diagnostics.erase(name);
  stage.refuse("two", geometry::Refusal("not_a_body", "it is a chair"));
  ASSERT_TRUE(says("refused"));
  EXPECT_EQ(client_->diagnostics[name].count("garment"), 0u);
  client_->diagnostics.erase(name);
}

TEST_F(PipelineTest, AForgottenScanIsNowhereAndTheNextOneIsFitted) {
  const fs::path folder = fs::path(TENSEGRIC_FIT_SCANS) / "forgotten";
  fs::remove_all(folder);
  const std::string a = client_->fit(booth_scan("a"));
  ASSERT_NE(a, "");
  ExportFit request;
  request.request.directory = folder / "one";
  ASSERT_TRUE(ros::service::call("export_fit", request));
  ASSERT_TRUE(request.response.exported) << request.response.message;

  Forget order;
  order.request.scan_id = "of another customer";
  ASSERT_TRUE(ros::service::call("forget", order));
  EXPECT_TRUE(order.response.removed.empty());
  order.request.scan_id = a;
  order.request.folders = {folder};
  ASSERT_TRUE(ros::service::call("forget", order));
  EXPECT_TRUE(order.response.complete) << order.response.not_reached.front();
  std::string removed, not_reached;
  for (const std::string& line : order.response.removed) removed += line + "\n";
  for (const std::string& line : order.response.not_reached) not_reached += line + "\n";
  for (const char* node :
       {"/reconstruction:", "/landmarks:", "/control_mesh:", "/tensegric:", "/tffd:", "export "})
    EXPECT_NE(removed.find(node), std::string::npos) << node << " is not in\n" << removed;
  for (const char* topic : {"/body/mesh", "/control/deformed"})
    EXPECT_NE(not_reached.find(ros::this_node::getName() + ": what it keeps, latches or shows of " + topic),
              std::string::npos)
        << not_reached;
  EXPECT_FALSE(fs::exists(folder / "one"));

  client_.reset();  // roscpp would serve a second subscriber of this process from its own latched copies
  ChainClient late;
  ASSERT_TRUE(late.ready());
  listen(2);
  EXPECT_EQ(count_of(late.models, a), 0);
  EXPECT_EQ(count_of(late.bodies, a), 0);
  EXPECT_EQ(count_of(late.landmarks, a), 0);
  EXPECT_EQ(count_of(late.controls, a), 0);
  EXPECT_EQ(count_of(late.fits, a), 0);
  EXPECT_EQ(count_of(late.forces, a), 0);
  EXPECT_EQ(count_of(late.deformed, a), 0);
  ASSERT_TRUE(ros::service::call("export_fit", request));
  EXPECT_EQ(request.response.code, "nothing_yet");
  EXPECT_NE(late.fit(booth_scan("b")), "");
}

}  // namespace
}  // namespace tensegric_fit::tests
