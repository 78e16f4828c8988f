/// Bodies whose measures are known: random customers of both families of the virtual booth, and the open
/// bodies F0 to F2 where they lie beside the repository.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "subjects.hpp"

namespace tensegric_fit::test {

struct KnownBody {
  std::string family, name;

  population::Subject surface() const {
    return population::family_named(family)->body(name, population::Input::surface);
  }
};

inline std::vector<KnownBody> known_bodies() {
  std::vector<KnownBody> bodies{{"model", "2"}, {"implicit", "7"}};
  const std::string open = std::string(TENSEGRIC_FIT_SOURCE_DIR) + "/../shared/data/open";
  for (const char* name : {"F0", "F1", "F2"})
    if (std::filesystem::exists(open + "/" + name + "_body.ply")) bodies.push_back({open, name});
  return bodies;
}

inline std::string name_of(const testing::TestParamInfo<KnownBody>& info) {
  return std::filesystem::path(info.param.family).filename().string() + "_" + info.param.name;
}

}  // namespace tensegric_fit::test
