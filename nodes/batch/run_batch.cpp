#include "batch/run_batch.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "batch/identity.hpp"
#include "batch/manifest.hpp"
#include "batch/shard_file.hpp"
#include "files/descriptor.hpp"
#include "files/whole_folder.hpp"
#include "fit/result_folder.hpp"
#include "geometry/json_text.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::batch {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPatience(200);  // how late an interruption may be seen
constexpr double kTerminal = 1, kLog = 60;           // seconds between words of progress

volatile std::sig_atomic_t interrupted = 0;

class Progress {
 public:
  Progress(std::size_t all, bool quiet)
      : all_(all),
        quiet_(quiet),
        terminal_(isatty(STDERR_FILENO) != 0),
        start_(Clock::now()),
        said_(start_) {}

  void add(const std::string& status, bool computed) {
    ++by_status_[status];
    ++done_;
    computed_ += computed ? 1 : 0;
    say(false);
  }

  void say(bool now) {
    const auto since = std::chrono::duration<double>(Clock::now() - said_).count();
    if (quiet_ || (!now && since < (terminal_ ? kTerminal : kLog))) return;
    said_ = Clock::now();
    std::string text = fmt::format("{} of {}", done_, all_);
    for (const auto& [status, count] : by_status_) text += fmt::format(", {} {}", count, status);
    const double seconds = std::chrono::duration<double>(said_ - start_).count();
    if (const double rate = static_cast<double>(computed_) / seconds; rate > 0)
      text +=
          fmt::format("; {:.2f} per s, {:.1f} min left", rate, static_cast<double>(all_ - done_) / rate / 60);
    fmt::print(stderr, terminal_ ? "\r\033[K{}{}" : "{}{}", text, terminal_ && !now ? "" : "\n");
  }

 private:
  std::size_t all_, done_ = 0, computed_ = 0;
  bool quiet_, terminal_;
  Clock::time_point start_, said_;
  std::map<std::string, std::size_t> by_status_;
};

class Batch {
 public:
  explicit Batch(const BatchOptions& options)
      : options_(options),
        jobs_(read_manifest(options.manifest)),
        manifest_(manifest_identity(jobs_, options.manifest)),
        file_(options.out, shard_name(options.shard, options.shards)),
        pool_(options.workers, options.limits) {
    write_description();
    read_done();
  }

  int operator()() {
    std::vector<const Job*> mine;
    for (const Job& job : jobs_)
      if ((job.row - 1) % options_.shards == options_.shard - 1) mine.push_back(&job);
    Progress progress(mine.size(), options_.quiet);
    for (auto next = mine.begin(); (next != mine.end() || pool_.is_busy()) && interrupted == 0;) {
      if (next != mine.end() && pool_.has_idle()) {
        begin(**next++, progress);
        continue;
      }
      for (const Finished& finished : pool_.wait(kPatience)) keep(finished, progress);
    }
    progress.say(true);
    return interrupted == 0 && !lacks_rows_ ? 0 : 130;
  }

 private:
  using LastLine = std::tuple<std::string, std::string, std::string>;  // key, manifest, build

  /// For the merge: how many rows there will be, and which lines count. Shards of one folder begin at once.
  void write_description() const {
    const Json description{{"rows", jobs_.size()},
                           {"manifest", std::filesystem::path(options_.manifest).filename()},
                           {"manifest_identity", manifest_},
                           {"version", TENSEGRIC_FIT_VERSION},
                           {"build", build_identity()}};
    const files::Descriptor folder(std::filesystem::canonical(options_.out),  // it may be a link
                                   O_RDONLY | O_DIRECTORY);
    while (flock(folder.number(), LOCK_EX) != 0)
      if (errno != EINTR) files::fail(options_.out);
    const std::filesystem::path file = std::filesystem::path(options_.out) / "batch.json";
    const std::string before = files::bytes_of_plain_file(file.string(), 1 << 20).value_or("");
    const Json known = geometry::json_in<Json>(before);  // discarded where there is none: equal to nothing
    if (!(known == description)) fit::write_json(file, description);
  }

  void read_done() {
    for_each_line(file_.path(), [this](const Json& line, std::size_t place) {
      const std::string key = line.at("key");
      const std::size_t row = line.at("row");
      if (options_.retry && is_unfinished(line)) {
        rows_.erase(row);
        done_.erase(key);
        return;
      }
      rows_[row] = LastLine{key, line.value("manifest", ""), line.value("build", "")};
      if (!key.empty()) done_[key] = {line.at("status"), place, is_settled(line)};
    });
  }

  void begin(const Job& job, Progress& progress) {
    Identity identity;
    try {
      identity = identity_of(job, build_identity());
    } catch (const geometry::Refusal& refusal) {  // without a key: the file may be there the next time
      if (const Done* done = settled(job.row)) {  // its scan was moved once the result was there
        progress.add(done->status, false);
        return;
      }
      const Json reason{{"code", refusal.code()}, {"message", refusal.what()}};
      if (note_line(job, "")) file_.add(with_head(job, {}, {{"status", "refused"}, {"reason", reason}}));
      progress.add("refused", false);
      return;
    }
    const auto found = done_.find(identity.key);
    if (found != done_.end() && rows_[job.row] == last_line(identity.key)) {
      progress.add(found->second.status, false);
      return;
    }
    // The row itself from another manifest, or the same scan and settings in another row. A refusal names its
    // file, and is found again.
    if (found != done_.end() && found->second.status != "refused") {
      note_line(job, identity.key);
      Json line = file_.line_at(found->second.place);
      line.erase("cost");  // it took nothing
      file_.add(with_head(job, identity, line));
      progress.add(found->second.status, false);
      return;
    }
    for (const auto& [row, work] : begun_)
      if (work.identity.key == identity.key) {  // the same in another row: it waits for that one
        begun_[row].also.push_back(&job);
        return;
      }
    begun_[job.row] = {&job, identity, {}};
    pool_.give(job.row, job.arguments());
  }

  void keep(const Finished& finished, Progress& progress) {
    const Work work = begun_.at(finished.job);
    begun_.erase(finished.job);
    if (finished.line.is_null()) {
      lacks_rows_ = true;  // left to the next start
      return;
    }
    const std::string status = finished.line.at("status");
    note_line(*work.job, work.identity.key);
    const Json line = with_head(*work.job, work.identity, finished.line);
    done_[work.identity.key] = {status, file_.add(line), is_settled(line)};
    progress.add(status, true);
    for (const Job* job : work.also) begin(*job, progress);
  }

  /// The row's last line, which the merge takes, is of this key, manifest and build from now on. Whether it
  /// was not.
  bool note_line(const Job& job, const std::string& key) {
    const LastLine last = last_line(key);
    return std::exchange(rows_[job.row], last) != last;
  }

  struct Done {
    std::string status;
    std::size_t place;
    bool settled;
  };

  /// What the row has of this manifest and build; null: nothing, or nothing that stays.
  const Done* settled(std::size_t row) const {
    const auto last = rows_.find(row);
    if (last == rows_.end() || last->second != last_line(std::get<0>(last->second))) return nullptr;
    const auto done = done_.find(std::get<0>(last->second));
    return done != done_.end() && done->second.settled ? &done->second : nullptr;
  }

  LastLine last_line(const std::string& key) const { return {key, manifest_, build_identity()}; }

  /// Whose line it is, before what became of it.
  Json with_head(const Job& job, const Identity& identity, const Json& line) const {
    Json settings = Json::object();
    for (const auto& [name, values] : job.options)
      if (name != "scan" && name != "mesh") settings[name] = values;
    Json whole{{"row", job.row},
               {"name", job.name},
               {"key", identity.key},
               {"subject", identity.subject},
               {"kind", job.options.count("mesh") > 0 ? "mesh" : "scan"},
               {"inputs", job.inputs()},
               {"settings", std::move(settings)},
               {"manifest", manifest_},
               {"version", TENSEGRIC_FIT_VERSION},
               {"build", build_identity()}};
    for (const char* part : {"status", "reason", "result", "cost"})
      if (line.contains(part)) whole[part] = line.at(part);
    return whole;
  }

  const BatchOptions& options_;
  std::vector<Job> jobs_;
  const std::string manifest_;  // identity
  ShardFile file_;
  WorkerPool pool_;
  std::unordered_map<std::string, Done> done_;  // by key
  std::map<std::size_t, LastLine> rows_;
  struct Work {
    const Job* job;
    Identity identity;
    std::vector<const Job*> also;  // rows of the same key
  };
  std::map<std::size_t, Work> begun_;  // by row
  bool lacks_rows_ = false;            // whose workers were interrupted
};

}  // namespace

std::string shard_name(std::size_t shard, std::size_t shards) {
  return fmt::format("shard-{}-of-{}.jsonl", shard, shards);
}

int run_batch(const BatchOptions& options) {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { interrupted = 1; });
  try {
    return Batch(options)();
  } catch (const geometry::Refusal& refusal) {
    fmt::print(stderr, "refused: {}: {}\n", refusal.code(), refusal.what());
    return refusal.code() == geometry::refusal::kCannotWrite ? 1 : 3;
  } catch (const std::exception& error) {
    fmt::print(stderr, "fit_batch: {}\n", error.what());
    return 1;
  }
}

}  // namespace tensegric_fit::batch
