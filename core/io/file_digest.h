// What an index file (summary.json, study.json) says of the files beside it: how long they are, how many rows
// they have, and a hash, so that a table that is not the one described is noticed.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace cloth {

class JsonEntry;

struct FileDigest {
  std::string name;  ///< in its folder
  std::uint64_t bytes = 0;
  std::optional<std::int64_t> rows;  ///< of a table, without the header; none: the file is no table
  std::string hash;                  ///< FNV-1a, 64 bits, 16 hexadecimal digits
  bool operator==(const FileDigest&) const = default;
};

/// Of a whole file's text. `is_table`: a CSV file with one header row.
FileDigest digest_of(const std::string& name, const std::string& text, bool is_table);

/// {"record.csv": {"rows": 201, "bytes": 40000, "fnv1a_64": "..."}, ...}
nlohmann::ordered_json digests_json(const std::vector<FileDigest>& files);

/// The same back; throws BadJsonEntry where it is something else.
std::vector<FileDigest> digests_of(const JsonEntry& files);

/// A sentence where `found` is not what `expected` says; empty where it is.
std::string disagreement(const FileDigest& expected, const FileDigest& found);

}  // namespace cloth
