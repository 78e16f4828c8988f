/// The fold under a breast as the skin of breast and chest further off tells it.
#pragma once

#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {

/// Metres by which the fold on a scan's profile is higher than its most hollow place, `at`. Where a
/// reconstruction spans a fold that no sensor sees well, that place lies below where breast and chest would
/// meet; where it digs a pit instead, far before the chest. 0 where there is too little skin to tell.
double fold_above_place(const Profile& profile, int at);

}  // namespace tensegric_fit::landmarks
