// What people write in YAML. The first byte chooses what it is, the rest is the file.
#include "control_mesh/shape_control.hpp"
#include "control_mesh/template.hpp"
#include "fit/tissue_file.hpp"
#include "fuzz_target.hpp"
#include "tensegric/garment.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tensegric_fit;
  if (size < 1) return 0;
  const fuzz::InputFile file(data + 1, size - 1, ".yaml");
  fuzz::refused_or_done([&] {
    switch (data[0] % 4) {
      case 0: {
        const tensegric::Garment garment = tensegric::load_garment(file.path());
        for (const tensegric::GarmentLine& line : garment.lines)
          fuzz::require(tensegric::kRatio.holds(line.ratio));
        break;
      }
      case 1:
        control_mesh::load_template(file.path());
        break;
      case 2:
        control_mesh::load_shape_fixing(file.path());
        break;
      default: {
        fit::Settings settings;
        fit::take_tissue(file.path(), settings);
      }
    }
  });
  return 0;
}
