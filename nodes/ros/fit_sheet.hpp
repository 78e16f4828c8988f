/// The fit on one page, for the customer.
#pragma once

#include <string>
#include <vector>

#include "files/whole_folder.hpp"
#include "ros/fit_figures.hpp"

namespace tensegric_fit::node {

/// A picture with what stands under it.
struct SheetPicture {
  const files::FileContent& png;
  std::string caption;
};

/// HTML that needs no other file: to be read on a screen or printed on A4.
std::string fit_sheet(const FitFigures& figures, const std::vector<SheetPicture>& pictures);

}  // namespace tensegric_fit::node
