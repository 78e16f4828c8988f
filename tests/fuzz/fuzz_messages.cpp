// Messages of the chain, sound ones with changes, into what reads them: the first byte chooses the message.
// What roscpp itself refuses (bytes that are no message) does not come here.
#include <boost/make_shared.hpp>

#include "body_model/model_message.hpp"
#include "body_model/parts.hpp"
#include "body_model/registration.hpp"
#include "control_mesh/control_mesh_handler.hpp"
#include "correlation/correlation_handler.hpp"
#include "fit/bind_body.hpp"
#include "fuzz_target.hpp"
#include "geometry/shipped_files.hpp"
#include "input.hpp"
#include "landmarks/landmarks_handler.hpp"
#include "ros/body_messages.hpp"
#include "ros/fit_document.hpp"
#include "ros/scan_labels.hpp"
#include "tensegric/kept_garment_message.hpp"
#include "tensegric/tensegric_handler.hpp"
#include "tensegric_bust.hpp"
#include "tffd/tffd_handler.hpp"
#include "xyz_cloud.hpp"

namespace {

using namespace tensegric_fit;
using namespace tensegric_fit::node;

template <typename... Arrays>
void change_all(fuzz::Input& input, Arrays&... arrays) {
  (fuzz::change(input, arrays), ...);
}

void change(fuzz::Input& input, TriangleMesh& message) {
  message.filled.assign(message.vertices.size() / 3, 0);
  message.fractures.resize(input.number(1) % 3);
  for (Fracture& fracture : message.fractures)
    fuzz::draw_some(input, fracture.centre[0], fracture.radius, fracture.area, fracture.offset);
  change_all(input, message.vertices, message.triangles, message.filled);
}

void change(fuzz::Input& input, Landmarks& message) {
  for (double& entry : message.body_from_scan) fuzz::draw_some(input, entry);
  for (Landmark& point : message.points) fuzz::draw_some(input, point.position[1], point.confidence);
  for (Measure& measure : message.heights) fuzz::draw_some(input, measure.value, measure.half_width);
  message.loops.resize(input.number(1) % 3);
  for (GirthLoop& loop : message.loops) {
    loop.points = {0, 0, 1, 1, 0, 1, 0, 1, 1};
    fuzz::change(input, loop.points);
  }
  change_all(input, message.points, message.heights, message.girths, message.missing);
}

void change(fuzz::Input& input, ControlMesh& message) {
  change_all(input, message.outer, message.inner, message.triangles, message.outer_fixed, message.inner_fixed,
             message.names, message.regions, message.lines);
  for (ControlRegion& region : message.regions) fuzz::change(input, region.triangles);
  for (ControlLine& line : message.lines) fuzz::change(input, line.nodes);
}

void change(fuzz::Input& input, Garment& message) {
  for (GarmentLine& line : message.lines) {
    fuzz::draw_some(input, line.ratio, line.stiffness, line.tension_limit, line.width, line.smooth);
    constexpr const char* kLaws[] = {"", "rigid", "stiffness", "table", "rubber"};
    line.law = kLaws[input.number(1) % 5];
    line.taut = static_cast<std::uint8_t>(input.number(1) % 2);
    if (input.number(1) % 2 != 0) line.stretch = line.tension = {1, 1.1, 1.3};
    const std::uint32_t course = input.number(1) % 4;
    if (course == 0) line.through = {"axilla_L", "sternum", "axilla_R"};
    if (course == 1) line.through = {"bust_point_L", "fan", "axilla_L", "sternum"};
    if (input.number(1) % 4 == 0) line.points = {0.1, -0.12, 1.2, 0, -0.13, 1.2, -0.1, -0.12, 1.2};
    change_all(input, line.stretch, line.tension, line.through, line.points);
  }
  change_all(input, message.lines, message.regions);
  constexpr const char* kSolvers[] = {"", "equilibrium", "adaptive", "relaxation", "finite elements"};
  message.solver = kSolvers[input.number(1) % 5];
}

void change(fuzz::Input& input, BodyModel& message) {
  fuzz::draw_some(input, message.residual, message.ground, message.ground_deviation, message.scale,
                  message.up[2], message.rotation[0], message.rotation[4], message.position[0],
                  message.stature);
  change_all(input, message.turns, message.shape, message.vertices, message.off, message.support,
             message.joints, message.bone_points, message.mesh_parts, message.pose_groups, message.bones,
             message.bone_point_names, message.parts);
  if (input.number(1) % 16 == 0) message.model += "x";
}

void change(fuzz::Input& input, FitState& message) {
  change_all(input, message.outer, message.inner, message.lines, message.regions);
  fuzz::draw_some(input, message.twist, message.side_lean);
  for (LineResult& line : message.lines) {
    fuzz::draw_some(input, line.initial, line.neutral, line.final, line.tension);
    change_all(input, line.course, line.course_at_rest, line.nodes);
  }
}

void change(fuzz::Input& input, DeformedMesh& message) {
  change_all(input, message.vertices, message.distortion);
  if (input.number(1) % 8 == 0) message.status = FitState::SOLVING;
}

void change(fuzz::Input& input, sensor_msgs::PointCloud2& message) {
  fuzz::draw_some(input, message.width, message.height, message.point_step, message.row_step,
                  message.header.stamp.sec);
  change_all(input, message.fields, message.data);
}

geometry::BodyMeasures measures() {
  geometry::BodyMeasures measures;
  measures.heights = {{"hip", 0.9, 1, ""}, {"underbust", 1.12, 1, ""}};
  measures.landmarks = {{"crotch", {0, 0, 0.8}, 1, ""}};
  measures.girths = {{"bust", 0.9, 1, ""}, {"underbust", 0.75, 1, ""}};
  return measures;
}

TriangleMesh body() {
  const geometry::ControlMesh bust = tensegric::bust_mesh();
  return to_message(ScanTag(), {bust.outer, bust.triangles}, {});
}

Garment band() {
  Garment garment;
  garment.name = "band";
  garment.regions = {"bust"};
  garment.lines.resize(1);
  garment.lines[0].name = "chest";
  garment.lines[0].ratio = 0.95;
  return garment;
}

const body_model::RegisteredBody& mean_woman() {
  static const body_model::RegisteredBody body = [] {
    body_model::RegisteredBody mean;
    mean.model = body_model::shipped_registrar().shared_model();
    mean.parameters = body_model::Parameters(*mean.model);
    const body_model::PosedModel posed(*mean.model, mean.parameters);
    mean.posed = mean.skin = posed.vertices();
    mean.off.assign(mean.skin.size(), 0);
    mean.support.assign(mean.skin.size(), 0);
    mean.residual = 0.003;  // m; 0, which no registration leaves, is refused
    mean.ground = geometry::bounding_box(mean.skin)[0].z();
    for (std::size_t b = 0; b < mean.model->bones.size(); ++b)
      mean.joints.push_back(posed.joint(static_cast<int>(b)));
    for (std::size_t i = 0; i < mean.model->bone_points.size(); ++i)
      mean.bone_points.push_back(posed.bone_point(static_cast<int>(i)));
    return mean;
  }();
  return body;
}

void read_mesh(fuzz::Input& input) {
  TriangleMesh message = body();
  change(input, message);
  const geometry::TriangleMesh mesh = mesh_in(message);
  fuzz::require(!mesh.vertices.empty());
  const std::vector<char> filled = filled_in(message);
  fuzz::require(filled.empty() || filled.size() == mesh.vertices.size());
  fractures_in(message);
}

void read_landmarks(fuzz::Input& input) {
  Landmarks message = to_message(ScanTag(), measures());
  change(input, message);
  const geometry::BodyMeasures read = measures_in(message);
  fuzz::require(read.body_from_scan.matrix().allFinite());
}

const BodyModel& sound_model() {
  static const BodyModel sound =
      to_message(ScanTag(), mean_woman(),
                 body_model::parts_of({mean_woman().skin, mean_woman().model->triangles}, mean_woman()));
  return sound;
}

void read_model(fuzz::Input& input) {
  BodyModel message = sound_model();
  change(input, message);
  check_mesh_parts(message, mean_woman().skin.size());
  const body_model::RegisteredBody read = registered_in(message, mean_woman().model);
  for (const Eigen::Vector3d& v : read.posed) fuzz::require(v.allFinite());
}

TensegricHandler tensegric_stage() {
  return TensegricHandler(Parameters(YAML::Load("{max_iterations: 3}"), "tensegric"), fit::bind_body);
}

const auto kSilent = [](const FitState&) {};
const auto kGoOn = [] { return true; };

/// What a fit's figures are where the stage let them out; and what viewers are sent of it.
void check_fit(const std::optional<TensegricHandler::Output>& output) {
  if (!output) return;
  for (const double x :
       to_message(tag_in(*output->fit), output->fit->garment, *output->model, output->solution).forces)
    fuzz::require(std::isfinite(x));
  bands_message(output->name, output->solution);
  for (const double x : output->fit->outer) fuzz::require(std::isfinite(x));
  for (const LineResult& line : output->fit->lines) fuzz::require(std::isfinite(line.tension));
}

void fit_garment(fuzz::Input& input) {
  TensegricHandler stage = tensegric_stage();
  const auto skin = boost::make_shared<TriangleMesh>(body());
  const auto control = boost::make_shared<ControlMesh>(to_message(ScanTag(), tensegric::bust_mesh()));
  if (input.number(1) % 2 != 0) change(input, *control);
  SetGarment::Request request;
  request.garment = band();
  change(input, request.garment);
  request.lines = {"chest"};
  request.ratios = {0.9};
  change_all(input, request.lines, request.ratios);
  if (input.number(1) % 2 != 0) {  // a first answer
    const auto coarse = boost::make_shared<ControlMesh>(to_message(ScanTag(), tensegric::bust_mesh()));
    change(input, *coarse);
    stage.add_coarse(coarse);
  }
  stage.add(TriangleMesh::ConstPtr(skin));
  stage.put_on(request);
  kept_garment(stage.kept(), "B1");
  if (const auto task = stage.add(ControlMesh::ConstPtr(control)))
    check_fit(stage.handle(*task, kGoOn, kSilent));
  if (const auto task = stage.reset()) check_fit(stage.handle(*task, kGoOn, kSilent));
}

/// The fit of the unchanged bust: what a changed message is made of.
const FitState& sound_fit() {
  static const FitState fit = [] {
    TensegricHandler stage = tensegric_stage();
    stage.put_on(band());
    stage.add(TriangleMesh::ConstPtr(boost::make_shared<TriangleMesh>(body())));
    const auto task = stage.add(ControlMesh::ConstPtr(
        boost::make_shared<ControlMesh>(to_message(ScanTag(), tensegric::bust_mesh()))));
    return *stage.handle(*task, kGoOn, kSilent)->fit;
  }();
  return fit;
}

void carry_skin(fuzz::Input& input) {
  TffdHandler stage(Parameters(YAML::Load("{}"), "tffd"));
  const auto skin = boost::make_shared<TriangleMesh>(body());
  const auto landmarks = boost::make_shared<Landmarks>(to_message(ScanTag(), measures()));
  const auto control = boost::make_shared<ControlMesh>(to_message(ScanTag(), tensegric::bust_mesh()));
  const auto fit = boost::make_shared<FitState>(sound_fit());
  change(input, *fit);
  if (input.number(1) % 4 == 0) change(input, *skin);
  if (input.number(1) % 4 == 0) change(input, *landmarks);
  if (input.number(1) % 4 == 0) change(input, *control);
  stage.add(TriangleMesh::ConstPtr(skin));
  stage.add(Landmarks::ConstPtr(landmarks));
  stage.add(ControlMesh::ConstPtr(control));
  const auto task = stage.add(FitState::ConstPtr(fit));
  if (!task) return;
  const TffdHandler::Output output = stage.handle(*task);
  for (const float x : output.scan.deformed->vertices) fuzz::require(std::isfinite(x));
  for (const float x : output.scan.deformed->distortion) fuzz::require(std::isfinite(x));
}

LineForces forces_of(const FitState& fit) {
  LineForces forces;
  for (const LineResult& line : fit.lines) {
    forces.lines.push_back(line.name);
    forces.tension.push_back(line.tension);
    forces.newtons.push_back(3);
    forces.kilopascals.push_back(0.5);
  }
  forces.garment = fit.garment;
  return forces;
}

/// What an export says in figures of a fit whose messages do not go together, or hold odd numbers.
void say_figures(fuzz::Input& input) {
  const auto skin = boost::make_shared<TriangleMesh>(body());
  const auto landmarks = boost::make_shared<Landmarks>(to_message(ScanTag(), measures()));
  const auto control = boost::make_shared<ControlMesh>(to_message(ScanTag(), tensegric::bust_mesh()));
  const auto fit = boost::make_shared<FitState>(sound_fit());
  const auto deformed = boost::make_shared<DeformedMesh>();
  const auto forces = boost::make_shared<LineForces>(forces_of(*fit));
  deformed->vertices = skin->vertices;
  deformed->distortion.assign(skin->vertices.size() / 3, 1);
  fuzz::draw_some(input, deformed->volume_before, deformed->volume_after);
  change(input, *deformed);
  change_all(input, forces->lines, forces->tension, forces->newtons, forces->kilopascals);
  if (input.number(1) % 4 == 0) change(input, *skin);
  if (input.number(1) % 2 == 0) change(input, *landmarks);
  if (input.number(1) % 4 == 0) change(input, *control);
  if (input.number(1) % 2 == 0) change(input, *fit);
  ScanLabels labels;
  for (const char* id : {"", "another"}) {
    ScanLabel label;
    label.scan_id = id;
    label.customer.assign(input.number(1) % 4, static_cast<char>(input.number(1)));
    labels.add(label);
  }
  if (input.number(1) % 4 == 0) labels.drop("another");
  const FitFigures figures = figures_of({skin, landmarks, control, fit, deformed, {}, forces, labels.of("")});
  fuzz::require(scan_id_in(fit_json(figures, {"body.ply"})) == skin->scan_id);
  fuzz::require(!measurements_csv(figures).empty());
}

/// A mesh that comes with its model, or whose model fits nothing of it.
void find_landmarks(fuzz::Input& input) {
  static const LandmarksHandler fresh(Parameters(YAML::Load("{}"), "landmarks"));
  LandmarksHandler stage = fresh;
  const auto mesh = boost::make_shared<TriangleMesh>(
      to_message(ScanTag(), {mean_woman().skin, mean_woman().model->triangles}, {}));
  const auto model = boost::make_shared<BodyModel>(sound_model());
  change(input, *mesh);
  change(input, *model);
  stage.add(BodyModel::ConstPtr(model));
  const auto task = stage.add(TriangleMesh::ConstPtr(mesh));
  if (!task) return;
  const LandmarksHandler::Output output = stage.handle(*task);
  for (const Landmark& point : output.landmarks->points)
    for (const double x : point.position) fuzz::require(std::isfinite(x));
}

void lay_control(fuzz::Input& input) {
  static const ControlMeshHandler fresh(Parameters(YAML::Load("{}"), "control_mesh"));
  ControlMeshHandler stage = fresh;
  const auto mesh = boost::make_shared<TriangleMesh>(body());
  const auto landmarks = boost::make_shared<Landmarks>(to_message(ScanTag(), measures()));
  const auto model = boost::make_shared<BodyModel>(sound_model());
  change(input, *mesh);
  change(input, *landmarks);
  change(input, *model);
  stage.add(BodyModel::ConstPtr(model));
  stage.add(TriangleMesh::ConstPtr(mesh));
  const auto task = stage.add(Landmarks::ConstPtr(landmarks));
  if (!task) return;
  for (const float x : stage.handle(*task).control->outer) fuzz::require(std::isfinite(x));
}

/// The bust as a second scan of itself; how a scan is measured is not this stage's.
MeasuredScan measured_worn(const geometry::PointCloud& cloud) {
  if (cloud.points.empty()) throw geometry::Refusal(geometry::refusal::kEmptyCloud, "no points");
  const geometry::ControlMesh bust = tensegric::bust_mesh();
  return {{bust.outer, bust.triangles}, std::vector<char>(bust.outer.size(), 0), measures()};
}

void correlate_worn(fuzz::Input& input) {
  CorrelationHandler stage(Parameters(YAML::Load("{}"), "correlation"), measured_worn);
  const auto mesh = boost::make_shared<TriangleMesh>(body());
  const auto landmarks = boost::make_shared<Landmarks>(to_message(ScanTag(), measures()));
  const auto control = boost::make_shared<ControlMesh>(to_message(ScanTag(), tensegric::bust_mesh()));
  const auto deformed = boost::make_shared<DeformedMesh>();
  const auto worn = boost::make_shared<sensor_msgs::PointCloud2>(xyz_cloud(1));
  mesh->scan_id = landmarks->scan_id = control->scan_id = deformed->scan_id = "bare";
  deformed->vertices = mesh->vertices;
  deformed->distortion.assign(mesh->vertices.size() / 3, 1);
  change(input, *deformed);
  change(input, *worn);
  if (input.number(1) % 4 == 0) change(input, *mesh);
  if (input.number(1) % 4 == 0) change(input, *landmarks);
  if (input.number(1) % 4 == 0) change(input, *control);
  if (input.number(1) % 8 == 0)
    stage.add(sensor_msgs::PointCloud2::ConstPtr(worn), tag_of(*worn));  // too early
  stage.add(TriangleMesh::ConstPtr(mesh));
  stage.add(Landmarks::ConstPtr(landmarks));
  stage.add(ControlMesh::ConstPtr(control));
  stage.add(DeformedMesh::ConstPtr(deformed));
  const auto task = stage.add(sensor_msgs::PointCloud2::ConstPtr(worn), tag_of(*worn));
  if (!task) return;
  const CorrelationHandler::Output output = stage.handle(*task);
  for (const float x : output.correlation->distance) fuzz::require(std::isfinite(x));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const auto read =
      std::array{read_mesh,      read_landmarks, read_model,     fit_garment, carry_skin,
                 find_landmarks, lay_control,    correlate_worn, say_figures}[input.number(1) % 9];
  fuzz::refused_or_done([&] { read(input); });
  return 0;
}
