// Private to src/image: what the header of an EXR claims, checked against the file's length before OpenEXR allocates
// anything for it.
#pragma once

#include <string>
#include <string_view>

namespace tyndall::image {

// Returns why the header of an EXR cannot be true, empty when it can: attributes that reach beyond the file, more scan
// lines or tiles than the file has room for. `bytes` is the whole file. The layout is that of "OpenEXR File Layout"
// (openexr.com), versions 1 and 2.
[[nodiscard]] std::string exr_header_problem(std::string_view bytes);

}  // namespace tyndall::image
