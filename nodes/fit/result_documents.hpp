/// The documents by which folders of results are known.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>

#include "files/whole_folder.hpp"
#include "geometry/json_text.hpp"

namespace tensegric_fit::fit {

inline constexpr char kFitReport[] = "report.json";       ///< of `fit`
inline constexpr char kExportDocument[] = "fit.json";     ///< of an export of the pipeline
inline constexpr char kSealedDocument[] = "sealed.json";  ///< of an encrypted one

/// Discarded where it is no file of JSON (a pipe has no end), or larger or deeper than these documents are.
inline nlohmann::json read_document(const std::filesystem::path& file) {
  constexpr std::size_t kLargest = 16 << 20;  // bytes
  std::error_code not_there;
  const std::filesystem::path place = std::filesystem::canonical(file, not_there);  // it may be a link
  const std::optional<std::string> text = files::bytes_of_plain_file(place.string(), kLargest);
  return geometry::json_in(text.value_or(""));
}

/// Whether it is an export, or in one. An export takes no other files: they would be read with its document,
/// and it would not be deleted as one.
inline bool lies_in_export(const std::filesystem::path& folder) {
  std::error_code not_there;
  for (const char* name : {kExportDocument, kSealedDocument})
    if (std::filesystem::exists(folder / name, not_there)) return true;
  // Of a folder above it the name of a file is not enough to refuse.
  const std::filesystem::path place =
      std::filesystem::weakly_canonical(std::filesystem::absolute(folder), not_there);
  for (auto above = place.parent_path(); above != above.parent_path(); above = above.parent_path())
    for (const char* name : {kExportDocument, kSealedDocument}) {
      const nlohmann::json document = read_document(above / name);
      const nlohmann::json format =
          document.is_object() ? document.value("format", nlohmann::json()) : nlohmann::json();
      if (format == "tensegric_fit/fit" || format == "tensegric_fit/sealed") return true;
    }
  return false;
}

}  // namespace tensegric_fit::fit
