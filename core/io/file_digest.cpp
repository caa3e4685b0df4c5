#include "io/file_digest.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "io/csv.h"
#include "io/fnv_hash.h"

namespace cloth {

FileDigest digest_of(const std::string& name, const std::string& text, bool is_table) {
  FnvHash hash;
  hash.add(text);
  FileDigest digest{.name = name, .bytes = text.size(), .rows = {}, .hash = hash.text()};
  if (is_table) digest.rows = static_cast<std::int64_t>(parse_csv(text).rows.size());
  return digest;
}

nlohmann::ordered_json digests_json(const std::vector<FileDigest>& files) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const FileDigest& file : files) {
    nlohmann::ordered_json& entry = object[file.name];
    if (file.rows) entry["rows"] = *file.rows;
    entry["bytes"] = file.bytes;
    entry["fnv1a_64"] = file.hash;
  }
  return object;
}

std::vector<FileDigest> digests_of(const nlohmann::ordered_json& files) {
  std::vector<FileDigest> digests;
  for (const auto& [name, entry] : files.items()) {
    FileDigest digest{.name = name,
                      .bytes = entry.at("bytes").get<std::uint64_t>(),
                      .rows = {},
                      .hash = entry.at("fnv1a_64").get<std::string>()};
    if (entry.contains("rows")) digest.rows = entry.at("rows").get<std::int64_t>();
    digests.push_back(std::move(digest));
  }
  return digests;
}

std::string disagreement(const FileDigest& expected, const FileDigest& found) {
  if (expected.rows && found.rows && *expected.rows != *found.rows)
    return fmt::format("has {} rows, not {}", *found.rows, *expected.rows);
  if (expected.bytes != found.bytes) return fmt::format("has {} bytes, not {}", found.bytes, expected.bytes);
  if (expected.hash != found.hash)
    return fmt::format("has other contents: its hash is {}, not {}", found.hash, expected.hash);
  return {};
}

}  // namespace cloth
