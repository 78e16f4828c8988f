/// The results of one shard: a file to which one line of JSON is added per scan.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace tensegric_fit::batch {

/// Lines of a file of results, in their order, with the places (bytes) at which they begin; an unfinished
/// last one, as a kill leaves it, does not count. \throw Refusal broken_file: cannot be read, a line that is
/// not a result
void for_each_line(const std::string& file,
                   const std::function<void(nlohmann::ordered_json&& line, std::size_t place)>& use);

/// Whether it has what each line has that this build writes; lines of earlier ones may have less.
bool has_all_parts(const nlohmann::ordered_json& line);

/// Whether a line has no result of the scan, but a crash, a failure, or a lack of time or memory.
bool is_unfinished(const nlohmann::ordered_json& line);

/// Whether it says what the scan itself came to: it could be read, and no run of it broke off.
bool is_settled(const nlohmann::ordered_json& line);

class ShardFile {
 public:
  /// Opens FOLDER/NAME or makes it; an unfinished last line is taken off. Nobody else may have it open.
  /// \throw Refusal cannot_write
  ShardFile(const std::string& folder, const std::string& name);
  ~ShardFile();
  ShardFile(const ShardFile&) = delete;
  ShardFile& operator=(const ShardFile&) = delete;

  const std::string& path() const { return path_; }
  /// On the disk when it returns; the place. \throw Refusal cannot_write: nothing of the line is left there
  std::size_t add(const nlohmann::ordered_json& line);
  nlohmann::ordered_json line_at(std::size_t place) const;

 private:
  void cut_unfinished_line() const;

  std::string path_;
  int file_ = -1;
};

}  // namespace tensegric_fit::batch
