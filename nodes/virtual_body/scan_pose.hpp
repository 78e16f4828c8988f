/// Where a virtual body stands in the frame of its scan.
#pragma once

#include "virtual_body/virtual_body.hpp"

namespace tensegric_fit::virtual_body {

/// Turns her about the origin by `yaw` (from x towards y) and `tilt` (her lean forward), radians, and puts
/// her lowest point on the floor z = 0: mesh and truth go from the body's frame to the scan's.
void place_in_scan(double yaw, double tilt, VirtualBody& body);

}  // namespace tensegric_fit::virtual_body
