/// Files for makers' programs, beside the report: launch/pages/results.md.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fit/chain.hpp"

namespace tensegric_fit::fit {

/// CLO's own advice for avatars.
inline constexpr std::size_t kMostMakerTriangles = 70000;

/// Writes body and deformed as .obj and .stl, fit.glb, and with any of them measures.json, measures.vit and
/// measures_worn.vit. \param formats any of obj, glb, stl \param fit null: measured only
/// \throw std::runtime_error where a file cannot be written
void export_for_makers(const std::string& folder, const std::vector<std::string>& formats, const Body& body,
                       const Fit* fit);

/// All names that it writes.
inline constexpr const char* kMakerFiles[] = {"body.obj",     "deformed.obj",     "body.stl",
                                              "deformed.stl", "fit.glb",          "measures.json",
                                              "measures.vit", "measures_worn.vit"};

}  // namespace tensegric_fit::fit
