#include "rviz/fit_client.hpp"

#include <std_srvs/Trigger.h>
#include <tensegric_fit/ExportFit.h>

#include <utility>

#include "inspect/panel_words.hpp"

namespace tensegric_fit::inspect {

namespace {

constexpr char kGarmentCall[] = "garment", kExportCall[] = "export";

}  // namespace

template <typename Message>
void FitClient::listen(const char* topic, std::function<void(const Message&)> FitClient::*callback) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> on_message =
      [this, callback](const boost::shared_ptr<const Message>& message) { (this->*callback)(*message); };
  subscribers_.push_back(
      node_.subscribe<Message>(topic, 4, on_message, {}, ros::TransportHints().tcpNoDelay()));
}

FitClient::FitClient()
    : labels_(node_.advertise<ScanLabel>("scan/label", 4, true)),
      wear_(node_.serviceClient<SetGarment>("set_garment")),
      reset_(node_.serviceClient<std_srvs::Trigger>("reset")),
      export_(node_.serviceClient<ExportFit>("export_fit")) {
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
  worker_ = std::thread([this] { serve(); });
}

FitClient::~FitClient() {
  {
    std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  for (ros::ServiceClient* client : {&wear_, &reset_, &export_}) client->shutdown();  // ends a call under way
  worker_.join();
}

void FitClient::serve() {
  while (true) {
    std::function<void()> call;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      wake_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
      if (stopping_) return;
      calling_ = waiting_.begin()->first;
      call = std::move(waiting_.begin()->second);
      waiting_.erase(waiting_.begin());
    }
    call();
    std::lock_guard<std::mutex> lock(mutex_);
    calling_.clear();
  }
}

void FitClient::post(const std::string& kind, std::function<void()> call) {
  {
    std::lock_guard<std::mutex> lock(mutex_);
    waiting_[kind] = std::move(call);
  }
  wake_.notify_one();
}

bool FitClient::is_asking() {
  std::lock_guard<std::mutex> lock(mutex_);
  return calling_ == kGarmentCall || waiting_.count(kGarmentCall) != 0;
}

void FitClient::report(const Answer& answer, bool done, const std::string& words) {
  QMetaObject::invokeMethod(
      this, [answer, done, words] { answer(done, words); }, Qt::QueuedConnection);
}

void FitClient::wear(const SetGarment::Request& request) {
  post(kGarmentCall, [this, request] {
    SetGarment call;
    call.request = request;
    if (!wear_.exists() || !wear_.call(call)) return report(on_worn, false, words::kPipelineNotRunning);
    report(on_worn, call.response.accepted, call.response.message);
  });
}

void FitClient::label(const ScanLabel& label) {
  labels_.publish(label);
}

void FitClient::reset() {
  post(kGarmentCall, [this] {
    std_srvs::Trigger call;
    if (!reset_.exists() || !reset_.call(call)) return report(on_worn, false, words::kPipelineNotRunning);
    report(on_worn, call.response.success, call.response.message);
  });
}

void FitClient::export_to(const std::string& folder, const std::string& scan_id) {
  post(kExportCall, [this, folder, scan_id] {
    ExportFit call;
    call.request.directory = folder;
    call.request.scan_id = scan_id;
    if (!export_.exists() || !export_.call(call))
      return report(on_exported, false, words::kPipelineNotRunning);
    report(on_exported, call.response.exported,
           call.response.exported ? words::exported(static_cast<int>(call.response.files.size()), folder)
                                  : call.response.message);
  });
}

}  // namespace tensegric_fit::inspect
