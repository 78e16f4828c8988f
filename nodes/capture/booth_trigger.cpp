#include "capture/booth_trigger.hpp"

#include <std_srvs/Trigger.h>

#include <chrono>

namespace tensegric_fit::node {

bool BoothTrigger::pull() {
  if (call_.valid()) return false;
  call_ = std::async(
      std::launch::async,
      [client = node_.serviceClient<std_srvs::Trigger>(service_)]() mutable -> std::string {
        std_srvs::Trigger trigger;
        if (!client.call(trigger)) return client.getService() + " did not answer";
        return trigger.response.success ? "" : client.getService() + ": " + trigger.response.message;
      });
  return true;
}

std::string BoothTrigger::complaint() {
  if (!call_.valid() || call_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return "";
  return call_.get();
}

}  // namespace tensegric_fit::node
