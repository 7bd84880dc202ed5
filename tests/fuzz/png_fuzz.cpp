// PNG files, decoded from memory.
#include "fuzz.hpp"
#include "image/codec.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tyndall;
  const Result<image::File> file = image::decode_png(fuzz::text_of(data, size), "fuzz.png");
  if (!file) {
    fuzz::require_one_line(file.error());
    return 0;
  }
  const image::Image& image = file.value().image;
  fuzz::require(image.width > 0 && image.height > 0, "a picture has pixels");
  fuzz::require(image.rgb.size() == std::size_t{3} * image.width * image.height, "a picture is complete");
  return 0;
}
