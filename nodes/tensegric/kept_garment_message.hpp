/// A garment as a text that outlives its node: what a node that was started again goes on with.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tensegric/fit_messages.hpp"

namespace tensegric_fit::node {

/// `first` is the garment that the node was started with: under another one the text counts no more.
std::string kept_text(const std::string& first, const GarmentRequest& worn);

/// Of all but the sequence number: rospy numbers a latched message anew each time that it delivers it.
std::uint64_t checksum_of(Garment message);

/// Nothing where the text belongs to another `first` garment, or is not from kept_text().
std::optional<GarmentRequest> kept_garment(const std::string& text, const std::string& first);

}  // namespace tensegric_fit::node
