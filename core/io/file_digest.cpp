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

namespace {

/// Numbers that the type cannot hold are of no file; converting them would have no defined result.
template <class Integer>
Integer whole_number(const nlohmann::ordered_json& value) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::uint64_t{1} << 53)
    throw nlohmann::ordered_json::other_error::create(501, "must be a whole number, >= 0 and <= 2^53",
                                                      &value);
  return value.get<Integer>();
}

}  // namespace

std::vector<FileDigest> digests_of(const nlohmann::ordered_json& files) {
  std::vector<FileDigest> digests;
  for (const auto& [name, entry] : files.items()) {
    FileDigest digest{.name = name,
                      .bytes = whole_number<std::uint64_t>(entry.at("bytes")),
                      .rows = {},
                      .hash = entry.at("fnv1a_64").get<std::string>()};
    if (entry.contains("rows")) digest.rows = whole_number<std::int64_t>(entry.at("rows"));
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
