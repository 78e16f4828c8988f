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

/// HTML that needs no other file: to be read on a phone or a screen, or printed on A4. `model`: fit.glb,
/// which the page turns in 3D by launch/page/view.js; left out where it is too large for a page of 8 MB.
/// \throw Refusal broken_file: a shipped file of the page, or three.js, is not there
std::string fit_sheet(const FitFigures& figures, const std::vector<SheetPicture>& pictures,
                      const files::FileContent& model);

}  // namespace tensegric_fit::node
