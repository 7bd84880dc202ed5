// Private to src/image: decoders for whole files in memory, and the checks that both writers share.
#pragma once

#include <string>
#include <string_view>

#include "image/image.hpp"

namespace tyndall::image {

// Decode the pixels and metadata of a file's bytes; `path` is for messages.
[[nodiscard]] Result<File> decode_png(std::string_view bytes, const std::string& path);
[[nodiscard]] Result<File> decode_exr(std::string_view bytes, const std::string& path);

// Rejects images that no file can hold: no pixels, too many, wrong size of rgb, names longer than 79 characters.
[[nodiscard]] Result<void> check_writable_image(const std::string& path, const Image& image, const Metadata& metadata);

[[nodiscard]] Error read_error(const std::string& path, std::string_view why);
[[nodiscard]] Error write_error(ErrorCode code, const std::string& path, std::string_view why);

}  // namespace tyndall::image
