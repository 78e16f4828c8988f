// What was written before and is read again: reports, documents of exports, results of batches. The first
// byte chooses which, the rest is the text.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "batch/batch_page.hpp"
#include "batch/database.hpp"
#include "batch/drift.hpp"
#include "batch/table.hpp"
#include "fit/history.hpp"
#include "fuzz_target.hpp"
#include "ros/fit_document.hpp"

namespace {

namespace fs = std::filesystem;
using namespace tensegric_fit;

/// In memory; empty at first, gone with this.
class InputFolder {
 public:
  InputFolder() : path_("/dev/shm/tensegric_fit_fuzz_" + std::to_string(getpid())) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~InputFolder() { fs::remove_all(path_); }
  InputFolder(const InputFolder&) = delete;
  InputFolder& operator=(const InputFolder&) = delete;

  std::string add(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return (path_ / name).string();
  }
  std::string path() const { return path_.string(); }

 private:
  const fs::path path_;
};

void read_visits(const char* document, const std::string& text) {
  const InputFolder folder;
  folder.add(document, text);
  const std::vector<fit::Visit> visits = fit::find_visits({folder.path()}, "");
  fuzz::require(visits.size() < 2);
  if (visits.empty()) return;
  fuzz::require(!fit::customers_text(visits).empty());
  for (const fit::VisitChange& change : fit::changes(visits[0], visits[0]))
    fuzz::require(!change.beyond_doubt());
  fuzz::require(!fit::visits_text({visits[0], visits[0]}, 0, 1).empty());
}

void read_report(const std::string& text) {
  read_visits(fit::kFitReport, text);
}

void read_export(const std::string& text) {
  read_visits(fit::kExportDocument, text);
  if (const std::optional<std::string> scan_id = node::scan_id_in(text))
    fuzz::require(node::scan_id_in(node::sealed_json(*scan_id)) == scan_id);
}

/// The first line describes the batch, the others are results of its rows.
void read_batch(const std::string& text) {
  const InputFolder folder;
  const std::size_t end = std::min(text.find('\n'), text.size());
  folder.add("batch.json", text.substr(0, end));
  folder.add("shard-1-of-1.jsonl", text.substr(std::min(end + 1, text.size())));
  const batch::Table table = batch::read_table({folder.path()});
  fuzz::require(table.lines.size() + table.missing.size() == table.rows);
  if (table.rows > 1000) return;  // missing ones take the time
  const std::string before = folder.add("before.csv", batch::table_csv(table));
  const batch::Comparison same = batch::compare(table, before);
  batch::costs_csv(table);
  batch::write_database(table, (fs::path(folder.path()) / "table.sqlite").string());
  batch::batch_page(table, same, {});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  constexpr std::array kKinds{read_report, read_export, read_batch};
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  fuzz::refused_or_done([&] { kKinds[data[0] % kKinds.size()](text); });
  return 0;
}
