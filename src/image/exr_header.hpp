// Private to src/image: checks the claims of an EXR header against the file's length, before OpenEXR allocates memory
// for them.
#pragma once

#include <string>
#include <string_view>

namespace tyndall::image {

// Returns why the header of an EXR must be wrong, or an empty string: attributes that reach beyond the file, or more
// scan lines or tiles than the file can hold. `bytes` is the whole file. The layout is that of "OpenEXR File Layout"
// (openexr.com), versions 1 and 2.
[[nodiscard]] std::string exr_header_problem(std::string_view bytes);

}  // namespace tyndall::image
