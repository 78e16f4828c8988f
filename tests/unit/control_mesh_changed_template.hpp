/// Shipped templates with a slip of the pen in them.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "control_mesh/template.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::control_mesh {

/// The template with the first `what` replaced, read back; the refusal's message, or "" where it was
/// accepted.
inline std::string refusal_with(const std::string& file, const std::string& what, const std::string& by) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  std::string changed = text.str();
  const std::size_t at = changed.find(what);
  if (at == std::string::npos) return "the template does not contain " + what;
  changed.replace(at, what.size(), by);
  const std::string path = testing::TempDir() + "changed_" + file.substr(file.rfind('/') + 1);
  std::ofstream(path) << changed;
  try {
    load_template(path);
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(refusal.code(), "bad_template");
    EXPECT_NE(std::string(refusal.what()).find(path), std::string::npos) << "the file is not named";
    return refusal.what();
  }
  return "";
}

}  // namespace tensegric_fit::control_mesh
