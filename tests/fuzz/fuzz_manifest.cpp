// Manifests of fit_batch. The first byte chooses CSV or lines of JSON, the rest is the file.
#include "batch/manifest.hpp"
#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tensegric_fit;
  if (size < 1) return 0;
  const fuzz::InputFile file(data + 1, size - 1, data[0] % 2 == 0 ? ".csv" : ".jsonl");
  fuzz::refused_or_done([&file] {
    for (const batch::Job& job : batch::read_manifest(file.path())) fuzz::require(!job.inputs().empty());
  });
  return 0;
}
