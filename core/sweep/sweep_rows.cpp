#include "sweep/sweep_rows.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "io/json_entry.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

constexpr const char* rows_format = "clothlab/sweep-rows/1";
constexpr const char* status_names[] = {"finished",    "diverged",   "unsolvable", "refused",
                                        "limit-steps", "limit-wall", "no-memory"};

std::string line_of(const json& entry) {
  return entry.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// JSON has no numbers that are not finite.
json json_of(double output) {
  if (std::isnan(output)) return nullptr;
  if (std::isinf(output)) return output > 0 ? "inf" : "-inf";
  return output;
}

double output_of(const JsonEntry& entry) {
  if (entry.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (entry.value() == "inf") return std::numeric_limits<double>::infinity();
  if (entry.value() == "-inf") return -std::numeric_limits<double>::infinity();
  return entry.number();
}

Attempt attempt_of(const json& line) {
  const JsonEntry entry(line);
  if (entry.at("format").text() != rows_format) throw entry.at("format").bad("is another format");
  return {.plan = entry.at("plan").text(),
          .version = entry.at("version").text(),
          .instruction_set = entry.at("instruction_set").text(),
          .processor = entry.at("processor").text(),
          .host = entry.at("host").text(),
          .shard = {entry.at("shard").whole<std::int64_t>(1, 1e9),
                    entry.at("shards").whole<std::int64_t>(1, 1e9)}};
}

PointRow row_of(const json& line, std::size_t outputs) {
  const JsonEntry entry(line);
  PointRow row{.point = entry.at("point").whole<std::int64_t>(0, 1e15),
               .scene = entry.at("scene").text(),
               .cause = entry.has("cause") ? entry.at("cause").text() : "",
               .steps = entry.at("steps").whole<std::int64_t>(0, largest_whole),
               .wall = entry.at("wall_s").number()};
  const auto known = std::find(std::begin(status_names), std::end(status_names), entry.at("status").text());
  if (known == std::end(status_names)) throw entry.at("status").bad("is no status");
  row.status = static_cast<PointStatus>(known - std::begin(status_names));
  for (const JsonEntry& output : entry.at("outputs").entries()) row.outputs.push_back(output_of(output));
  if (row.outputs.size() != outputs) throw entry.at("outputs").bad("are not those of the plan");
  return row;
}

bool is_same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

}  // namespace

const char* name_of(PointStatus status) {
  return status_names[static_cast<std::size_t>(status)];
}

bool agree(const PointRow& a, const PointRow& b) {
  if (a.scene != b.scene) return false;
  if (!is_reproducible(a.status) || !is_reproducible(b.status)) return true;
  return a.status == b.status && a.cause == b.cause && a.steps == b.steps &&
         std::equal(a.outputs.begin(), a.outputs.end(), b.outputs.begin(), b.outputs.end(), is_same);
}

bool may_share_points(const Shard& a, const Shard& b) {
  return (a.index - b.index) % std::gcd(a.count, b.count) == 0;
}

std::string Attempt::maker() const {
  return fmt::format("{} ({}, {})", host, processor, instruction_set);
}

std::string line_of(const Attempt& attempt) {
  return line_of(json{{"format", rows_format},
                      {"plan", attempt.plan},
                      {"version", attempt.version},
                      {"instruction_set", attempt.instruction_set},
                      {"processor", attempt.processor},
                      {"host", attempt.host},
                      {"shard", attempt.shard.index},
                      {"shards", attempt.shard.count}});
}

std::string line_of(const PointRow& row) {
  json entry{{"point", row.point}, {"scene", row.scene}, {"status", name_of(row.status)}};
  if (!row.cause.empty()) entry["cause"] = row.cause;
  entry["outputs"] = json::array();
  for (const double output : row.outputs) entry["outputs"].push_back(json_of(output));
  entry["steps"] = row.steps;
  entry["wall_s"] = row.wall;
  return line_of(entry);
}

ShardFile parse_shard_file(const std::string& name, const std::string& text, std::size_t outputs) {
  ShardFile file{.name = name};
  bool is_first = true, has_attempt = false;
  for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const json line = json::parse(text.begin() + static_cast<std::ptrdiff_t>(begin),
                                  text.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false);
    try {
      if (std::exchange(is_first, false)) {
        file.attempt = attempt_of(line);
        has_attempt = true;
      } else if (has_attempt) {
        file.rows.push_back(row_of(line, outputs));
      } else {
        ++file.damaged;
      }
    } catch (const BadJsonEntry&) {
      ++file.damaged;
    }
  }
  return file;
}

std::string shard_file_name(const Shard& shard, const std::string& host, std::int64_t process, int attempt) {
  std::string safe;
  for (const char c : host) safe += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '-';
  return fmt::format("{}-of-{}.{}.{}{}.jsonl", shard.index, shard.count, safe, process,
                     attempt > 1 ? fmt::format("-{}", attempt) : "");
}

std::optional<Shard> shard_of_file(const std::string& name) {
  Shard shard;
  const char *at = name.data(), *end = at + name.size();
  constexpr std::string_view of = "-of-";
  auto [stop, error] = std::from_chars(at, end, shard.index);
  if (error != std::errc() || std::string_view(stop, static_cast<std::size_t>(end - stop)).rfind(of, 0) != 0)
    return std::nullopt;
  const auto second = std::from_chars(stop + of.size(), end, shard.count);
  if (second.ec != std::errc() || second.ptr == end || *second.ptr != '.' || !name.ends_with(".jsonl"))
    return std::nullopt;
  if (shard.count < 1 || shard.index < 1 || shard.index > shard.count) return std::nullopt;
  return shard;
}

}  // namespace cloth
