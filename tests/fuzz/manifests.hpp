// Manifests that differ from valid ones only where the fuzzer wants.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "files/text.hpp"
#include "fuzz.hpp"
#include "manifest.hpp"

namespace tyndall::fuzz {

// Returns the text with the right checksum of its inputs, which mutation would not find. With a file, every file that
// it lists becomes that file, with its size and checksum. A text that is no JSON object stays as it is.
inline std::string mended_manifest(std::string_view text, std::string_view file = {},
                                   const files::FileSum* sum = nullptr) {
  using nlohmann::ordered_json;
  ordered_json json = ordered_json::parse(text, nullptr, false);
  if (!json.is_object()) return std::string(text);
  cli::Manifest with_inputs;
  if (const auto inputs = json.find("inputs"); inputs != json.end() && inputs->is_object()) {
    for (const auto& [name, value] : inputs->items()) {
      if (value.is_string()) with_inputs.inputs.emplace_back(name, value.get<std::string>());
    }
    json["inputs_hash"] = with_inputs.inputs_hash();
  }
  if (const auto items = json.find("items"); sum != nullptr && items != json.end() && items->is_array()) {
    for (ordered_json& item : *items) {
      if (!item.is_object() || !item.contains("files")) continue;
      for (ordered_json& made : item["files"]) {
        if (!made.is_object()) continue;
        made["file"] = std::string(file);
        made["bytes"] = sum->bytes;
        made["checksum"] = sum->checksum;
      }
    }
  }
  return json.dump();
}

}  // namespace tyndall::fuzz
