/// How programs read their command lines.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <optional>

#include "geometry/range.hpp"

namespace tensegric_fit::fit {

/// The whole numbers in a range.
inline CLI::Range whole_in(const geometry::Range& range) {
  return {static_cast<int>(range.low), static_cast<int>(range.high)};
}

/// The numbers in a range, without NaN, which CLI::Range takes.
inline CLI::Validator number_in(double low, double high) {
  const CLI::Range range(low, high);
  return {[range](std::string& text) {
            const std::string fault = range(text);
            const bool number = !std::isnan(std::strtod(text.c_str(), nullptr));
            return fault.empty() && !number ? "'" + text + "' is not a number" : fault;
          },
          range.get_description()};
}

/// Exit code where the program has nothing more to do (0 help, 2 usage), else none. No option may be empty:
/// an unset variable of a script asks for something. `check` throws CLI::ParseError where what was read is
/// wrong.
template <typename Check>
std::optional<int> parsed(CLI::App& app, int argc, const char* const* argv, std::ostream& errors,
                          const Check& check) {
  try {
    app.parse(argc, argv);
    for (const CLI::Option* option : app.get_options())
      for (const std::string& value : option->results())
        if (value.empty()) throw CLI::ValidationError(option->get_name(), "is empty");
    check();
  } catch (const CLI::ParseError& error) {
    return app.exit(error, std::cout, errors) == 0 ? 0 : 2;
  }
  return std::nullopt;
}

}  // namespace tensegric_fit::fit
