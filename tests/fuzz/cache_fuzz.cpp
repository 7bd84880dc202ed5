// Files of the cache. The input replaces the file of a key, as a whole or, if its first byte is odd, in a part of it.
// What is read must be exactly what was stored; anything else must be refused in one line. The header of stored
// pipelines is checked as well.
#include "files/file_cache.hpp"

#include <algorithm>
#include <cstring>

#include "fuzz.hpp"
#include "tables/pipeline_store.hpp"

namespace {

using namespace tyndall;

constexpr std::string_view kKey = "tables 4 16 12 6\nllvmpipe";
constexpr std::size_t kSize = 1000;

std::string contents() {
  std::string out(kSize, '\0');
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<char>(i * i % 251);
  return out;
}

// Returns the good file with the input written over a part of it.
std::string patched(std::string file, std::string_view input) {
  if (input.size() < 3) return file;
  const std::size_t at =
      (static_cast<unsigned char>(input[0]) << 8U | static_cast<unsigned char>(input[1])) % file.size();
  input.remove_prefix(2);
  file.replace(at, std::min(input.size(), file.size() - at), input.substr(0, file.size() - at));
  return file;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  static const std::string stored = contents();
  files::FileCache cache(folder.at("cache"), 1U << 20U, "1");
  static std::string good;
  if (good.empty()) {
    cache.write(kKey, std::as_bytes(std::span(stored)));
    std::ifstream file(cache.path(kKey), std::ios::binary);
    good.assign(std::istreambuf_iterator<char>(file), {});
  }
  std::string_view input = fuzz::text_of(data, size);
  const bool whole = input.empty() || input[0] % 2 == 0;
  if (!input.empty()) input.remove_prefix(1);
  const std::string file = whole ? std::string(input) : patched(good, input);
  folder.write("cache/" + cache.path(kKey).substr(cache.path(kKey).rfind('/') + 1), file);
  const std::optional<std::string> read = cache.read(kKey, kSize);
  fuzz::require(read.has_value() == (file == good), "a file is used if and only if it is undamaged");
  fuzz::require(!read || *read == stored, "what is read was stored");
  fuzz::require(read.has_value() == cache.note().empty(), "a refusal has a line");
  fuzz::require(cache.note().find('\n') == std::string::npos, "a note is one line");

  const VkPhysicalDeviceProperties device = {};
  VkPipelineCacheHeaderVersionOne header = {};
  if (tables::is_of_device(std::as_bytes(std::span(input)), device)) {
    std::memcpy(&header, input.data(), sizeof header);
    fuzz::require(header.headerSize >= sizeof header && header.headerSize <= input.size(), "the header is complete");
  }
  return 0;
}
