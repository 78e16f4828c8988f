#include "rviz/fit_client.hpp"

#include <std_srvs/Trigger.h>
#include <tensegric_fit/ExportFit.h>

#include <condition_variable>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "inspect/panel_words.hpp"
#include "ros/held_scan.hpp"

namespace tensegric_fit::inspect {

namespace {

constexpr char kGarmentCall[] = "garment", kExportCall[] = "export";

ros::Publisher advertise_labels(ros::NodeHandle& node) {
  return node.advertise<ScanLabel>("scan/label", 4, true);
}

}  // namespace

/// What the thread that calls works with. It has a share of it, as it may outlive the client.
struct FitClient::Calls {
  using Answer = std::function<void(bool, const std::string&)>;

  Calls(ros::NodeHandle node, FitClient* asker)
      : wear(node.serviceClient<SetGarment>("set_garment")),
        reset(node.serviceClient<std_srvs::Trigger>("reset")),
        export_fit(node.serviceClient<ExportFit>("export_fit")),
        client(asker) {}

  void serve(const std::string& kind);
  void report(Answer FitClient::*answer, bool done, const std::string& words);

  ros::ServiceClient wear, reset, export_fit;
  std::mutex mutex;  // guards the rest
  std::condition_variable wake;
  std::map<std::string, Call> waiting;  // one of each kind: the newest
  std::set<std::string> calling;        // kinds that are on their way
  FitClient* client;                    // null: it is gone, and there is nothing more to call
};

void FitClient::Calls::serve(const std::string& kind) {
  while (true) {
    Call call;
    {
      std::unique_lock<std::mutex> lock(mutex);
      wake.wait(lock, [&] { return client == nullptr || waiting.count(kind) != 0; });
      if (client == nullptr) return;
      calling.insert(kind);
      call = std::move(waiting.extract(kind).mapped());
    }
    call(*this);
    std::lock_guard<std::mutex> lock(mutex);
    calling.erase(kind);
  }
}

void FitClient::Calls::report(Answer FitClient::*answer, bool done, const std::string& words) {
  std::lock_guard<std::mutex> lock(mutex);
  if (client == nullptr) return;
  QMetaObject::invokeMethod(
      client, [client = client, answer, done, words] { (client->*answer)(done, words); },
      Qt::QueuedConnection);
}

template <typename Message>
void FitClient::listen(const char* topic, std::function<void(const Message&)> FitClient::*callback) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> on_message =
      [this, callback](const boost::shared_ptr<const Message>& message) {
        if (!node::is_of_forgotten(message)) (this->*callback)(*message);
      };
  subscribers_.push_back(
      node_.subscribe<Message>(topic, 4, on_message, {}, ros::TransportHints().tcpNoDelay()));
}

FitClient::FitClient() : labels_(advertise_labels(node_)), calls_(std::make_shared<Calls>(node_, this)) {
  listen("garment", &FitClient::on_garment);
  listen("control/deformed", &FitClient::on_fit);
  listen("control/forces", &FitClient::on_forces);
  listen("body/deformed", &FitClient::on_deformed);
  listen("body/warnings", &FitClient::on_warnings);
  listen("body/mesh", &FitClient::on_body);
  listen("body/landmarks", &FitClient::on_landmarks);
  listen("control/mesh", &FitClient::on_control);
  listen("scan/label", &FitClient::on_label);
  const boost::function<void(const diagnostic_msgs::DiagnosticArray::ConstPtr&)> diagnostics =
      [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& array) {
        for (const auto& status : array->status) on_diagnostics(status);
      };
  subscribers_.push_back(node_.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 50, diagnostics));
  for (const char* kind : {kGarmentCall, kExportCall})
    workers_.emplace(kind, std::thread([calls = calls_, kind] { calls->serve(kind); }));
}

FitClient::~FitClient() {
  std::set<std::string> calling;
  {
    std::lock_guard<std::mutex> lock(calls_->mutex);
    calls_->client = nullptr;
    calling = calls_->calling;
  }
  calls_->wake.notify_all();
  for (auto& [kind, worker] : workers_)
    if (calling.count(kind) != 0)
      worker.detach();  // roscpp has no way to end a call
    else
      worker.join();
}

void FitClient::post(const std::string& kind, Call call) {
  {
    std::lock_guard<std::mutex> lock(calls_->mutex);
    calls_->waiting[kind] = std::move(call);
  }
  calls_->wake.notify_all();
}

bool FitClient::is_asking() {
  std::lock_guard<std::mutex> lock(calls_->mutex);
  return calls_->calling.count(kGarmentCall) != 0 || calls_->waiting.count(kGarmentCall) != 0;
}

void FitClient::wear(const SetGarment::Request& request) {
  post(kGarmentCall, [request](Calls& calls) {
    SetGarment call;
    call.request = request;
    if (!calls.wear.exists() || !calls.wear.call(call))
      return calls.report(&FitClient::on_worn, false, words::kPipelineNotRunning);
    calls.report(&FitClient::on_worn, call.response.accepted, call.response.message);
  });
}

void FitClient::label(const ScanLabel& label) {
  labels_.publish(label);
  labelled_ = label.scan_id;
}

void FitClient::forget_label(const std::string& scan_id) {
  if (labelled_ != scan_id) return;
  labels_.shutdown();  // else whoever comes, as nodes that let go of the scan do, is given it again
  labels_ = advertise_labels(node_);
  labelled_.clear();
}

void FitClient::reset() {
  post(kGarmentCall, [](Calls& calls) {
    std_srvs::Trigger call;
    if (!calls.reset.exists() || !calls.reset.call(call))
      return calls.report(&FitClient::on_worn, false, words::kPipelineNotRunning);
    calls.report(&FitClient::on_worn, call.response.success, call.response.message);
  });
}

void FitClient::export_to(const std::string& folder, const std::string& scan_id) {
  post(kExportCall, [folder, scan_id](Calls& calls) {
    ExportFit call;
    call.request.directory = folder;
    call.request.scan_id = scan_id;
    if (!calls.export_fit.exists() || !calls.export_fit.call(call))
      return calls.report(&FitClient::on_exported, false, words::kPipelineNotRunning);
    calls.report(&FitClient::on_exported, call.response.exported,
                 call.response.exported
                     ? words::exported(static_cast<int>(call.response.files.size()), folder)
                     : call.response.message);
  });
}

}  // namespace tensegric_fit::inspect
