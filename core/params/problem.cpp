#include "params/problem.h"

#include <fmt/format.h>

namespace cloth {

std::string Problem::text() const {
  std::string text;
  if (!place.empty()) text = place + ": ";
  if (!place.empty() && line > 0)
    text = column > 0 ? fmt::format("{}:{}:{}: ", place, line, column) : fmt::format("{}:{}: ", place, line);
  if (!path.empty()) text += value.empty() ? path + ": " : fmt::format("{} = {}: ", path, value);
  return text + rule;
}

}  // namespace cloth
