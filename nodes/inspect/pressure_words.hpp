/// What pull and pressure of a garment's line mean to a person.
///
/// Sources: a waistband shortened by 5 % pressed with 17.5 +- 2.1 mmHg on standing women, and wearers of
/// waistbands, bras and girdles complained above 35 mmHg (Sen'i Gakkaishi 47 (6), 1991, 282). What women bear
/// at the waist falls with age, 32.4 - 0.287 * years mmHg (124 women of 19 to 87).
#pragma once

#include <string>

namespace tensegric_fit::inspect::words {

/// kPa: what a waistband shortened by 5 % presses with; above which wearers complain.
inline constexpr double kUsualPressure = 2.3, kComplaints = 4.7;
/// Half-width of a pull's 95 % interval over the pull: launch/tissue/newtons.yaml, which `calibrate` wrote
/// from finite elements. Read once; geometry::Refusal where the file is not as it was shipped.
double pull_uncertainty();

/// "23 N", "4.7 N".
std::string pull(double newtons);
/// "1.7 kPa"; empty where it is not known (0).
std::string pressure(double kilopascals);
/// "23 ± 8"; "4.7 ± 1.7".
std::string with_uncertainty(double value);
/// How it stands beside pressures measured on wearers: "less than a waistband ..."; empty where it is not
/// known (0).
std::string pressure_meaning(double kilopascals);
/// What a line's pull and pressure mean; pressure 0: unknown.
std::string pull_help(double newtons, double kilopascals);
/// A warning of a pressure that wearers complain of, or empty.
std::string pressure_warning(double kilopascals);

}  // namespace tensegric_fit::inspect::words
