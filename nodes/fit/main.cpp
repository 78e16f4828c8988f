#include "files/owner_only.hpp"
#include "fit/run.hpp"

int main(int argc, char** argv) {
  tensegric_fit::files::owner_only();
  tensegric_fit::fit::CommandLine line;
  if (const auto exit_code = tensegric_fit::fit::parse(argc, argv, line)) return *exit_code;
  return tensegric_fit::fit::run(line);
}
