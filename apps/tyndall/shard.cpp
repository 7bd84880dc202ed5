#include "shard.hpp"

#include "files/text.hpp"

namespace tyndall::cli {

std::vector<std::uint64_t> Shard::items(std::uint64_t total) const {
  std::vector<std::uint64_t> out;
  for (std::uint64_t item = index; item < total; item += count) out.push_back(item);
  return out;
}

std::string Shard::text() const { return files::concat({std::to_string(index + 1), "/", std::to_string(count)}); }

Result<Shard> parse_shard(std::string_view text, std::string_view option) {
  std::int64_t index = 0;
  std::int64_t count = 0;
  const bool valid = files::count_parts(text, '/') == 2 &&
                     files::read_integer(files::part(text, '/', 0), index) == files::NumberError::none &&
                     files::read_integer(files::part(text, '/', 1), count) == files::NumberError::none && index >= 1 &&
                     count >= index && count <= kMaxShards;
  if (valid) return Shard{static_cast<std::uint32_t>(index - 1), static_cast<std::uint32_t>(count)};
  return files::input_error(
      files::concat({"invalid shard '", files::one_line(text), "'"}), option,
      files::concat({"expected I/N with whole numbers, 1 <= I <= N <= ", std::to_string(kMaxShards)}));
}

}  // namespace tyndall::cli
