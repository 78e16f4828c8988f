#include "batch/worker.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <new>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>

#include "fit/compute.hpp"

namespace tensegric_fit::batch {
namespace {

using Json = nlohmann::ordered_json;

double cpu_seconds() {
  double sum = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {  // the surface is made in a process of its own
    rusage usage{};
    getrusage(who, &usage);
    for (const timeval& time : {usage.ru_utime, usage.ru_stime})
      sum += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  }
  return sum;
}

void reset_peak_memory() {
  std::ofstream("/proc/self/clear_refs") << "5";
}

/// MB, of this process since the last reset.
double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) / 1024;
  return 0;
}

Json reason(const std::string& code, const std::string& message) {
  return {{"code", code}, {"message", message}};
}

Json out_of_memory() {
  return {{"status", "out_of_memory"}, {"reason", reason("out_of_memory", "needs more than --memory")}};
}

/// The report without what differs from run to run, which goes to `cost`.
Json figures_of(Json report, Json& cost) {
  report.erase("status");
  report.erase("reason");
  for (const char* key : {"file", "more_files"}) report["scan"].erase(key);
  if (report.contains("stages")) {
    for (const auto& [stage, times] : report["stages"].items()) cost["stages"][stage] = times["ms"];
    report.erase("stages");
  }
  if (report.contains("solver")) report["solver"].erase("ms");
  if (report.contains("distortion"))
    for (const char* key : {"over_constricted", "over_stretched", "under_constricted"})
      report["distortion"][key] = report["distortion"][key].size();
  return report;
}

Json fitted(const std::vector<std::string>& arguments, Json& cost) {
  fit::CommandLine line;
  std::ostringstream errors;
  if (fit::parse(arguments, line, errors))
    return {{"status", "failed"}, {"reason", reason("usage", errors.str())}};
  fit::Computed computed;
  try {
    fit::compute(line, computed);
    Json figures = figures_of(computed.report(), cost);
    return {{"status", "ok"}, {"reason", nullptr}, {"result", std::move(figures)}};
  } catch (const geometry::Refusal& refusal) {
    return {{"status", "refused"}, {"reason", reason(refusal.code(), refusal.what())}};
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  } catch (const std::system_error& error) {  // a thread that has no room for its stack
    if (error.code() == std::errc::resource_unavailable_try_again) return out_of_memory();
    return {{"status", "failed"}, {"reason", reason("error", error.what())}};
  } catch (const std::exception& error) {
    return {{"status", "failed"}, {"reason", reason("error", error.what())}};
  }
}

Json answer(const std::string& request) {
  const Json asked = Json::parse(request);
  reset_peak_memory();
  const double cpu = cpu_seconds();
  const auto start = std::chrono::steady_clock::now();
  Json cost = Json::object();
  Json line = fitted(asked.at("arguments").get<std::vector<std::string>>(), cost);
  cost["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  cost["cpu_seconds"] = cpu_seconds() - cpu;
  cost["peak_MB"] = peak_memory();
  line["cost"] = std::move(cost);
  return line;
}

}  // namespace

int work(std::size_t bytes) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody else would end a job that hangs
  // What libraries print goes nowhere: standard output carries answers.
  std::FILE* answers = fdopen(fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1), "w");
  if (answers == nullptr || std::freopen("/dev/null", "w", stdout) == nullptr) return 1;
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_AS, &limit);
#else
  static_cast<void>(bytes);
#endif
  for (std::string request; std::getline(std::cin, request);) {
    const Json line = answer(request);
    const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    if (std::fputs(text.c_str(), answers) < 0 || std::fflush(answers) != 0) return 1;
    if (line["status"] == "out_of_memory") return 0;  // what is left of the heap is not to be trusted
  }
  return 0;
}

}  // namespace tensegric_fit::batch
