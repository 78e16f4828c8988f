/// What clerks call the garments of a folder.
#pragma once

#include <string>
#include <vector>

namespace tensegric_fit::inspect {

struct GarmentTitle {
  std::string name;     ///< of the file, without .yaml: what the pipeline knows it by
  std::string title;    ///< a few words; empty: the file has none, or cannot be read
  std::string about;    ///< a sentence, or empty
  std::string picture;  ///< path of NAME.png beside the file; empty: there is none
};

/// Of all garment files, by name; empty where there is no such folder.
std::vector<GarmentTitle> garments_in(const std::string& folder);

}  // namespace tensegric_fit::inspect
