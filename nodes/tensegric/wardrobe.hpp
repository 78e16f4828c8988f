/// The garments that a node can be asked for.
#pragma once

#include <tensegric_fit/SetGarment.h>

#include <string>

#include "tensegric/fit_messages.hpp"

namespace tensegric_fit::node {

class Wardrobe {
 public:
  /// `folder` holds the shipped garments.
  explicit Wardrobe(std::string folder) : folder_(std::move(folder)) {}

  /// A shipped garment's name or a garment file. \throw Refusal bad_garment
  GarmentRequest take(const std::string& word) const;

  /// What a service call asks for, with its ratios put in. \throw Refusal as above, and unknown_line
  GarmentRequest take(const SetGarment::Request& request) const;

 private:
  std::string folder_;
};

}  // namespace tensegric_fit::node
