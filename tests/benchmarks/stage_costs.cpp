#include "stage_costs.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdint>
#include <ctime>
#include <functional>
#include <optional>

#include "customer.hpp"
#include "fit/chain.hpp"
#include "peak_memory.hpp"
#include "surface_distance.hpp"
#include "tffd/distortion.hpp"

namespace tensegric_fit::benchmarks {
namespace {

constexpr int kPoints = 90000;
constexpr int kQuick = 20;  // runs of a stage of milliseconds, so that a clock tick is no matter

// Of the processor, all threads: what else the machine does is no matter.
template <typename Work>
double milliseconds_of(const Work& work) {
  const std::clock_t start = std::clock();
  work();
  return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// Dense arithmetic and scattered memory, as the stages have both. Some 50 ms.
double kernel_milliseconds() {
  return milliseconds_of([] {
    std::vector<double> numbers(400000);
    std::uint64_t state = 1;
    for (double& number : numbers) {
      state = 6364136223846793005u * state + 1442695040888963407u;
      number = static_cast<double>(state >> 11);
    }
    std::sort(numbers.begin(), numbers.end());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Map(numbers.data(), 400, 400) / numbers.back();
    matrix = (matrix * matrix.transpose()).eval() + Eigen::MatrixXd::Identity(400, 400);
    const volatile double keep = matrix.llt().matrixL().solve(Eigen::VectorXd::Ones(400).eval()).sum();
    (void)keep;
  });
}

struct Readings {
  std::string stage;
  std::vector<double> kernels, milliseconds, mebibytes;
};

class Rounds {
 public:
  // The stages' core calls as fit::measure_scan, prepare and wear make them, one by one.
  void run() {
    next_ = 0;
    const geometry::PointCloud& seen = scan(kPoints);
    std::optional<reconstruction::Reconstruction> made;
    geometry::BodyMeasures measures;
    geometry::ControlMesh control;
    tensegric::Solution worn;
    const body_model::Registrar& registrar = body_model::shipped_registrar();
    measure("reconstruction", 1, [&] {  // with the registration
      made = reconstruction::reconstruct(seen, {}, {std::cref(registrar), registrar.standing()});
    });
    const reconstruction::BodyMesh& body = made->body;
    measure("body_model", 1, [&] { body_model::register_mesh(registrar, body.mesh); });
    measure("landmarks", 1, [&] {
      measures =
          landmarks::find_landmarks(body.mesh, body.filled, made->model, landmarks::shipped_precision());
    });
    const auto pattern = control_mesh::load_template(kLaunch + "/templates/bust.yaml");
    measure("control_mesh", 1,
            [&] { control = control_mesh::fit_template(pattern, body.mesh, measures, {}, &made->model); });
    std::optional<tensegric::Model> model;
    measure("tensegric", kQuick, [&] {
      model = tensegric::build_model(control, {});
      worn = tensegric::solve(*model, chest_line(0.94), {});
    });
    std::optional<tffd::Binding> binding;
    std::vector<Eigen::Vector3d> deformed;
    measure("tffd", kQuick, [&] {
      binding.emplace(body.mesh, control, tffd::Options());
      deformed = binding->deform(worn.outer, worn.inner);
    });
    measure("garment_change", kQuick, [&] {
      const tensegric::Solution tighter = tensegric::solve(*model, chest_line(0.93), {}, &worn);
      deformed = binding->deform(tighter.outer, tighter.inner);
      tffd::body_distortion(*binding, tffd::control_distortion(*binding, tighter.outer));
    });
  }

  std::vector<StageCost> costs() const {
    std::vector<StageCost> costs;
    for (const Readings& all : readings_) {
      const auto [least, most] = std::minmax_element(all.kernels.begin(), all.kernels.end());
      costs.push_back({all.stage, gauge::quantile(all.kernels, 0.5), *most / *least,
                       gauge::quantile(all.milliseconds, 0.5), gauge::quantile(all.mebibytes, 0.5)});
    }
    return costs;
  }

 private:
  template <typename Work>
  void measure(const std::string& stage, int runs, const Work& work) {
    if (next_ == readings_.size()) readings_.push_back({stage, {}, {}, {}});
    Readings& readings = readings_[next_++];
    const double kernel = kernel_milliseconds();
    const gauge::Growth growth;
    const double taken = milliseconds_of([&] {
                           for (int i = 0; i < runs; ++i) work();
                         }) /
                         runs;
    readings.mebibytes.push_back(growth.mebibytes());
    readings.milliseconds.push_back(taken);
    readings.kernels.push_back(taken / kernel);
  }

  std::vector<Readings> readings_;
  std::size_t next_ = 0;
};

}  // namespace

std::vector<StageCost> stage_costs(int rounds) {
  Rounds all;
  for (int i = 0; i < rounds; ++i) all.run();
  return all.costs();
}

}  // namespace tensegric_fit::benchmarks
