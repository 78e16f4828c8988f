/// The folder that a program writes its results into.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "geometry/ply.hpp"

namespace tensegric_fit::fit {

/// Names of the files that a program writes.
using ResultNames = std::vector<const char*>;

/// An old result is never taken for a new one, nor a part of one for the whole.
void remove_results(const std::filesystem::path& folder, const ResultNames& names);

/// The first of the inputs (paths, or empty) that the results would take the place of, or null.
const std::string* endangered_input(const std::vector<const std::string*>& inputs,
                                    const std::filesystem::path& folder, const ResultNames& names);

/// Writes a whole file or none. \throw std::runtime_error where it cannot be written
void write_text(const std::string& path, const std::string& text);

/// The same of a PNG, and of a PLY as geometry::ply_bytes makes it.
void write_picture(const std::string& path, const cv::Mat& picture);
void write_mesh(const std::string& path, const geometry::TriangleMesh& mesh,
                const std::vector<std::array<std::uint8_t, 3>>& colours = {},
                geometry::Coordinates coordinates = geometry::Coordinates::float32);

/// The same. Names in files may hold any bytes; a report is UTF-8.
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& json);

}  // namespace tensegric_fit::fit
