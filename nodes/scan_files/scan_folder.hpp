/// A folder into which a booth writes its scans.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace tensegric_fit::scan_files {

/// Finds new files (not those whose name begins with a dot; whether they are scans is_scan_name says) once
/// they are complete: when neither size nor time of change have moved for a while. A file that is written
/// again is a new one; one that was away with all others, as on a share, is not: names are kept for as long
/// as the folder is empty. For one thread.
class ScanFolder {
 public:
  /// `settle`: seconds for which a complete file has been still.
  ScanFolder(std::string path, double settle) : path_(std::move(path)), settle_(settle) {}

  /// Paths of those that became complete, in the order in which they were written; each once. `now` is in
  /// seconds of any steady clock. \throw Refusal broken_file: the folder cannot be read now
  std::vector<std::string> poll(double now);

  /// Leaves out what lies there now. \throw Refusal as poll()
  void skip_all();

  /// Lets go of the name of a file that was deleted.
  void drop(const std::string& name) { files_.erase(name); }

  /// Texts, printable ASCII whatever the names are, that stand for the files returned so far, but for those
  /// that were deleted since and those named; and, for one that goes on where another ended, to leave those
  /// out. Other texts are passed over.
  std::vector<std::string> played(const std::set<std::string>& but = {}) const;
  void skip(const std::vector<std::string>& played);

  /// The text of one file that was returned, of no version where it is gone; and the name in such a text.
  std::string text(const std::string& name) const;
  static std::string name_in(const std::string& text);

 private:
  struct Version {
    std::int64_t changed;  // ns, of the file system's clock
    std::uintmax_t size;
    bool operator==(const Version& other) const { return changed == other.changed && size == other.size; }
  };
  struct File {
    Version version;
    double since;  // when it was first seen so
    bool played;
  };
  std::map<std::string, Version> look() const;
  static std::string text_of(const std::string& name, const Version& version);

  const std::string path_;
  const double settle_;
  std::map<std::string, File> files_;  // by name
};

}  // namespace tensegric_fit::scan_files
