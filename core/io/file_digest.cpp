#include "io/file_digest.h"

#include "io/csv.h"
#include "io/fnv_hash.h"
#include "io/json_entry.h"

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

std::vector<FileDigest> digests_of(const JsonEntry& files) {
  std::vector<FileDigest> digests;
  for (const std::string& name : files.keys()) {
    const JsonEntry file = files.at(name);
    FileDigest& digest = digests.emplace_back();
    digest.name = name;
    digest.bytes = file.at("bytes").whole<std::uint64_t>(0, largest_whole);
    if (file.has("rows")) digest.rows = file.at("rows").whole<std::int64_t>(0, largest_whole);
    digest.hash = file.at("fnv1a_64").text();
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
